#!/usr/bin/env python3
"""Cost of a gas step: by pass and size, by what the case has, and ours against hypre's solvers.

    tests/bench/gas/compare.py BUILD_DIRECTORY [--quick] [--ranks 1 2] [--output DIRECTORY]

BUILD_DIRECTORY is configured with -DGASGRAIN_BENCHMARKS=ON. Times are milliseconds of wall time of
a step with a warm start, set-up of the pressure solver included (`solve`); medians over the steps.
--cpu gives CPU time of the slowest rank instead: for a machine that has other work. Writes
gas_step.md, gas_step.json and, with matplotlib, gas_step.png to the output directory (default: the
working directory). --quick leaves out everything above 51 200 cells and takes
12 steps instead of 40.
"""

import argparse
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from mpi_environment import mpi_environment  # noqa: E402

VESSEL = {51200: (40, 8, 160), 409600: (80, 16, 320), 1045000: (109, 22, 436),
          4023000: (172, 34, 688)}
DIE = {50653: (37, 37, 37), 1000000: (100, 100, 100)}
METHODS = ["multigrid", "hypre-pfmg", "hypre-pfmg-rap", "hypre-smg", "hypre-boomeramg"]
PASSES = ["slope", "medium", "predict", "boundary", "equation", "solve", "correct", "budget"]
ABSENT = [("all of it", []), ("no bodies", ["--geometry", "box"]), ("no drag", ["--no-drag"]),
          ("no grains", ["--no-grains"]), ("no viscosity", ["--no-viscosity"]),
          ("no bodies, no grains", ["--geometry", "box", "--no-grains"])]


class Bench:
    def __init__(self, program, clock, most_steps):
        self.program, self.clock, self.results = str(program), clock, []
        self.most_steps = most_steps

    def run(self, cells, ranks, *more, steps=0):
        count = cells[0] * cells[1] * cells[2]
        steps = steps or max(5, min(self.most_steps, 4_000_000 // count))
        start = ["mpirun", "--oversubscribe", "-n", str(ranks)]
        command = [*start, self.program, "--cells", *map(str, cells), "--steps", str(steps), *more]
        done = subprocess.run(command, env=mpi_environment(), text=True, capture_output=True)
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(command)} failed:\n{done.stdout}{done.stderr}")
        result = json.loads(done.stdout.splitlines()[-1])
        self.results.append({**result, "options": list(more)})
        return result

    def ms(self, result, name):
        return 1e3 * result[name][self.clock]


def row(*values):
    return "| " + " | ".join(str(value) for value in values) + " |\n"


def head(*names):
    return row(*names) + "|" + "---|" * len(names) + "\n"


def table_of_sizes(bench, sizes, ranks):
    text = "\n## One step by size, ms\n\n"
    text += head("cells", "ranks", *PASSES, "step", "ns per cell", "step / solve", "iterations")
    for cells in sizes:
        for count in ranks:
            result = bench.run(cells, count)
            step, solve = bench.ms(result, "step"), bench.ms(result, "solve")
            text += row(result["cells"], count, *(f"{bench.ms(result, p):.2f}" for p in PASSES),
                        f"{step:.2f}", f"{1e6 * step / result['cells']:.0f}",
                        f"{step / solve:.2f}", f"{result['iterations']:.1f}")
    return text


def table_of_methods(bench, scenes, ranks):
    text = "\n## Pressure solve with set-up, ms (iterations)\n\n"
    text += head("scene", "cells", "ranks", *METHODS, "best of hypre over ours")
    for name, cells, options in scenes:
        for count in ranks:
            results = [bench.run(cells, count, *options, "--method", method) for method in METHODS]
            times = [bench.ms(result, "solve") for result in results]
            # a method that did not solve the system by itself does not count
            sound = [t for t, r in zip(times[1:], results[1:]) if r["fallbacks"] == 0]
            entries = [f"{t:.2f} ({r['iterations']:.1f})" + (" fell back" if r["fallbacks"] else "")
                       for t, r in zip(times, results)]
            text += row(name, results[0]["cells"], count, *entries, f"{min(sound) / times[0]:.2f}")
    return text


def table_of_absent(bench, cells):
    text = "\n## What a case does not have costs nothing, ms\n\n"
    text += head("case", "cells", *PASSES, "step")
    flat = (cells[0] * 2, 1, cells[2] * 2)
    cases = [(name, cells, options) for name, options in ABSENT]
    for name, size, options in [*cases, ("one cell deep", flat, [])]:
        result = bench.run(size, 1, *options)
        text += row(name, result["cells"], *(f"{bench.ms(result, p):.2f}" for p in PASSES),
                    f"{bench.ms(result, 'step'):.2f}")
    return text


def plot(bench, path):
    try:
        import matplotlib
    except ImportError:
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7, 4.5))
    for name, marker in (("step", "o-"), ("solve", "s--")):
        for ranks in sorted({r["ranks"] for r in bench.results}):
            points = sorted((r["cells"], bench.ms(r, name)) for r in bench.results
                            if not r["options"] and r["ranks"] == ranks)
            if points:
                axes.loglog(*zip(*points), marker, label=f"{name}, {ranks} rank(s)")
    for method in METHODS[1:]:
        points = sorted((r["cells"], bench.ms(r, "solve")) for r in bench.results
                        if r["options"] == ["--method", method] and r["ranks"] == 1)
        if points:
            axes.loglog(*zip(*points), ":", marker="x", label=f"solve by {method}")
    axes.set_xlabel("cells")
    axes.set_ylabel("ms")
    axes.legend(fontsize=8)
    axes.grid(True, which="both", alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--cpu", action="store_true")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("."))
    given = parser.parse_args()
    bench = Bench((given.build / "bin" / "gas_step_cost").resolve(), "cpu" if given.cpu else "wall",
                  most_steps=12 if given.quick else 40)
    limit = 60_000 if given.quick else 10_000_000
    vessel = [cells for count, cells in VESSEL.items() if count <= limit]
    compared = [("tubes, open", cells, []) for cells in vessel if len(vessel) == 1
                or cells in (VESSEL[51200], VESSEL[1045000])]
    compared += [("tubes, sealed", cells, ["--sealed"]) for _, cells, _ in list(compared)]
    compared += [("tubes, no drag", VESSEL[51200], ["--no-drag"])]
    compared += [("die", cells, []) for count, cells in DIE.items() if count <= limit]
    compared = [(name, cells, [*options, *(["--geometry", "die"] if name == "die" else [])])
                for name, cells, options in compared]
    text = "# Cost of a gas step\n\n" + ("CPU" if given.cpu else "Wall") + " time.\n"
    text += table_of_sizes(bench, vessel, given.ranks)
    text += table_of_methods(bench, compared, given.ranks[:1] if given.quick else given.ranks)
    text += table_of_absent(bench, VESSEL[51200])
    print(text)
    given.output.mkdir(parents=True, exist_ok=True)
    (given.output / "gas_step.md").write_text(text)
    (given.output / "gas_step.json").write_text(json.dumps(bench.results, indent=1) + "\n")
    plot(bench, given.output / "gas_step.png")


if __name__ == "__main__":
    main()
