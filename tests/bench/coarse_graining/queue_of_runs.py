"""Runs what is missing of the time-error benchmark and adds a row per run to results/SCENE.csv.

    tests/bench/coarse_graining/run [--only REGEX] [--budget MINUTES] [--jobs N] [--list]

Interrupt it whenever you like: finished runs have their row, the next call continues. REGEX is
searched in names such as `column cgm-n3 l=2 seed=1` or `bed cgm-n3 l=2 seed=3 cell=2.5e-3`. A run
that fails has a row that says why and is not repeated; delete the row to repeat it.
"""

import argparse
import concurrent.futures
import csv
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import measures
from cases import MESHES, SCENES, all_cases

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
COLUMNS = ["law", "l", "seed", "factor", "value", "grains", "steps", "grain_steps", "cpu_seconds",
           "step", "status", "commit", "load"]
LOCK = threading.Lock()
RUNNING = set()  # processes
STOPPED = threading.Event()  # rows of runs that were cut off are not written


def name_of(case):
    factor = f" {case.factor}={case.value}" if case.factor else ""
    return f"{case.scene} {case.law} l={case.l:g} seed={case.seed}{factor}"


def rows_of(results, scene):
    path = results / f"{scene}.csv"
    if not path.exists():
        return []
    with open(path) as file:
        return list(csv.DictReader(file))


def add_row(results, case, row):
    path = results / f"{case.scene}.csv"
    columns = COLUMNS + list(SCENES[case.scene].quantities)
    with LOCK:
        new = not path.exists()
        with open(path, "a", newline="") as file:
            writer = csv.DictWriter(file, columns, lineterminator="\n")
            if new:
                writer.writeheader()
            writer.writerow(row)


def commit():
    def git(*words):
        return subprocess.run(["git", "-C", str(ROOT), *words], text=True, check=True,
                              stdout=subprocess.PIPE).stdout.strip()
    changed = git("status", "--porcelain", "--", "liggghts_plugins", "coupling", "cfd")
    return git("rev-parse", "--short", "HEAD") + ("+" if changed else "")


def prepare(case, directory):
    scene = SCENES[case.scene]
    (directory / "scene.in").write_text(scene.script(case))
    (directory / "case.toml").write_text(scene.case_file(case))
    if case.scene in MESHES:
        name, text = MESHES[case.scene]
        (directory / name).write_text(text())


def run_program(program, directory, limit):
    """(status, CPU seconds of the process)."""
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1",
                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMPI_MCA_hwloc_base_binding_policy": "none", "OMP_NUM_THREADS": "1"}
    with open(directory / "screen", "w") as screen:
        process = subprocess.Popen([program, "-in", "scene.in", "-log", "log"], cwd=directory,
                                   env=environment, stdin=subprocess.DEVNULL, stdout=screen,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        RUNNING.add(process)
        watch = threading.Timer(limit, process.kill)
        watch.start()
        _, status, usage = os.wait4(process.pid, 0)
        watch.cancel()
        RUNNING.discard(process)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode == 0:
        return "ok", usage.ru_utime + usage.ru_stime
    lines = (directory / "screen").read_text(errors="replace").splitlines()
    reasons = [line for line in lines if "ERROR" in line] + [f"exit code {process.returncode}"]
    return "failed: " + reasons[0].replace(",", ";")[:120], usage.ru_utime + usage.ru_stime


def one_run(case, given, version):
    scene, dt = SCENES[case.scene], SCENES[case.scene].step(case)
    directory = pathlib.Path(tempfile.mkdtemp(prefix="gasgrain-bench-"))
    try:
        prepare(case, directory)
        status, cpu = run_program(given.program, directory, 60 * given.limit)
        if STOPPED.is_set():
            return
        values = {}
        grains = scene.grains(case)
        if status == "ok":
            frames = measures.read_frames(directory / "frames.dump")
            inserted = len(frames[0])
            if inserted < 0.99 * grains:
                status = f"failed: only {inserted} of {grains} grains inserted"
            elif len(frames[-1]) < inserted and not scene.loses_grains:
                status = f"failed: {inserted - len(frames[-1])} grains lost"
            else:
                values = scene.measure(frames, scene, case, directory)
            grains = inserted
        steps = round((scene.settle + scene.time) / dt)
        row = dict(zip(("law", "l", "seed", "factor", "value"), case.key), grains=grains,
                   steps=steps, grain_steps=f"{grains * steps:.4g}", cpu_seconds=f"{cpu:.2f}",
                   step=f"{dt:.4g}", status=status, commit=version,
                   load=f"{os.getloadavg()[0]:.1f}",
                   **{name: f"{value:.6g}" for name, value in values.items()})
        add_row(given.results, case, row)
        print(f"{time.strftime('%H:%M:%S')}  {name_of(case):50} {cpu:8.1f} s CPU  {status}",
              flush=True)
        if given.keep:
            shutil.copytree(directory, given.keep / name_of(case).replace(" ", "_"),
                            dirs_exist_ok=True)
    finally:
        shutil.rmtree(directory, ignore_errors=True)


def options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="REGEX")
    parser.add_argument("--budget", type=float, default=math.inf, metavar="MINUTES",
                        help="start no run after this time")
    parser.add_argument("--limit", type=float, default=60, metavar="MINUTES",
                        help="a run that takes longer fails (default %(default)g)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="runs at the same time")
    parser.add_argument("--list", action="store_true", help="say what is missing, run nothing")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="keep scripts and frames")
    parser.add_argument("--results", type=pathlib.Path, default=HERE / "results", metavar="DIR")
    parser.add_argument("--program", default=str(ROOT / "build" / "bin" / "gasgrain"))
    return parser.parse_args()


def interrupt(*_):
    raise KeyboardInterrupt


def main():
    given = options()
    signal.signal(signal.SIGTERM, interrupt)
    done = {scene: {tuple(row[c] for c in ("law", "l", "seed", "factor", "value"))
                    for row in rows_of(given.results, scene)} for scene in SCENES}
    wanted = [case for case in all_cases() if re.search(given.only, name_of(case))]
    missing = [case for case in wanted if case.key not in done[case.scene]]
    print(f"{len(wanted) - len(missing)} of {len(wanted)} runs are done")
    if given.list:
        print("\n".join(name_of(case) for case in missing))
        return
    if not pathlib.Path(given.program).exists():
        sys.exit(f"ERROR: no program {given.program}: build first, or say --program")
    given.results.mkdir(exist_ok=True)
    end, version = time.monotonic() + 60 * given.budget, commit()

    def run_in_time(case):
        if time.monotonic() < end and not STOPPED.is_set():
            one_run(case, given, version)

    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        futures = [pool.submit(run_in_time, case) for case in missing]
        try:
            for future in futures:
                future.result()
        except BaseException:
            STOPPED.set()
            for process in list(RUNNING):
                process.kill()
            raise


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; the next call continues")
