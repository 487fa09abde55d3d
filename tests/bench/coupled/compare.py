#!/usr/bin/env python3
"""Cost of a whole coupled run against stock LIGGGHTS computing the grains alone.

    tests/bench/coupled/compare.py BUILD_DIRECTORY BED.csv[.gz] [--ranks 1] [--steps 1000] ...

The scene in which peers were measured (docs/performance.md): a settled bed of 40 000 grains of 0.5 mm
in a box of 50 x 10 x 200 mm, 51 200 cells, slip walls, gas at 0.2 m/s from below, one gas step per
100 DEM steps of 1e-6 s. Programs: `stock` is liggghts with Hertz contacts and no gas, `coupled` is
gasgrain with `model cgm` of l = 1 and the gas. Medians of wall seconds per 1000 DEM steps, measured
alternately.

BED is at rest under the contacts of `stock`. Stiffer springs would throw it apart, and grains that
do not touch cost little: `coupled` starts from a bed that was settled with its own springs, once, and
is kept in out/bench/coupled.
"""

import argparse
import pathlib
import shutil
import statistics
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "dem"), str(HERE.parents[1])]
import scene as scenes  # noqa: E402  (the bench of the grains alone)
from gas_case import gas_case, inlet  # noqa: E402
from settled_bed import read_bed, settled  # noqa: E402

ROOT = HERE.parents[2]
SCENE = scenes.Scene()


def script(program, given):
    if program == "stock":
        return scenes.script("primitive", SCENE, given)
    return scenes.script("fused", SCENE, given, "fix gas all couple/gas case case.toml\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("bed", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--skin", type=float, default=5e-5)
    given = parser.parse_args()
    given.stock_model = "hertz"
    executable = {"stock": shutil.which("liggghts") or "liggghts",
                  "coupled": str((given.build / "bin" / "gasgrain").resolve())}
    beds = {"stock": read_bed(given.bed)}
    count = len(beds["stock"])
    beds["coupled"] = settled(SCENE, count, executable["coupled"], given.ranks,
                              ROOT / "out" / "bench" / "coupled" / f"bed_{count}.csv.gz")
    samples = {"stock": [], "coupled": []}
    with tempfile.TemporaryDirectory(prefix="gasgrain-bench-") as name:
        directory = pathlib.Path(name)
        places = {name: scenes.data_file(SCENE, bed, "C") for name, bed in beds.items()}
        (directory / "case.toml").write_text(
            gas_case(SCENE.upper, (40, 8, 160), gravity=(0, 0, -9.81), below=inlet(0.2))
            + "[coupling]\nexchange_interval = 1e-4\n" + SCENE.case_file().replace("\nplane", '\nacts_on = ["grains"]\nplane'))
        for _ in range(given.repeats):
            for program in samples:
                (directory / "grains.data").write_text(places[program])
                done = scenes.run([*scenes.mpi(given.ranks), executable[program]], directory,
                                  script(program, given))
                samples[program].append(done.seconds * 1000 / given.steps)
    cost = {program: statistics.median(values) for program, values in samples.items()}
    print(f"{count} grains, {given.ranks} rank(s), seconds per 1000 DEM steps")
    for program, value in cost.items():
        spread = max(samples[program]) - min(samples[program])
        print(f"  {program:8} {value:8.3f}   (spread {spread:.3f})")
    print(f"  coupled / stock grains alone: {cost['coupled'] / cost['stock']:.3f} (target 0.29)")


if __name__ == "__main__":
    main()
