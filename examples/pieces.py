"""Runs in pieces: a packing that is made once, checkpoints, and the record of who ran what."""

import hashlib
import json
import os
import platform
import shutil
import signal
import subprocess
import time

import common

STOPPED = 75  # our exit code when a checkpoint was written and there is more to do
STOPPED_WORDS = "Ended by a signal"  # of gasgrain in its log; mpirun may change its exit code
RECORD = "pieces.json"
# What LIGGGHTS itself writes on a signal, beside our checkpoint.
FORCED = ("restart_forced_liggghts_*.data", "gas.*.state.h5")


class Job:
    """A script that starts from a stored packing or goes on from its last checkpoint.

    `variables`: those of the script. Those in `packing` decide what the packed start is; another
    value of any variable but `time` and `points` begins the run anew.
    """

    def __init__(self, directory, script, variables, packing):
        self.directory, self.script = directory, script
        self.variables = variables
        words = json.dumps({name: variables[name] for name in packing}, sort_keys=True)
        source = (directory / script).read_text().split("label ")[0]
        key = hashlib.sha256((source + words).encode()).hexdigest()[:12]
        self.packed = common.ROOT / "out" / "packings" / f"{script}.{key}.restart"

    def settings(self):
        kept = {n: v for n, v in self.variables.items() if n not in ("time", "points")}
        files = {file.name: file.read_text() for file in self.directory.glob("*.toml")}
        return json.loads(json.dumps({"script": self.script, "variables": kept, "files": files}))


def read_record(directory):
    path = directory / RECORD
    return common.read_json(path) if path.exists() else {"settings": None, "pieces": []}


def write_record(directory, record):
    common.write_json(directory / RECORD, record)


def close_killed_piece(directory, record):
    """A piece that was killed took at least until the last row of its time series."""
    for piece in record["pieces"]:
        if piece["seconds"] is None:
            series = directory / "timeseries.csv"
            end = series.stat().st_mtime if series.exists() else piece["began"]
            piece["seconds"] = max(0.0, end - piece["began"])


def processor():
    """Name of the processor and number of cores."""
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return f"{names[0] if names else platform.machine()}, {os.cpu_count()} cores"


def commit():
    done = subprocess.run(["git", "-C", str(common.ROOT), "describe", "--always", "--dirty"],
                          capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else "unknown"


def remove(directory, patterns):
    for pattern in patterns:
        for file in directory.glob(pattern):
            file.unlink()


def begin_anew(directory):
    """Removes the checkpoints and results of another run."""
    shutil.rmtree(directory / "points", ignore_errors=True)
    remove(directory, ("*.csv", "*.xdmf", "*.h5", "summary.json", RECORD))


def start_variables(job):
    """Script variables that say where the job starts, and the words for it."""
    latest = job.directory / "points" / "latest.restart"
    if latest.exists():
        return {"resume": 1, "from": "points/latest.restart"}, f"goes on from {os.readlink(latest)}"
    if job.packed.exists():
        return {"resume": 1, "from": str(job.packed)}, f"packed start of {job.packed}"
    job.packed.parent.mkdir(parents=True, exist_ok=True)
    return {"resume": 0, "packed": str(job.packed)}, "grains fall into a packing first"


def wait(process, hours):
    """Exit code of the job; after `hours`, or when we are told to end, it writes a checkpoint."""
    before = {number: signal.signal(number, lambda *_: common.ask_to_end(process))
              for number in (signal.SIGTERM, signal.SIGINT)}
    try:
        return process.wait(3600 * hours)
    except subprocess.TimeoutExpired:
        common.ask_to_end(process)
        return process.wait()
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def run_piece(job, how):
    """Runs to the end, or until a signal or `how.hours` are over: then the program ends with 75.

    `how` holds the options of options.add_pieces. A run that is complete already is left as it is.
    """
    common.require_idle(job.directory)
    record = read_record(job.directory)
    if how.fresh or record["settings"] != job.settings():
        begin_anew(job.directory)
        record = {"settings": job.settings(), "pieces": []}
    close_killed_piece(job.directory, record)
    if record.get("complete", -1.0) >= job.variables["time"]:
        print("  start          complete already; --fresh runs it anew\n")
        return
    start, words = start_variables(job)
    print(f"  start          {words}\n", flush=True)
    piece = {"began": time.time(), "seconds": None, "ranks": how.ranks, "machine": processor(),
             "commit": commit()}
    record["pieces"].append(piece)
    write_record(job.directory, record)
    log = job.directory / "log.liggghts"
    summary = job.directory / "summary.json"
    for file in (log, summary):
        file.unlink(missing_ok=True)
    code = wait(common.start_gasgrain(job.directory, job.script, how.ranks,
                                      {**job.variables, **start}), how.hours)
    piece["seconds"] = time.time() - piece["began"]
    remove(job.directory, FORCED)
    # The summary is written at the end; a packing that is told to end ends without a checkpoint.
    signalled = log.exists() and STOPPED_WORDS in log.read_text(errors="replace")
    stopped = signalled or (code == 0 and not summary.exists())
    if code == 0 and not stopped:
        record["complete"] = job.variables["time"]
    write_record(job.directory, record)
    if stopped:
        print("\nstopped " + ("with a checkpoint" if signalled else "while the grains fell into a packing")
              + "; the same command goes on")
        raise SystemExit(STOPPED)
    if code != 0:
        common.fail(f"gasgrain ended with exit code {code}; see {log}")


def totals(directory):
    """Run time in s of all pieces, and ranks, machines and commits that took part."""
    pieces = read_record(directory)["pieces"]
    together = {name: ", ".join(dict.fromkeys(str(piece[name]) for piece in pieces))
                for name in ("ranks", "machine", "commit")}
    return {"seconds": sum(piece["seconds"] or 0.0 for piece in pieces), "pieces": len(pieces),
            **together}


def add_provenance(job, chosen, facts):
    """Adds to summary.json how the result was made: what was chosen, `facts`, machine, run time,
    steps."""
    facts = {**facts, "l": chosen.grain, "grains": job.variables["count"],
             "dem_step": job.variables["dt"], "simulated": chosen.time, "spring": chosen.spring}
    path = job.directory / "summary.json"
    summary = common.read_json(path)
    steps = round(facts["simulated"] / facts["dem_step"])
    summary["provenance"] = {**facts, "steps": steps, **totals(job.directory)}
    common.write_json(path, summary)
