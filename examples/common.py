"""What the examples share: starting gasgrain under MPI, editing a case file, the summary file."""

import fcntl
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def fail(message):
    """Ends the program with one clear error."""
    sys.exit(f"ERROR: {message}")


def mpi_environment(ranks):
    """Open MPI: allow root (containers); more ranks than cores must not spin while they wait."""
    return dict(
        os.environ,
        OMPI_ALLOW_RUN_AS_ROOT="1",
        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
        OMPI_MCA_rmaps_base_oversubscribe="1",
        OMPI_MCA_hwloc_base_binding_policy="none",
        OMPI_MCA_mpi_yield_when_idle="1" if ranks > os.cpu_count() else "0",
        OMP_NUM_THREADS="1",
    )


def binary(name):
    """Path of one of our executables: the build directory of this checkout, else the PATH."""
    built = ROOT / "build" / "bin" / name
    found = str(built) if built.exists() else shutil.which(name)
    if not found:
        fail(f"{name} is not built; start the example through examples/run, or build first")
    return found


def results_directory(chosen, name):
    """The directory `chosen`, or out/`name`."""
    out = pathlib.Path(chosen or ROOT / "out" / name).resolve()
    out.mkdir(parents=True, exist_ok=True)
    return out


def require_idle(directory):
    """Fails while a run of gasgrain writes into `directory`: see output_directory.hpp."""
    try:
        with open(directory / ".running", "rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        pass
    except BlockingIOError:
        fail(f"another run is writing into {directory}; wait for its end, stop it, or give --out "
             "another directory")


def fresh_directory(path):
    """The directory for results, without those of an earlier run."""
    out = pathlib.Path(path).resolve()
    out.mkdir(parents=True, exist_ok=True)
    require_idle(out)
    for old in ("summary.json", "result.png"):
        (out / old).unlink(missing_ok=True)
    return out


def start_gasgrain(directory, script, ranks, variables):
    """Starts `script` in `directory` and returns the process.

    LIGGGHTS's own screen output goes to log.liggghts only.
    """
    command = ["mpirun", "-np", str(ranks), binary("gasgrain"), "-in", script, "-log", "log.liggghts"]
    command += ["-screen", "/dev/null"]
    for name, value in variables.items():
        command += ["-var", name, f"{value:.10g}" if isinstance(value, float) else str(value)]
    sys.stdout.flush()
    # A session of its own: Ctrl-C is for us, see ask_to_end.
    return subprocess.Popen(command, cwd=directory, env=mpi_environment(ranks),
                            start_new_session=True)


def ask_to_end(process):
    """Asks the ranks that `process` (mpirun) has started here for a checkpoint and their end.

    Told so itself, mpirun would kill them a second later.
    """
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    try:
        ranks = children.read_text().split()
    except OSError:
        ranks = []
    for rank in ranks or [process.pid]:
        try:
            os.kill(int(rank), signal.SIGTERM)
        except ProcessLookupError:
            pass


def run_gasgrain(directory, script, ranks, variables):
    """start_gasgrain, to its end; fails when gasgrain does."""
    process = start_gasgrain(directory, script, ranks, variables)
    try:
        code = process.wait()
    except KeyboardInterrupt:
        ask_to_end(process)
        process.wait()
        raise
    if code != 0:
        fail(f"gasgrain ended with exit code {code}; see {directory}/log.liggghts")


def set_key(text, key, value):
    """`text` of a TOML file with the one number after `key =` replaced."""
    changed, count = re.subn(rf"(\b{key}\s*=\s*)[-+0-9.eE]+", rf"\g<1>{value:.10g}", text)
    if count != 1:
        fail(f"case file holds {count} places '{key} = number', expected one")
    return changed


def set_text(text, old, new):
    """`text` with the one place that reads `old` replaced."""
    if text.count(old) != 1:
        fail(f"file holds {text.count(old)} places '{old}', expected one")
    return text.replace(old, new)


def set_kernel(text, millimetres):
    """Case file with the width of the kernel stated; None leaves it to the default."""
    if millimetres is None:
        return text
    return set_text(text, "[coupling]\n", f"[coupling]\nkernel_width = {1e-3 * millimetres:g}\n")


def set_mapping(text, name):
    """Case file with the mapping of grains to cells stated; None leaves it to the default."""
    return text if name is None else set_text(text, "[coupling]\n", f'[coupling]\nmapping = "{name}"\n')


def read_json(path):
    return json.loads(pathlib.Path(path).read_text())


def write_json(path, value):
    """Replaces the file whole."""
    new = path.with_suffix(".tmp")
    new.write_text(json.dumps(value, indent=1) + "\n")
    new.replace(path)


def complete_summary(directory, change):
    """Lets `change` edit the quantities (name -> quantity) of summary.json; returns them."""
    path = pathlib.Path(directory) / "summary.json"
    summary = read_json(path)
    quantities = {quantity["name"]: quantity for quantity in summary["quantities"]}
    change(quantities)
    write_json(path, summary)
    return quantities


def add_quantities(directory, rows):
    """Adds quantities to summary.json, in place of those of the same names."""
    path = pathlib.Path(directory) / "summary.json"
    summary = read_json(path)
    names = {row["name"] for row in rows}
    kept = [quantity for quantity in summary["quantities"] if quantity["name"] not in names]
    write_json(path, {**summary, "quantities": kept + rows})


def read_summary(directory):
    """summary.json as a dictionary name -> quantity."""
    summary = read_json(pathlib.Path(directory) / "summary.json")
    return {quantity["name"]: quantity for quantity in summary["quantities"]}


def quantity(name, value, unit, **more):
    """One entry of summary.json; `more`: reference, tolerance (relative), source."""
    return {"name": name, "value": float(value), "unit": unit,
            **{"reference": None, "tolerance": None, "source": "", **more}}


def write_summary(directory, case, quantities):
    """summary.json of an example that measures by itself; returns name -> quantity."""
    write_json(pathlib.Path(directory) / "summary.json", {"case": case, "quantities": quantities})
    return {entry["name"]: entry for entry in quantities}


def print_quantities(quantities):
    """A table of what was measured against its references."""
    print(f"\n{'quantity':<30}{'here':>12}{'reference':>12}{'deviation':>11}")
    for entry in quantities.values():
        line = f"{entry['name'] + ' / ' + entry['unit']:<30}{entry['value']:>12.4g}"
        if entry["reference"]:
            deviation = 100 * (entry["value"] / entry["reference"] - 1)
            line += f"{entry['reference']:>12.4g}{deviation:>+9.1f} %  {entry['source']}"
        print(line)
