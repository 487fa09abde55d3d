"""Runs what is missing of the stability map, a row per point in map.csv, and draws map.png.

    tests/bench/stability/run [--only REGEX] [--budget MINUTES] [--jobs N] [--list]

Interrupt it whenever you like: finished points have their row, the next call continues. REGEX is
searched in names such as `plug interval=0.5`. To repeat a point, delete its row.
"""

import os
import pathlib
import sys

import judge
import scenes
from points import FACTORS, all_points

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import resumable_queue  # noqa: E402

COLUMNS = ["name", "scene", *FACTORS, "diameter", "within", "verdict", "why", "pressure_drop",
           "law", "deviation", "used_interval", "growth", "heating", "momentum",
           "exchange", "grains", "cpu_seconds", "status", "commit"]


def one_point(point, given, version):
    def prepare(directory):
        (directory / "scene.in").write_text(scenes.script(point))
        (directory / "case.toml").write_text(scenes.case_file(point))

    def row_of(directory, status, cpu):
        measured = judge.measure(point, directory) if status == "ok" else {}
        verdict, why = judge.verdict(status, measured, directory)
        row = {name: getattr(point, name) for name in FACTORS}
        row |= {name: f"{value:.4g}" for name, value in measured.items()}
        row |= {"name": point.name, "scene": point.scene, "diameter": point.diameter,
                "within": int(point.is_within), "verdict": verdict, "why": why,
                "cpu_seconds": f"{cpu:.1f}", "status": status, "commit": version}
        return given.results, COLUMNS, row, f"{verdict:8} {why}"

    resumable_queue.make_run(point.name, given, prepare, row_of)


def main():
    given = resumable_queue.options(__doc__, HERE / "map.csv", limit=2)
    done = {row["name"] for row in resumable_queue.rows_of(given.results)}
    resumable_queue.make_missing(given, all_points(), lambda point: point.name,
                                 lambda point: point.name in done, one_point)
    rows = resumable_queue.rows_of(given.results)
    if rows and not given.list:
        import draw_map
        draw_map.draw(rows, given.results.with_suffix(".png"))
        judge.print_totals(rows)


if __name__ == "__main__":
    os.nice(5)
    main()
