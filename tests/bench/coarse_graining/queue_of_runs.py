"""Runs what is missing of the time-error benchmark and adds a row per run to results/SCENE.csv.

    tests/bench/coarse_graining/run [--only REGEX] [--budget MINUTES] [--jobs N] [--list]

Interrupt it whenever you like: finished runs have their row, the next call continues. REGEX is
searched in names such as `column cgm-n3 l=2 seed=1` or `bed cgm-n3 l=2 seed=3 cell=2.5e-3`. A run
that fails has a row that says why and is not repeated; delete the row to repeat it.
"""

import os
import pathlib
import sys

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


def measured(case, directory, status):
    """(status, grains inserted, values): a run that lost grains has failed."""
    scene = SCENES[case.scene]
    if status != "ok":
        return status, scene.grains(case), {}
    frames = measures.read_frames(directory / "frames.dump")
    inserted = len(frames[0])
    if inserted < 0.99 * scene.grains(case):
        return f"failed: only {inserted} of {scene.grains(case)} grains inserted", inserted, {}
    if len(frames[-1]) < inserted and not scene.loses_grains:
        return f"failed: {inserted - len(frames[-1])} grains lost", inserted, {}
    return status, inserted, scene.measure(frames, scene, case, directory)


def one_run(case, given, version):
    scene, dt = SCENES[case.scene], SCENES[case.scene].step(case)

    def row_of(directory, status, cpu):
        status, grains, values = measured(case, directory, status)
        steps = round((scene.settle + scene.time) / dt)
        row = dict(zip(("law", "l", "seed", "factor", "value"), case.key), grains=grains,
                   steps=steps, grain_steps=f"{grains * steps:.4g}", cpu_seconds=f"{cpu:.2f}",
                   step=f"{dt:.4g}", status=status, commit=version,
                   load=f"{os.getloadavg()[0]:.1f}",
                   **{name: f"{value:.6g}" for name, value in values.items()})
        table = given.results / f"{case.scene}.csv"
        return table, COLUMNS + list(scene.quantities), row, status

    resumable_queue.make_run(name_of(case), given, lambda directory: prepare(case, directory),
                             row_of)


def main():
    given = resumable_queue.options(__doc__, HERE / "results", limit=60)
    done = {scene: {tuple(row[c] for c in ("law", "l", "seed", "factor", "value"))
                    for row in resumable_queue.rows_of(given.results / f"{scene}.csv")}
            for scene in SCENES}
    resumable_queue.make_missing(given, all_cases(), name_of,
                                 lambda case: case.key in done[case.scene], one_run)


if __name__ == "__main__":
    main()
