#!/usr/bin/python3
"""Cost of a grain-step: stock LIGGGHTS, stock LAMMPS, and the fused engine, on the same beds.

    tests/bench/dem/compare.py BUILD_DIRECTORY [--grains 50000] [--ranks 1] [--states ABC] ...

The scene is a box with four tubes (scene.py), settled once and kept in out/bench. With `--bed FILE`
it is a box of 50 x 10 x 200 mm without tubes and that bed of 0.5 mm grains (columns x,y,z), of
which `--copies` are set side by side along y. States:
    A  grains of 0.48 mm with random velocities of 0.1 m/s: almost collisional
    B  settled, with random velocities of 0.1 m/s
    C  settled
Programs:
    stock      liggghts, planes as primitive walls, tubes as meshes
    primitive  liggghts, tubes as primitive walls
    lammps     LAMMPS gran/hooke/history (Debian package lammps), tubes as a region
    unchanged  gasgrain with the script of `primitive`, fused
    meshes     gasgrain with the script of `stock`, fused
    cgm        gasgrain, our law and SDF walls, engine off
    fused      the same, fused
    mixed      the same in mixed precision
They run one after the other in every repetition; the table gives medians of wall nanoseconds per
grain and step, how many times less that is than in stock LIGGGHTS (the faster of its scripts) and
LAMMPS, and the largest resident size of all ranks per grain. Table and plot also go to the output
directory. With the default scene, states and programs the medians are stored in results/ and the
page docs/engine_cost.md is made anew from all that are stored.
"""

import argparse
import csv
import pathlib
import statistics
import tempfile

import scene as scenes
from settled_bed import read_bed, settled

ROOT = pathlib.Path(__file__).resolve().parents[3]
RESULTS = pathlib.Path(__file__).resolve().parent / "results"
PAGE = ROOT / "docs" / "engine_cost.md"
PROGRAMS = ("stock", "lammps", "unchanged", "fused", "mixed")
# Times faster than LIGGGHTS and LAMMPS, in states A, B, C
TARGETS = {"fused": ("5 / 3 / 3", "6 / 3.5 / 3.5"), "mixed": ("6.5 / 4 / 4", "-")}
REFERENCES = {"liggghts": ("stock", "primitive"), "lammps": ("lammps",)}


def measure(scene, bed, state, given):
    """Samples of wall ns per grain-step, and bytes per grain, of every program."""
    grains = scene.copies * len(bed)
    samples, memory = {program: [] for program in given.programs}, {}
    with tempfile.TemporaryDirectory(prefix="gasgrain-bench-") as name:
        directory = pathlib.Path(name)
        files = {**scene.files(), "grains.data": scenes.data_file(scene, bed, state)}
        for file, text in files.items():
            (directory / file).write_text(text)
        for _ in range(given.repeats):
            for program in given.programs:
                executable = scenes.STOCK_EXECUTABLE.get(program) or str(given.gasgrain)
                done = scenes.run([*scenes.mpi(given.ranks), executable], directory,
                                  scenes.script(program, scene, given))
                samples[program].append(done.seconds * 1e9 / (grains * given.steps))
                memory[program] = done.bytes * given.ranks / grains
    return samples, memory


def times_faster(cost, program, references):
    """None if none of the references was measured."""
    known = [cost[name] for name in references if name in cost]
    return min(known) / cost[program] if known else None


def columns_of(programs):
    """Names of the columns of a state: costs, then ratios of the fused programs."""
    ours = [program for program in programs if program in TARGETS]
    return [*programs, *(f"{name}/{program}" for program in ours for name in REFERENCES)]


def cells_of(cost):
    ratios = [times_faster(cost, program, references) for program in cost if program in TARGETS
              for references in REFERENCES.values()]
    return [*(f"{value:.1f}" for value in cost.values()),
            *("-" if value is None else f"{value:.2f}" for value in ratios)]


def medians(samples):
    return {program: statistics.median(values) for program, values in samples.items()}


def write_result(path, costs, memory):
    path.parent.mkdir(exist_ok=True)
    with open(path, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["state", *PROGRAMS, *(f"bytes_{name}" for name in PROGRAMS)])
        for state, cost in costs.items():
            table.writerow([state, *(f"{cost[name]:.2f}" for name in PROGRAMS),
                            *(f"{memory[state][name]:.0f}" for name in PROGRAMS)])


def write_page():
    """All stored results as docs/engine_cost.md."""
    lines = ["# The fused engine against stock LIGGGHTS and LAMMPS", "",
             "Made by `tests/bench/dem/compare.py` from `tests/bench/dem/results/`. Wall "
             "nanoseconds per grain and step, then times faster than stock LIGGGHTS and LAMMPS, "
             "then bytes per grain of the whole process.", "",
             "States: A grains of 0.48 mm with random velocities of 0.1 m/s, almost collisional; "
             "B settled, with random velocities of 0.1 m/s; C settled. Programs: `stock` LIGGGHTS with "
             "tubes as meshes; `lammps` `gran/hooke/history`; `unchanged` "
             "gasgrain with LIGGGHTS's own law and primitive walls; `fused` with the law `cgm` and "
             "SDF walls; `mixed` the same in mixed precision.", "",
             "Targets, times faster in A / B / C: "
             + "; ".join(f"`{name}` {ours} than LIGGGHTS" + (f", {theirs} than LAMMPS"
                                                             if theirs != "-" else "")
                         for name, (ours, theirs) in TARGETS.items()) + "."]
    paths = sorted(RESULTS.glob("*.csv"), key=lambda path: [*map(int, path.stem.split("_"))])
    if not paths:
        lines += ["", "No run is stored."]
    for path in paths:
        grains, ranks = path.stem.split("_")
        names = ["state", *columns_of(PROGRAMS), *(f"B/grain {name}" for name in PROGRAMS)]
        number = f"{int(grains):,}".replace(",", " ")
        lines += ["", f"## {number} grains, {ranks} rank(s)", "",
                  "| " + " | ".join(names) + " |", "|" + "---|" * len(names)]
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                cost = {name: float(row[name]) for name in PROGRAMS}
                cells = [row["state"], *cells_of(cost), *(row[f"bytes_{n}"] for n in PROGRAMS)]
                lines.append("| " + " | ".join(cells) + " |")
    PAGE.write_text("\n".join(lines) + "\n")


def plot(path, costs, title):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 3.6), constrained_layout=True)
    programs = list(next(iter(costs.values())))
    width = 0.8 / len(programs)
    for n, program in enumerate(programs):
        places = [k + (n - (len(programs) - 1) / 2) * width for k in range(len(costs))]
        bars = axes.bar(places, [cost[program] for cost in costs.values()], width, label=program)
        axes.bar_label(bars, fmt="%.0f", fontsize=7)
    axes.set_xticks(range(len(costs)), [f"state {state}" for state in costs])
    axes.set_ylabel("ns per grain and step")
    axes.set_title(title, fontsize=10)
    axes.legend(frameon=False, fontsize=8)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=150)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--grains", type=int, default=50_000)
    parser.add_argument("--bed", type=pathlib.Path)
    parser.add_argument("--copies", type=int, default=1)
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--skin", type=float, default=5e-5)
    parser.add_argument("--states", default="ABC")
    parser.add_argument("--programs", default=",".join(PROGRAMS),
                        type=lambda text: text.split(","))
    parser.add_argument("--stock-model", choices=("hooke/stiffness", "hertz"),
                        default="hooke/stiffness")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "bench" / "dem")
    given = parser.parse_args()
    given.gasgrain = (given.build / "bin" / "gasgrain").resolve()
    return given


def main():
    given = arguments()
    if given.bed:
        scene, bed = scenes.Scene(copies=given.copies), read_bed(given.bed)
    else:
        scale = (given.grains / scenes.GRAINS_AT_SCALE_ONE) ** (1 / 3)
        scene = scenes.Scene(scale, with_tubes=True)
        bed = settled(scene, given.grains, given.gasgrain, given.ranks,
                      given.out / f"bed_{given.grains}.csv.gz")
    title = f"{scene.copies * len(bed)} grains, {given.ranks} rank(s)"
    names = ["state", *columns_of(given.programs), "B/grain"]
    widths = [max(10, len(name) + 2) for name in names]

    def line(cells):
        return "".join(f"{cell:>{width}}" for cell, width in zip(cells, widths))

    lines = [f"{title}, {given.steps} steps, ns per grain-step, times faster; targets A / B / C: " +
             ", ".join(f"{name} {ours} of liggghts" for name, (ours, _) in TARGETS.items()),
             line(names)]
    print("\n".join(lines), flush=True)
    costs, memory = {}, {}
    for state in given.states:
        samples, memory[state] = measure(scene, bed, state, given)
        costs[state] = medians(samples)
        lines.append(line([state, *cells_of(costs[state]),
                           f"{list(memory[state].values())[-1]:.0f}"]))
        print(lines[-1], flush=True)
    given.out.mkdir(parents=True, exist_ok=True)
    stem = given.out / f"cost_{scene.copies * len(bed)}_{given.ranks}"
    stem.with_suffix(".txt").write_text("\n".join(lines) + "\n")
    plot(stem.with_suffix(".png"), costs, title)
    if not given.bed and given.states == "ABC" and tuple(given.programs) == PROGRAMS:
        write_result(RESULTS / f"{given.grains}_{given.ranks}.csv", costs, memory)
        write_page()


if __name__ == "__main__":
    main()
