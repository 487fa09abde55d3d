"""Settled beds for the benchmarks: made once with gasgrain, then kept as a file.

Grains fall from a lattice with random velocities and e = 0.3 on springs of a 25th of the stiffness,
in steps five times as long; then the bed relaxes with the benchmark's own stiffness, stopped again
and again: without that it keeps half of the contacts of a bed at rest.
"""

import csv
import gzip
import math
import pathlib
import random
import re
import tempfile

import scene as scenes

SOFT, FALL = 25.0, 0.09  # -, s
QUENCH, QUENCHES = 3e-4, 20  # s: time in which sound passes a bed of some cm; number of them
RESTITUTION = 0.3


def read_bed(path):
    opener = gzip.open if path.suffix == ".gz" else open
    with opener(path, "rt") as file:
        return [[float(row[d]) for d in "xyz"] for row in csv.DictReader(file)]


def write_bed(path, places):
    path.parent.mkdir(parents=True, exist_ok=True)
    with gzip.open(path, "wt", newline="") as file:
        csv.writer(file).writerows([["x", "y", "z"], *places])


def lattice(scene, count):
    """The lowest `count` places of a cubic lattice that are free of walls and tubes."""
    pitch = 1.02 * scenes.SIZE
    number = [int((length - 0.02 * scenes.SIZE) / pitch) for length in scene.upper]
    spacing = [length / n for length, n in zip(scene.upper, number)]
    places = []
    for k in range(number[2]):
        z = (k + 0.5) * spacing[2]
        for i in range(number[0]):
            x = (i + 0.5) * spacing[0]
            if any(math.hypot(x - a, z - b) < radius + 0.51 * scenes.SIZE
                   for a, b, radius in scene.tubes()):
                continue
            places += [(x, (j + 0.5) * spacing[1], z) for j in range(number[1])]
        if len(places) >= count:
            return places[:count]
    raise SystemExit(f"{count} grains do not fit into the box")


def data_file(scene, count):
    numbers = random.Random(11)
    lines = scenes.data_file(scene, lattice(scene, count), "C").split("\n")
    first = lines.index("Velocities") + 2
    for n in range(first, first + count):
        v = " ".join(f"{numbers.gauss(0, 0.05):.4f}" for _ in range(3))
        lines[n] = f"{lines[n].split()[0]} {v} 0 0 0"
    return "\n".join(lines)


def script(scene, ranks):
    soft_step = scenes.STEP * math.sqrt(SOFT)
    stop = "velocity all set 0. 0. 0. units box\n"
    stiff = scenes.property_global("cgmSpringConstant", scenes.K, scenes.K)
    return (scenes.head("fused", 0.15 * scenes.SIZE, ranks) +
            scenes.cgm_styles(scene, scenes.K / SOFT, RESTITUTION) + f"timestep {soft_step}\n"
            "fix gravity all gravity 9.81 vector 0 0 -1\nfix integrate all nve/sphere\n"
            "thermo_style custom step atoms ke\nthermo 2000\nthermo_modify norm no lost error\n"
            f"run {round(FALL / soft_step)}\nunfix cgmSpringConstant\n{stiff}"
            f"timestep {scenes.STEP}\n" + QUENCHES * f"{stop}run {round(QUENCH / scenes.STEP)}\n" +
            "compute contacts all contact/atom\ncompute mean all reduce ave c_contacts\n"
            "thermo_style custom step atoms ke c_mean\nthermo_modify norm no\nrun 0\n"
            "dump bed all custom 1 bed.dump id x y z\n"
            "dump_modify bed format \"%d %.9g %.9g %.9g\"\nrun 0\n")


def settled(scene, count, gasgrain, ranks, path):
    """Places of a settled bed of `count` grains, from the file if it exists."""
    path = pathlib.Path(path)
    if path.exists():
        return read_bed(path)
    print(f"settling {count} grains on {ranks} rank(s), once: {path}", flush=True)
    with tempfile.TemporaryDirectory(prefix="gasgrain-bench-") as name:
        directory = pathlib.Path(name)
        (directory / "grains.data").write_text(data_file(scene, count))
        (directory / "case.toml").write_text(scene.case_file())
        done = scenes.run([*scenes.mpi(ranks), gasgrain], directory, script(scene, ranks))
        dump = (directory / "bed.dump").read_text().split("ITEM: ATOMS")[1].splitlines()[1:]
        rows = sorted((int(row[0]), row[1:4]) for row in map(str.split, dump))
        write_bed(path, [place for _, place in rows])
    _, number, energy, contacts = re.findall(r"^ *Step .* mean *\n(.*)$", done.text,
                                               re.MULTILINE)[-1].split()
    energy_each = float(energy) / float(number)
    print(f"{contacts} contacts per grain, kinetic energy {energy_each:.2g} J each", flush=True)
    return read_bed(path)
