"""A queue of runs of gasgrain that can be interrupted: a run that is done has its row in a table,
the next call makes what is missing. For the benchmarks in the directories below.
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

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from mpi_environment import mpi_environment  # noqa: E402

LOCK = threading.Lock()
RUNNING = set()  # processes
STOPPED = threading.Event()  # rows of runs that were cut off are not written


def rows_of(path):
    if not path.exists():
        return []
    with open(path) as file:
        return list(csv.DictReader(file))


def add_row(path, columns, row):
    with LOCK:
        new = not path.exists()
        path.parent.mkdir(parents=True, exist_ok=True)
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


def run_program(program, directory, limit):
    """Runs scene.in of the directory for at most `limit` s: (status, CPU seconds)."""
    with open(directory / "screen", "w") as screen:
        process = subprocess.Popen([program, "-in", "scene.in", "-log", "log"], cwd=directory,
                                   env=mpi_environment(), stdin=subprocess.DEVNULL, stdout=screen,
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


def make_run(name, given, prepare, row_of):
    """Runs what prepare(directory) writes and adds its row. row_of(directory, status, CPU seconds)
    returns the table's path, its columns, the row and what to print of it.
    """
    directory = pathlib.Path(tempfile.mkdtemp(prefix="gasgrain-bench-"))
    try:
        prepare(directory)
        status, cpu = run_program(given.program, directory, 60 * given.limit)
        if STOPPED.is_set():
            return
        path, columns, row, result = row_of(directory, status, cpu)
        add_row(path, columns, row)
        print(f"{time.strftime('%H:%M:%S')}  {name:50} {cpu:8.1f} s CPU  {result}", flush=True)
        if given.keep:
            shutil.copytree(directory, given.keep / name.replace(" ", "_"), dirs_exist_ok=True)
    finally:
        shutil.rmtree(directory, ignore_errors=True)


def options(description, results, limit):
    """The options given; `results`: default of --results; `limit`: of --limit, minutes."""
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="REGEX")
    parser.add_argument("--budget", type=float, default=math.inf, metavar="MINUTES",
                        help="start no run after this time")
    parser.add_argument("--limit", type=float, default=limit, metavar="MINUTES",
                        help="a run that takes longer fails (default %(default)g)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="runs at the same time")
    parser.add_argument("--list", action="store_true", help="say what is missing, run nothing")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="keep the runs' files")
    parser.add_argument("--results", type=pathlib.Path, default=results, metavar="PATH")
    parser.add_argument("--program", default=str(ROOT / "build" / "bin" / "gasgrain"))
    return parser.parse_args()


def interrupt(*_):
    raise KeyboardInterrupt


def make_missing(given, cases, name_of, is_done, one_run):
    """Calls one_run(case, given, commit) for the cases that --only names and that are not done."""
    signal.signal(signal.SIGTERM, interrupt)
    wanted = [case for case in cases if re.search(given.only, name_of(case))]
    missing = [case for case in wanted if not is_done(case)]
    print(f"{len(wanted) - len(missing)} of {len(wanted)} runs are done", flush=True)
    if given.list:
        print("\n".join(name_of(case) for case in missing))
        return
    if not pathlib.Path(given.program).exists():
        sys.exit(f"ERROR: no program {given.program}: build first, or say --program")
    end, version = time.monotonic() + 60 * given.budget, commit()

    def run_in_time(case):
        if time.monotonic() < end and not STOPPED.is_set():
            one_run(case, given, version)

    try:
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
    except KeyboardInterrupt:
        sys.exit("stopped; the next call continues")
