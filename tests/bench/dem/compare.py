#!/usr/bin/env python3
"""Cost of a grain-step: stock LIGGGHTS, the same script in the fused engine, our contact law in
LIGGGHTS's loop, and our law with SDF walls in the fused engine.

    tests/bench/dem/compare.py BUILD_DIRECTORY BED.csv[.gz] [--copies 6] [--ranks 1] ...

BED: columns x,y,z of a settled bed of 0.5 mm grains in a box of 50 x 10 x 200 mm; `--copies` sets
copies of it side by side along y. States, as in docs/performance.md:
    A  grains of 0.48 mm with random velocities of 0.1 m/s: almost collisional
    B  settled, with random velocities of 0.1 m/s
    C  settled
Programs: stock (liggghts), unchanged (gasgrain with the script of stock), cgm (our law and SDF walls,
engine off), fused (the same, fused). All run the same script apart from contact model and walls, one
after the other in every repetition; the table gives medians of wall nanoseconds per grain and step.
"""

import argparse
import csv
import gzip
import math
import os
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import tempfile

BOX = [0.05, 0.01, 0.2]  # m
DENSITY = 2500.0  # kg/m^3
K, E, MU, STEP = 6250.0, 0.9, 0.3, 1e-6  # N/m, -, -, s
YOUNG, POISSON = 5e6, 0.3  # Pa, - (hertz)
STOCK_SCRIPT = ("stock", "unchanged")
DIAMETER = {"A": 4.8e-4, "B": 5e-4, "C": 5e-4}  # m
SPEED = {"A": 0.1, "B": 0.1, "C": 0.0}  # m/s


def read_bed(path):
    opener = gzip.open if path.suffix == ".gz" else open
    with opener(path, "rt") as file:
        return [[float(row[d]) for d in "xyz"] for row in csv.DictReader(file)]


def data_file(bed, copies, state):
    numbers = random.Random(7)
    diameter, speed = DIAMETER[state], SPEED[state] / math.sqrt(3)
    # masses of state A are those of 0.5 mm grains
    density = DENSITY * (5e-4 / diameter) ** 3
    places = [(x, y + copy * BOX[1], z) for copy in range(copies) for x, y, z in bed]
    upper = [BOX[0], copies * BOX[1], BOX[2]]
    lines = ["grains", "", f"{len(places)} atoms", "2 atom types"]
    lines += [f"{-1e-3} {upper[d] + 1e-3} {'xyz'[d]}lo {'xyz'[d]}hi" for d in range(3)]
    lines += ["", "Atoms", ""]
    lines += [f"{i} 1 {diameter} {density:.17g} {x} {y} {z}"
              for i, (x, y, z) in enumerate(places, 1)]
    lines += ["", "Velocities", ""]
    for i in range(1, len(places) + 1):
        v = " ".join(f"{numbers.gauss(0, 1) * speed:.9g}" for _ in range(3))
        lines.append(f"{i} {v} 0 0 0")
    return "\n".join(lines) + "\n"


def planes(copies):
    upper = [BOX[0], copies * BOX[1], BOX[2]]
    for d in range(3):
        for place, sign in ((0.0, 1), (upper[d], -1)):
            yield f"{'xyz'[d]}{'lo' if sign > 0 else 'hi'}", d, place, sign


def case_file(copies):
    text = ""
    for name, d, place, sign in planes(copies):
        point, normal = [0.0] * 3, [0] * 3
        point[d], normal[d] = place, sign
        text += f'[[body]]\nname = "{name}"\nplane = {{point = {point}, normal = {normal}}}\n'
    return text


def damping(mass):
    return -2 * math.log(E) * math.sqrt(mass * K / (math.pi**2 + math.log(E) ** 2))


def property_global(name, pair, wall):
    return f"fix {name} all property/global {name} peratomtypepair 2 {pair} {wall} {wall} {wall}\n"


def contact_styles(program, copies, stock_model):
    mass = DENSITY * math.pi / 6 * 5e-4**3
    if program in STOCK_SCRIPT and stock_model == "hertz":
        text = (f"fix Y all property/global youngsModulus peratomtype {YOUNG} {YOUNG}\n"
                f"fix nu all property/global poissonsRatio peratomtype {POISSON} {POISSON}\n")
        text += property_global("coefficientRestitution", E, E)
        model = "hertz tangential history {walls}"
    elif program in STOCK_SCRIPT:
        eta, eta_wall = damping(mass / 2), damping(mass)
        text = property_global("kn", K, K) + property_global("kt", K, K)
        text += property_global("gamman_abs", eta, eta_wall)
        text += property_global("gammat_abs", eta, eta_wall)
        model = ("hooke/stiffness tangential history {walls} absolute_damping on "
                 "tangential_damping on limitForce off")
    else:
        text = property_global("cgmSpringConstant", K, K)
        text += property_global("coefficientRestitution", E, E)
        model = "cgm tangential history {walls}"
    text += property_global("coefficientFriction", MU, MU)
    text += f"pair_style gran model {model.format(walls='')}\npair_coeff * *\n"
    for name, d, place, _ in planes(copies):
        if program in STOCK_SCRIPT:
            wall = model.format(walls=f"primitive type 2 {'xyz'[d]}plane {place}")
            text += f"fix {name} all wall/gran model {wall}\n"
        else:
            text += f"fix {name} all wall/sdf case case.toml body {name} type 2\n"
    return text


def script(program, given):
    engine = {"stock": "", "unchanged": "gasgrain_engine fused\n", "cgm": "gasgrain_engine off\n",
              "fused": "gasgrain_engine fused\n"}
    return f"""{engine[program]}units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
processors {given.ranks} 1 1
read_data grains.data
neighbor {given.skin} bin
neigh_modify delay 0 contact_distance_factor 1.01
{contact_styles(program, given.copies, given.stock_model)}timestep {STEP}
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
thermo_style custom step atoms ke
thermo 100000
thermo_modify norm no lost error
run {max(given.steps // 5, 50)}
run {given.steps}
"""


def seconds(command, directory, script_text):
    (directory / "in.script").write_text(script_text)
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1",
                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMPI_MCA_hwloc_base_binding_policy": "none", "OMP_NUM_THREADS": "1"}
    done = subprocess.run([*command, "-in", "in.script", "-log", "none"], cwd=directory,
                          env=environment, stdin=subprocess.DEVNULL, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    times = re.findall(r"Loop time of (\S+) on", done.stdout)
    if done.returncode != 0 or len(times) != 2:
        raise SystemExit(f"{command} failed:\n{done.stdout[-3000:]}")
    return float(times[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("bed", type=pathlib.Path)
    parser.add_argument("--copies", type=int, default=1)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--skin", type=float, default=5e-5)
    parser.add_argument("--states", default="ABC")
    parser.add_argument("--programs", default="stock,unchanged,cgm,fused")
    parser.add_argument("--stock-model", choices=("hooke/stiffness", "hertz"),
                        default="hooke/stiffness")
    given = parser.parse_args()
    programs = given.programs.split(",")
    gasgrain = str((given.build / "bin" / "gasgrain").resolve())
    executable = {program: gasgrain for program in programs}
    executable["stock"] = shutil.which("liggghts") or "liggghts"
    start = ["mpirun", "--oversubscribe", "-n", str(given.ranks)] if given.ranks > 1 else []
    bed = read_bed(given.bed)
    grains = given.copies * len(bed)
    print(f"{grains} grains, {given.ranks} rank(s), {given.steps} steps, ns per grain-step")
    print("state " + "".join(f"{program:>10}" for program in programs) + "   against stock")
    for state in given.states:
        with tempfile.TemporaryDirectory(prefix="gasgrain-bench-") as name:
            directory = pathlib.Path(name)
            (directory / "grains.data").write_text(data_file(bed, given.copies, state))
            (directory / "case.toml").write_text(case_file(given.copies))
            samples = {program: [] for program in programs}
            for _ in range(given.repeats):
                for program in programs:
                    text = script(program, given)
                    time = seconds([*start, executable[program]], directory, text)
                    samples[program].append(time * 1e9 / (grains * given.steps))
        cost = {program: statistics.median(values) for program, values in samples.items()}
        ratio = f"{cost[programs[0]] / cost[programs[-1]]:8.2f}"
        print(f"{state:5} " + "".join(f"{cost[p]:10.1f}" for p in programs) + ratio, flush=True)


if __name__ == "__main__":
    main()
