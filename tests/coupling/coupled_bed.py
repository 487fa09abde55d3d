"""A small bed of coarse grains with gas: script, case file and results of coupled runs."""

import csv
import json
import math
import os
import pathlib
import random
import sys

TESTS = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(TESTS), str(TESTS / "liggghts_plugins")]

from gas_case import body, changed, gas_case, inlet, plane  # noqa: E402,F401
from liggghts_run import Bench  # noqa: E402,F401

DIAMETER, RATIO, DENSITY = 5e-4, 5, 2500.0  # of the grains; l; kg/m^3
BOX = (0.0075, 0.005, 0.02)  # m
STEP = 1.2e-5  # s, an eighth of the contact time of 0.5 N/m
AREA = BOX[0] * BOX[1]

WALLS = {"floor": plane((0, 0, 0), (0, 0, 1)), "left": plane((0, 0, 0), (1, 0, 0)),
         "right": plane((BOX[0], 0, 0), (-1, 0, 0)), "front": plane((0, 0, 0), (0, 1, 0)),
         "back": plane((0, BOX[1], 0), (0, -1, 0))}

SCRIPT = """
units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
processors * * 1
coarsegraining {ratio}
read_data grains.data
neighbor 0.0001 bin
neigh_modify delay 0
fix k all property/global cgmSpringConstant peratomtypepair 2 0.5 0.5 0.5 0.5
fix e all property/global coefficientRestitution peratomtypepair 2 0.9 0.9 0.9 0.9
fix mu all property/global coefficientFriction peratomtypepair 2 0.3 0.3 0.3 0.3
pair_style gran model cgm tangential history
pair_coeff * *
timestep {step}
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
{walls}
fix gas all couple/gas case case.toml out out
thermo 1000
{runs}
"""


def case(bottom=inlet(0.1), coupling="", interval=0.01):
    tube = "cylinder = {point = [0.0037, 0.0025, 0.0031], axis = [0, 1, 0], radius = 0.0012}"
    return (gas_case(BOX, (6, 4, 16), x="no-slip", y="no-slip", below=bottom, density=1.0,
                     gravity=(0, 0, -9.81))
            + "".join(body(name, shape, acts_on="grains") for name, shape in WALLS.items())
            + body("tube", tube)
            + f"[numerics]\npressure_tolerance = 1e-10\n[coupling]\n{coupling}\n"
            f"[output]\ninterval = {interval}\n")


def script(runs):
    walls = "\n".join(f"fix {name} all wall/sdf case case.toml body {name} type 2"
                      for name in (*WALLS, "tube"))
    return SCRIPT.format(ratio=RATIO, step=STEP, walls=walls, runs=runs)


def positions():
    """A jittered lattice around the tube, 8 mm high."""
    noise = random.Random(3)
    spacing = 1.04 * DIAMETER
    places = []
    counts = [int(length / spacing) for length in (BOX[0], BOX[1], 0.008)]
    for k in range(counts[2]):
        for j in range(counts[1]):
            for i in range(counts[0]):
                x, y, z = ((n + 0.52) * spacing + 0.01 * DIAMETER * noise.uniform(-1, 1)
                           for n in (i, j, k))
                if math.hypot(x - 0.0037, z - 0.0031) > 0.0012 + 0.5 * DIAMETER:
                    places.append((x, y, z))
    return places


def grains_data():
    places = positions()
    lines = ["grains", "", f"{len(places)} atoms", "2 atom types", "",
             f"0 {BOX[0]} xlo xhi", f"0 {BOX[1]} ylo yhi", f"0 {BOX[2]} zlo zhi", "", "Atoms", ""]
    lines += [f"{n} 1 {DIAMETER} {DENSITY} {x:.9g} {y:.9g} {z:.9g}"
              for n, (x, y, z) in enumerate(places, start=1)]
    return "\n".join(lines) + "\n"


def weight():
    return len(positions()) * DENSITY * math.pi / 6 * DIAMETER**3 * 9.81


def bench(case_text):
    return Bench({"case.toml": case_text, "grains.data": grains_data()})


def series(directory):
    with open(directory / "out" / "timeseries.csv") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def summary(directory):
    with open(directory / "out" / "summary.json") as file:
        return json.load(file)


def quantities(directory):
    return {quantity["name"]: quantity["value"] for quantity in summary(directory)["quantities"]}


def ranks_to_test():
    return [int(n) for n in os.environ.get("GASGRAIN_TEST_RANKS", "1 2 3 4").split()]
