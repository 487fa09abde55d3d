"""What the examples share: starting gasgrain under MPI, editing a case file, the summary file."""

import json
import os
import pathlib
import re
import shutil
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


def run_gasgrain(directory, script, ranks, variables):
    """Runs `script` in `directory`; LIGGGHTS's own screen output goes to log.liggghts only.

    Fails, with the exit code, when gasgrain does.
    """
    command = ["mpirun", "-np", str(ranks), binary("gasgrain"), "-in", script, "-log", "log.liggghts"]
    command += ["-screen", "/dev/null"]
    for name, value in variables.items():
        command += ["-var", name, f"{value:.10g}" if isinstance(value, float) else str(value)]
    sys.stdout.flush()
    done = subprocess.run(command, cwd=directory, env=mpi_environment(ranks))
    if done.returncode != 0:
        fail(f"gasgrain ended with exit code {done.returncode}; see {directory}/log.liggghts")


def set_key(text, key, value):
    """`text` of a TOML file with the one number after `key =` replaced."""
    changed, count = re.subn(rf"(\b{key}\s*=\s*)[-+0-9.eE]+", rf"\g<1>{value:.10g}", text)
    if count != 1:
        fail(f"case file holds {count} places '{key} = number', expected one")
    return changed


def complete_summary(directory, change):
    """Lets `change` edit the quantities (name -> quantity) of summary.json; returns them."""
    path = pathlib.Path(directory) / "summary.json"
    summary = json.loads(path.read_text())
    quantities = {quantity["name"]: quantity for quantity in summary["quantities"]}
    change(quantities)
    new = path.with_suffix(".tmp")
    new.write_text(json.dumps(summary, indent=1) + "\n")
    new.replace(path)
    return quantities


def read_summary(directory):
    """summary.json as a dictionary name -> quantity."""
    summary = json.loads((pathlib.Path(directory) / "summary.json").read_text())
    return {quantity["name"]: quantity for quantity in summary["quantities"]}
