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
    cgm        gasgrain, our law and SDF walls, engine off
    fused      the same, fused
They run one after the other in every repetition; the table gives medians of wall nanoseconds per
grain and step, and the largest resident size of the last program (all ranks) per grain. Table and
plot also go to the output directory.
"""

import argparse
import pathlib
import statistics
import tempfile

import scene as scenes
from settled_bed import read_bed, settled

ROOT = pathlib.Path(__file__).resolve().parents[3]
TARGETS = {"A": 5, "B": 3, "C": 3}  # times the faster stock LIGGGHTS


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


def ratio(cost, programs):
    """Of the fastest of `programs` that were measured to the last program; None without any."""
    known = [cost[program] for program in programs if program in cost]
    return min(known) / list(cost.values())[-1] if known else None


def row(state, samples, memory):
    cost = {program: statistics.median(values) for program, values in samples.items()}
    cells = [f"{value:.1f}" for value in cost.values()]
    for reference in (("stock", "primitive"), ("lammps",)):
        times = ratio(cost, reference)
        cells.append("-" if times is None else f"{times:.2f}")
    return [state, *cells, f"{list(memory.values())[-1]:.0f}"], cost


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
    parser.add_argument("--programs", default="stock,lammps,unchanged,fused",
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
    names = ["state", *given.programs, "x liggghts", "x lammps", "B/grain"]
    lines = [f"{title}, {given.steps} steps, ns per grain-step; targets against liggghts: " +
             ", ".join(f"{state} {times}" for state, times in TARGETS.items()),
             "".join(f"{name:>12}" for name in names)]
    print("\n".join(lines), flush=True)
    costs = {}
    for state in given.states:
        cells, costs[state] = row(state, *measure(scene, bed, state, given))
        lines.append("".join(f"{cell:>12}" for cell in cells))
        print(lines[-1], flush=True)
    given.out.mkdir(parents=True, exist_ok=True)
    stem = given.out / f"cost_{scene.copies * len(bed)}_{given.ranks}"
    stem.with_suffix(".txt").write_text("\n".join(lines) + "\n")
    plot(stem.with_suffix(".png"), costs, title)


if __name__ == "__main__":
    main()
