"""Runs what is missing of the time-error benchmark and adds a row per run to results/SCENE.csv.

    tests/bench/coarse_graining/run [--only REGEX] [--budget MINUTES] [--jobs N] [--list]

Interrupt it whenever you like: finished runs have their row, the next call continues. REGEX is
searched in names such as `column cgm-n3 l=2 seed=1` or `bed cgm-n3 l=2 seed=3 cell=2.5e-3`. A run
that fails has a row that says why and is not repeated; delete the row to repeat it.
"""

import argparse
import os
import pathlib
import shutil
import sys
import tempfile
import time

import measures
from cases import MESHES, SCENES, all_cases

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import resumable_queue  # noqa: E402

COLUMNS = ["law", "l", "seed", "factor", "value", "grains", "steps", "grain_steps", "cpu_seconds",
           "step", "status", "commit", "load"]


def name_of(case):
    factor = f" {case.factor}={case.value}" if case.factor else ""
    return f"{case.scene} {case.law} l={case.l:g} seed={case.seed}{factor}"


def prepare(case, directory):
    scene = SCENES[case.scene]
    (directory / "scene.in").write_text(scene.script(case))
    (directory / "case.toml").write_text(scene.case_file(case))
    if case.scene in MESHES:
        name, text = MESHES[case.scene]
        (directory / name).write_text(text())


def one_run(case, given, version):
    scene, dt = SCENES[case.scene], SCENES[case.scene].step(case)
    directory = pathlib.Path(tempfile.mkdtemp(prefix="gasgrain-bench-"))
    try:
        prepare(case, directory)
        status, cpu = resumable_queue.run_program(given.program, directory, 60 * given.limit)
        if resumable_queue.STOPPED.is_set():
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
        resumable_queue.add_row(given.results / f"{case.scene}.csv",
                                COLUMNS + list(scene.quantities), row)
        print(f"{time.strftime('%H:%M:%S')}  {name_of(case):50} {cpu:8.1f} s CPU  {status}",
              flush=True)
        if given.keep:
            shutil.copytree(directory, given.keep / name_of(case).replace(" ", "_"),
                            dirs_exist_ok=True)
    finally:
        shutil.rmtree(directory, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    resumable_queue.add_options(parser, HERE / "results", limit=60)
    given = parser.parse_args()
    done = {scene: {tuple(row[c] for c in ("law", "l", "seed", "factor", "value"))
                    for row in resumable_queue.rows_of(given.results / f"{scene}.csv")}
            for scene in SCENES}
    resumable_queue.make_missing(given, all_cases(), name_of,
                                 lambda case: case.key in done[case.scene], one_run)


if __name__ == "__main__":
    main()
