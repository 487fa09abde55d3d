#!/usr/bin/python3
"""Cost of a grain's contact with a wall in LIGGGHTS's own time loop, on one core: stock primitive
wall, stock mesh walls, and fix wall/sdf.

    tests/bench/walls/compare.py BUILD_DIRECTORY [--grains 256] [--steps 40000] [--plot walls.png]

Grains rest on a plane next to each other without touching; every grain touches the wall and no
other grain, so what a wall adds to the run without walls is the cost of its contacts. Processor
time of a long run less that of a short one, so that set-up (reading meshes) is left out; medians of
interleaved repetitions. `away` has the wall out of reach of all grains.
"""

import argparse
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dem"))

import scene  # noqa: E402

DIAMETER, GAP = scene.SIZE, 1.3  # m; distance of grains in diameters
OVERLAP = scene.MASS * 9.81 / scene.K  # m, under the weight
STOCK_MODEL = ("hooke/stiffness tangential history {wall} absolute_damping on "
               "tangential_damping on limitForce off")


def side(count):
    """Number of grains in a row, and length of the floor in m."""
    rows = math.ceil(math.sqrt(count))
    return rows, rows * GAP * DIAMETER


def data_file(count):
    rows, length = side(count)
    lines = ["grains", "", f"{count} atoms", "2 atom types"]
    lines += [f"{-0.06 * length:.9g} {1.06 * length:.9g} {d}lo {d}hi" for d in "xy"]
    lines += ["-0.002 0.004 zlo zhi", "", "Atoms", ""]
    for n in range(count):
        x, y = ((i + 0.5) * GAP * DIAMETER for i in (n % rows, n // rows))
        lines.append(f"{n + 1} 1 {DIAMETER} {scene.DENSITY} {x:.9g} {y:.9g} "
                     f"{0.5 * DIAMETER - OVERLAP:.12g}")
    return "\n".join(lines) + "\n"


def floor_triangles(length, triangles):
    """Corners of the triangles of the floor z = 0, a little larger than the box."""
    cells = math.ceil(math.sqrt(triangles / 2))
    low, step = -0.05 * length, 1.1 * length / cells
    for i in range(cells):
        for j in range(cells):
            x, y = low + i * step, low + j * step
            yield (x, y, 0), (x + step, y, 0), (x + step, y + step, 0)
            yield (x, y, 0), (x + step, y + step, 0), (x, y + step, 0)


def block_triangles(length, triangles):
    """The closed block below that floor."""
    yield from floor_triangles(length, triangles)
    low, high, bottom = -0.05 * length, 1.05 * length, -0.003
    cells = math.ceil(math.sqrt(triangles / 2))
    corners = [low + (high - low) * n / cells for n in range(cells + 1)]
    ring = ([(c, low) for c in corners] + [(high, c) for c in corners[1:]]
            + [(c, high) for c in reversed(corners[:-1])]
            + [(low, c) for c in reversed(corners[:-1])])
    middle = (0.5 * (low + high), 0.5 * (low + high), bottom)
    for (xa, ya), (xb, yb) in zip(ring, ring[1:]):
        yield (xa, ya, bottom), (xb, yb, bottom), (xb, yb, 0)
        yield (xa, ya, bottom), (xb, yb, 0), (xa, ya, 0)
        yield middle, (xb, yb, bottom), (xa, ya, bottom)


def stl(mesh):
    text = "solid floor\n"
    for corners in mesh:
        text += "facet normal 0 0 0\n outer loop\n"
        text += "".join("  vertex {:.9g} {:.9g} {:.9g}\n".format(*corner) for corner in corners)
        text += " endloop\nendfacet\n"
    return text + "endsolid floor\n"


CASE = """[[body]]
name = "plane"
plane = {point = [0, 0, 0], normal = [0, 0, 1]}
[[body]]
name = "away"
plane = {point = [0, 0, -0.0015], normal = [0, 0, 1]}
"""


def sample(length, meshes, gasgrain_sdf, directory):
    """Files of the plane by both interpolations and of the meshes; a quarter of the radius apart."""
    ends = [f"{share * length:.9g}" for share in (-0.04, 1.04)]
    box = ["--lower", ends[0], ends[0], "-0.0006", "--upper", ends[1], ends[1], "0.0006",
           "--margin", "0", "--spacing", f"{DIAMETER / 8}", "--band", f"{0.7 * DIAMETER}",
           "--allow-cut"]
    made = {f"stl{count}": ["--stl", f"block{count}.stl"] for count in meshes}
    for kind in ("quadratic", "linear"):
        made[kind] = ["case.toml", "--body", "plane", "--interpolation", kind]
    for name, source in made.items():
        command = [gasgrain_sdf, *source, *box, "-o", f"{name}.h5"]
        done = subprocess.run(command, cwd=directory, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        if done.returncode != 0:
            raise SystemExit(f"{command} failed:\n{done.stdout}")


def variants(meshes):
    """Name -> (program, wall): what stands in the script for the wall."""
    stock_wall = "all wall/gran model " + STOCK_MODEL
    yield "stock: no wall", "stock", ""
    yield "stock: primitive", "stock", ("fix w " + stock_wall.format(
        wall="primitive type 2 zplane 0.0") + "\n")
    for count in meshes:
        yield f"stock: mesh of {count} triangles", "stock", (
            f"fix mesh all mesh/surface file floor{count}.stl type 2\nfix w "
            + stock_wall.format(wall="mesh n_meshes 1 meshes mesh") + "\n")
    yield "sdf: no wall", "ours", ""
    for body in ("plane", "away"):
        yield f"sdf: {body}", "ours", f"fix w all wall/sdf case case.toml body {body} type 2\n"
    for field in ["quadratic", "linear"] + [f"stl{count}" for count in meshes]:
        yield f"sdf: {field}", "ours", f"fix w all wall/sdf body {field}.h5 type 2\n"


def script(program, wall, steps):
    if program == "stock":
        text = scene.property_global("kn", scene.K, scene.K)
        text += scene.property_global("kt", scene.K, scene.K)
        text += scene.property_global("gamman_abs", scene.DAMPING, scene.DAMPING_AT_WALL)
        text += scene.property_global("gammat_abs", scene.DAMPING, scene.DAMPING_AT_WALL)
        model = STOCK_MODEL.format(wall="")
    else:
        text = scene.property_global("cgmSpringConstant", scene.K, scene.K)
        text += scene.property_global("coefficientRestitution", scene.E, scene.E)
        model = "cgm tangential history"
    text += scene.property_global("coefficientFriction", scene.MU, scene.MU)
    gravity = "fix gravity all gravity 9.81 vector 0 0 -1\n" if wall and "away" not in wall else ""
    return (("gasgrain_engine off\n" if program == "ours" else "") + f"""units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
read_data grains.data
neighbor {0.1 * DIAMETER} bin
neigh_modify delay 0 contact_distance_factor 1.01
{text}pair_style gran model {model}
pair_coeff * *
{wall}timestep {scene.STEP}
{gravity}fix integrate all nve/sphere
thermo_style custom step atoms ke
thermo 1000000
run {steps}
""")


def processor_time(program, directory, text):
    (directory / "in.script").write_text(text)
    with open(directory / "out.txt", "w") as out:
        process = subprocess.Popen([program, "-in", "in.script", "-log", "none"], cwd=directory,
                                   stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT,
                                   env={**os.environ, "OMP_NUM_THREADS": "1"})
        _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{program} failed:\n{(directory / 'out.txt').read_text()[-3000:]}")
    return usage.ru_utime


def measure(programs, meshes, given, directory):
    """Nanoseconds per grain and step of every variant: medians."""
    length = side(given.grains)[1]
    (directory / "grains.data").write_text(data_file(given.grains))
    (directory / "case.toml").write_text(CASE)
    for count in meshes:
        (directory / f"floor{count}.stl").write_text(stl(floor_triangles(length, count)))
        (directory / f"block{count}.stl").write_text(stl(block_triangles(length, count)))
    sample(length, meshes, programs["sdf"], directory)
    samples = {}
    short = given.steps // 10
    for _ in range(given.repeats):
        for name, program, wall in variants(meshes):
            times = [processor_time(programs[program], directory, script(program, wall, steps))
                     for steps in (short, given.steps)]
            samples.setdefault(name, []).append(
                (times[1] - times[0]) * 1e9 / (given.grains * (given.steps - short)))
    return {name: statistics.median(values) for name, values in samples.items()}


def plot(path, contacts):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    figure, axes = pyplot.subplots(figsize=(7, 3.4), constrained_layout=True)
    colours = ["tab:gray" if name.startswith("stock") else "tab:blue" for name in contacts]
    bars = axes.barh(list(contacts), list(contacts.values()), color=colours)
    axes.bar_label(bars, fmt="%.0f", padding=3)
    axes.invert_yaxis()
    axes.set(xlabel="ns per grain in contact and step, LIGGGHTS's time loop, one core")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--grains", type=int, default=256)
    parser.add_argument("--steps", type=int, default=40000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--triangles", type=int, nargs="*", default=[200, 10000])
    parser.add_argument("--plot", type=pathlib.Path)
    given = parser.parse_args()
    programs = {"ours": str((given.build / "bin" / "gasgrain").resolve()),
                "sdf": str((given.build / "bin" / "gasgrain-sdf").resolve()),
                "stock": shutil.which("liggghts") or "liggghts"}
    with tempfile.TemporaryDirectory(prefix="gasgrain-bench-") as name:
        cost = measure(programs, given.triangles, given, pathlib.Path(name))
    bare = {"stock": cost.pop("stock: no wall"), "sdf": cost.pop("sdf: no wall")}
    contacts = {name: value - bare[name.split(":")[0]] for name, value in cost.items()}
    print(f"{given.grains} grains, one core, {given.steps} steps; ns per grain and step")
    print(f"without walls: stock {bare['stock']:.1f}, ours {bare['sdf']:.1f}\n")
    print(f"{'wall':32}{'added':>8}{'of the primitive':>18}")
    for name, value in contacts.items():
        print(f"{name:32}{value:8.1f}{value / contacts['stock: primitive']:18.2f}")
    if given.plot:
        plot(given.plot, contacts)


if __name__ == "__main__":
    main()
