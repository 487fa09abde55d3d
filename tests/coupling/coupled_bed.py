"""A small bed of coarse grains with gas: script, case file and results of coupled runs."""

import csv
import json
import math
import os
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "liggghts_plugins"))

from liggghts_run import Bench  # noqa: E402,F401

DIAMETER, RATIO, DENSITY = 5e-4, 5, 2500.0  # of the grains; l; kg/m^3
BOX = (0.0075, 0.005, 0.02)  # m
STEP = 1.2e-5  # s, an eighth of the contact time of 0.5 N/m
AREA = BOX[0] * BOX[1]

CASE = """
[grid]
lower = [0, 0, 0]
upper = [0.0075, 0.005, 0.02]
cells = [6, 4, 16]
[gas]
density = 1.0
viscosity = 1.8e-5
gravity = [0, 0, -9.81]
[boundary]
x_lower = {{type = "no-slip"}}
x_upper = {{type = "no-slip"}}
y_lower = {{type = "no-slip"}}
y_upper = {{type = "no-slip"}}
z_lower = {{type = {bottom}}}
z_upper = {{type = "outlet", pressure = 0}}
[[body]]
name = "floor"
acts_on = ["grains"]
plane = {{point = [0, 0, 0], normal = [0, 0, 1]}}
[[body]]
name = "left"
acts_on = ["grains"]
plane = {{point = [0, 0, 0], normal = [1, 0, 0]}}
[[body]]
name = "right"
acts_on = ["grains"]
plane = {{point = [0.0075, 0, 0], normal = [-1, 0, 0]}}
[[body]]
name = "front"
acts_on = ["grains"]
plane = {{point = [0, 0, 0], normal = [0, 1, 0]}}
[[body]]
name = "back"
acts_on = ["grains"]
plane = {{point = [0, 0.005, 0], normal = [0, -1, 0]}}
[[body]]
name = "tube"
cylinder = {{point = [0.0037, 0.0025, 0.0031], axis = [0, 1, 0], radius = 0.0012}}
[numerics]
pressure_tolerance = 1e-10
[coupling]
{coupling}
[output]
interval = {interval}
"""

INLET = '"inlet", superficial_velocity = 0.1'

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
fix floor all wall/sdf case case.toml body floor type 2
fix left all wall/sdf case case.toml body left type 2
fix right all wall/sdf case case.toml body right type 2
fix front all wall/sdf case case.toml body front type 2
fix back all wall/sdf case case.toml body back type 2
fix tube all wall/sdf case case.toml body tube type 2
fix gas all couple/gas case case.toml out out
thermo 1000
{runs}
"""


def case(bottom=INLET, coupling="", interval=0.01):
    return CASE.format(bottom=bottom, coupling=coupling, interval=interval)


def script(runs):
    return SCRIPT.format(ratio=RATIO, step=STEP, runs=runs)


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
