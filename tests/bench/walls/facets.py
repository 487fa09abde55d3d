#!/usr/bin/python3
"""What grains feel of the facets of a mesh: a tube as stock primitive, as stock mesh walls of 48, 192
and 768 triangles, and by fix wall/sdf, exact and sampled.

    tests/bench/walls/facets.py BUILD_DIRECTORY [--csv facets.csv] [--plot facets.png]

1  A grain rolls to and fro in the horizontal tube, let go at 45 degrees, with friction and without
   any loss but the dashpots': the exact solution is a pendulum of length R - r and inertia 7/5 that
   keeps its amplitude.
2  Grains settle in the tube set upright: the share of their weight that its wall carries by
   friction, how much the force on the wall trembles (rms over the weight), and the kinetic energy
   that is left (per grain, over m g d). Means over beds of several seeds.

All walls see the same grains, the same contact law and the same steps. The tube's radius is five
diameters; a mesh has the corners on it.
"""

import argparse
import concurrent.futures
import csv
import math
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "dem"))

import compare  # noqa: E402  (that of this directory)
import scene  # noqa: E402

DIAMETER, DENSITY, GRAVITY = 2e-3, 2500.0, 9.81  # m, kg/m^3, m/s^2
MASS = DENSITY * math.pi / 6 * DIAMETER**3  # kg
STIFFNESS, RESTITUTION, FRICTION = 1000.0, 0.5, 0.5  # N/m, -, -
STEP = math.pi * math.sqrt(0.5 * MASS / STIFFNESS) / 20  # s, a twentieth of the contact time
RADIUS, LENGTH = 5 * DIAMETER, 24 * DIAMETER  # m, of the tube
GRAINS = 600
SETTLING, WATCHED = 0.35, 0.05  # s
RINGS = {48: (24, 1), 192: (48, 2), 768: (96, 4)}  # triangles -> corners around, rings along
SPACING = DIAMETER / 8  # m, of samples


def tube(triangles, axis):
    """Triangles of the tube about the x axis (rolling: y axis) or the z axis."""
    around, along = RINGS[triangles]

    def corner(n, ring):
        turn, height = 2 * math.pi * n / around, LENGTH * (ring / along - 0.5)
        u, v = RADIUS * math.cos(turn), RADIUS * math.sin(turn)
        return (u, v, height) if axis == "z" else (u, height, v)

    for n in range(around):
        for ring in range(along):
            low, high = corner(n, ring), corner(n + 1, ring + 1)
            yield low, corner(n + 1, ring), high
            yield low, high, corner(n, ring + 1)


def case_file(axis):
    direction = "[0, 0, 1]" if axis == "z" else "[0, 1, 0]"
    shape = (f"complement = {{cylinder = {{point = [0, 0, 0], axis = {direction}, "
             f"radius = {RADIUS}}}}}\n")
    corner = [1.5 * RADIUS] * 3
    corner[2 if axis == "z" else 1] = 0.5 * LENGTH
    box = (f"spacing = {SPACING}\nlower = {[-c for c in corner]}\nupper = {corner}\n"
           f"band = {1.5 * DIAMETER}\ncut = true\n")
    return (f'[[body]]\nname = "exact"\n{shape}[[body]]\nname = "sampled"\n{shape}{box}'
            f'[[body]]\nname = "floor"\nplane = {{point = [0, 0, {-0.5 * LENGTH}], '
            'normal = [0, 0, 1]}\n')


def damping(effective_mass):
    """eta of the dashpot in kg/s."""
    log = math.log(RESTITUTION)
    return -2 * log * math.sqrt(effective_mass * STIFFNESS / (math.pi**2 + log**2))


def properties(stock):
    text = scene.property_global("coefficientFriction", FRICTION, FRICTION)
    if not stock:
        return (text + scene.property_global("cgmSpringConstant", STIFFNESS, STIFFNESS)
                + scene.property_global("coefficientRestitution", RESTITUTION, RESTITUTION))
    for name in ("kn", "kt"):
        text += scene.property_global(name, STIFFNESS, STIFFNESS)
    for name in ("gamman_abs", "gammat_abs"):
        text += scene.property_global(name, damping(0.5 * MASS), damping(MASS))
    return text


def walls(kind, axis):
    """Lines of the walls; the tube's force on the grains is v_fz."""
    if kind in ("exact", "sampled"):
        floor = "fix floor all wall/sdf case case.toml body floor type 2\n" if axis == "z" else ""
        return (f"fix tube all wall/sdf case case.toml body {kind} type 2\n{floor}"
                "variable fz equal f_tube[3]\n")
    model = "all wall/gran model " + compare.STOCK_MODEL
    floor = "fix floor " + model.format(wall=f"primitive type 2 zplane {-0.5 * LENGTH}") + "\n"
    floor = floor if axis == "z" else ""
    if kind == "primitive":
        place = f"primitive type 2 {axis}cylinder {RADIUS} 0 0 store_force yes"
        return ("fix tube " + model.format(wall=place) + f"\n{floor}"
                "compute fz all reduce sum f_force_tube[3]\nvariable fz equal -c_fz\n")
    return (f"fix mesh all mesh/surface/stress file tube{kind}.stl type 2 stress on\nfix tube "
            + model.format(wall="mesh n_meshes 1 meshes mesh") + f"\n{floor}"
            "variable fz equal f_mesh[3]\n")


def script(kind, axis, output, steps):
    stock = kind not in ("exact", "sampled")
    model = compare.STOCK_MODEL.format(wall="") if stock else "cgm tangential history"
    return (("" if stock else "gasgrain_engine off\n") + f"""units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
read_data grains.data
neighbor {0.2 * DIAMETER} bin
neigh_modify delay 0 contact_distance_factor 1.01
{properties(stock)}pair_style gran model {model}
pair_coeff * *
{walls(kind, axis)}timestep {STEP}
fix gravity all gravity {GRAVITY} vector 0 0 -1
fix integrate all nve/sphere
compute energy all ke
{output}thermo_style custom step atoms
thermo 1000000
run {steps}
""")


def data_file(places):
    bound = {d: 1.2 * RADIUS for d in "xyz"} | {"z": 0.55 * LENGTH}
    lines = ["grains", "", f"{len(places)} atoms", "2 atom types"]
    lines += [f"{-0.55 * LENGTH} {0.55 * LENGTH} {d}lo {d}hi" for d in bound]
    lines += ["", "Atoms", ""]
    lines += [f"{n + 1} 1 {DIAMETER} {DENSITY} {x:.12g} {y:.12g} {z:.12g}"
              for n, (x, y, z) in enumerate(places)]
    return "\n".join(lines) + "\n"


def run(programs, kind, axis, places, output, steps):
    """Runs one case in a directory of its own; what it wrote to out.txt, as rows of numbers."""
    with tempfile.TemporaryDirectory(prefix="gasgrain-bench-") as name:
        directory = pathlib.Path(name)
        (directory / "grains.data").write_text(data_file(places))
        (directory / "case.toml").write_text(case_file(axis))
        if kind in RINGS:
            (directory / f"tube{kind}.stl").write_text(compare.stl(tube(kind, axis)))
        (directory / "in.script").write_text(script(kind, axis, output, steps))
        program = programs["ours" if kind in ("exact", "sampled") else "stock"]
        done = subprocess.run([program, "-in", "in.script", "-log", "none"], cwd=directory,
                              stdin=subprocess.DEVNULL, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        if done.returncode != 0:
            raise SystemExit(f"{kind}: {program} failed:\n{done.stdout[-3000:]}")
        lines = (directory / "out.txt").read_text().splitlines()
        return [[float(word) for word in line.split()] for line in lines if line[0] != "#"]


AMPLITUDE, SWINGS = math.pi / 4, 8


def pendulum_period():
    a, b = 1.0, math.cos(0.5 * AMPLITUDE)
    for _ in range(10):
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return 2 * math.pi * math.sqrt(1.4 * (RADIUS - 0.5 * DIAMETER) / GRAVITY) / a


def roll(programs, kind):
    """Period over the exact one, and the amplitude half a period after SWINGS over that at the start."""
    overlap = MASS * GRAVITY * math.cos(AMPLITUDE) / STIFFNESS
    arm = RADIUS - 0.5 * DIAMETER + overlap
    start = (arm * math.sin(AMPLITUDE), 0.0, -arm * math.cos(AMPLITUDE))
    output = ("variable x equal xcm(all,x)\nvariable z equal xcm(all,z)\n"
              "variable t equal step*dt\n"
              'fix out all print 5 "${t} ${x} ${z}" file out.txt screen no\n')
    steps = int((SWINGS + 0.6) * pendulum_period() / STEP)
    rows = run(programs, kind, "y", [start], output, steps)
    angles = [(t, math.atan2(x, -z)) for t, x, z in rows]
    crossings = [t + (u - t) * a / (a - b) for (t, a), (u, b) in zip(angles, angles[1:])
                 if a > 0 >= b]
    period = (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    last = max(abs(a) for t, a in angles if t > crossings[-1])
    return {"period": period / pendulum_period(), "amplitude": last / AMPLITUDE}


def loose_grains(seed):
    """Places on a lattice in the tube, shaken."""
    step, places, source = 1.25 * DIAMETER, [], random.Random(seed)
    z = -0.5 * LENGTH + step
    while len(places) < GRAINS:
        for i in range(-4, 5):
            for j in range(-4, 5):
                if math.hypot(i, j) * step < RADIUS - 0.8 * DIAMETER and len(places) < GRAINS:
                    places.append([c + source.uniform(-0.1, 0.1) * DIAMETER
                                   for c in (i * step, j * step, z)])
        z += step
    return places


def settle(programs, kind, seed):
    output = (f'fix out all print 10 "$(step) ${{fz}} $(c_energy)" file out.txt screen no\n')
    settling, watched = round(SETTLING / STEP), round(WATCHED / STEP)
    rows = run(programs, kind, "z", loose_grains(seed), output, settling + watched)
    late = [row for row in rows if row[0] > settling]
    weight = GRAINS * MASS * GRAVITY
    # on the wall, downwards
    force = [-row[1] / weight for row in late]
    energy = statistics.mean(row[2] for row in late)
    return {"carried": statistics.mean(force), "tremble": statistics.pstdev(force),
            "energy": energy / (GRAINS * MASS * GRAVITY * DIAMETER)}


NAMES = {"primitive": "stock primitive", 48: "stock mesh, 48", 192: "stock mesh, 192",
         768: "stock mesh, 768", "exact": "wall/sdf, exact", "sampled": "wall/sdf, sampled d/8"}
COLUMNS = {"period": "period of rolling, over exact", "amplitude": "amplitude left after 8 swings",
           "carried": "weight carried by the wall", "carried_spread": "its spread over seeds",
           "tremble": "trembling of that", "energy": "kinetic energy left / m g d"}


def measure(programs, seeds, jobs):
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        rolls = {kind: pool.submit(roll, programs, kind) for kind in NAMES}
        beds = {kind: [pool.submit(settle, programs, kind, seed) for seed in range(seeds)]
                for kind in NAMES}
        table = {}
        for kind in NAMES:
            found = [bed.result() for bed in beds[kind]]
            table[kind] = rolls[kind].result() | {
                name: statistics.mean(bed[name] for bed in found) for name in found[0]}
            table[kind]["carried_spread"] = statistics.stdev(bed["carried"] for bed in found)
    return table


def plot(path, table):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    shown = {"amplitude": "amplitude left after\n8 swings of a rolling grain",
             "carried": "share of a settled bed's\nweight that the tube carries",
             "energy": "kinetic energy left\nper grain / m g d"}
    figure, axes = pyplot.subplots(1, 3, figsize=(10, 2.9), constrained_layout=True, sharey=True)
    names = list(NAMES.values())
    colours = ["tab:gray" if name.startswith("stock") else "tab:blue" for name in names]
    for plane, (column, label) in zip(axes, shown.items()):
        values = [table[kind][column] for kind in NAMES]
        spread = [table[kind]["carried_spread"] for kind in NAMES] if column == "carried" else None
        bars = plane.barh(names, values, color=colours, xerr=spread, ecolor="black")
        if column == "energy":
            plane.set_xscale("log")
        if column == "amplitude":
            plane.bar_label(bars, fmt="%.2f", label_type="center", color="white")
        plane.set_xlabel(label)
    axes[0].invert_yaxis()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=3, help="beds per wall, at least 2")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument("--csv", type=pathlib.Path)
    parser.add_argument("--plot", type=pathlib.Path)
    given = parser.parse_args()
    programs = {"ours": str((given.build / "bin" / "gasgrain").resolve()),
                "stock": shutil.which("liggghts") or "liggghts"}
    table = measure(programs, given.seeds, given.jobs)
    print(f"{'':22}" + "".join(f"{name:>15}" for name in COLUMNS))
    for kind, row in table.items():
        print(f"{NAMES[kind]:22}" + "".join(f"{row[name]:15.4g}" for name in COLUMNS))
    print()
    for name, meaning in COLUMNS.items():
        print(f"{name:16}{meaning}")
    if given.csv:
        with open(given.csv, "w", newline="") as out:
            writer = csv.writer(out)
            writer.writerow(["wall", *COLUMNS])
            for kind, row in table.items():
                writer.writerow([NAMES[kind]] + [f"{row[name]:.6g}" for name in COLUMNS])
    if given.plot:
        plot(given.plot, table)


if __name__ == "__main__":
    main()
