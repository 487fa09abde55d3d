"""A small bed for tests: rows of grains sliding over a floor, between side walls and over a tube."""

import random

from liggghts_run import Grain, cgm_properties, data_file, dump_command, preamble

RADIUS = 5e-4
LOWER, UPPER = [0, 0, 0], [0.012, 0.006, 0.016]
L = 5.0

CASE = """
[[body]]
name = "floor"
plane = {point = [0, 0, 0], normal = [0, 0, 1]}
[[body]]
name = "sides"
complement = {box = {lower = [0, 0, -1], upper = [0.012, 0.006, 1]}}
[[body]]
name = "tube"
cylinder = {point = [0.006, 0.003, 0.002], axis = [0, 1, 0], radius = 0.0008}
spacing = 1e-4
cut = true
lower = [0.003, -0.001, -0.001]
upper = [0.009, 0.007, 0.005]
"""

WALLS = "".join(f"fix {body} all wall/sdf case case.toml body {body} type 2\n"
                for body in ("floor", "sides", "tube"))


def grains(count_x=9, count_y=4, count_z=9):
    """Loosely stacked, with random velocities, all drifting along x so that they change ranks."""
    numbers = random.Random(4711)
    pitch = 2.3 * RADIUS
    made = []
    for k in range(count_z):
        for j in range(count_y):
            for i in range(count_x):
                place = [1.2 * RADIUS + n * pitch + numbers.uniform(-1, 1) * 0.1 * RADIUS
                         for n in (i, j, k)]
                if abs(place[0] - 0.006) < 0.0016 and abs(place[2] - 0.002) < 0.0016:
                    continue
                velocity = (0.3 + numbers.gauss(0, 0.05), numbers.gauss(0, 0.05),
                            -0.3 + numbers.gauss(0, 0.05))
                made.append(Grain(tuple(place), RADIUS, velocity,
                                  tuple(numbers.gauss(0, 50) for _ in range(3))))
    return made


FILES = {"case.toml": CASE, "grains.data": data_file(grains(), LOWER, UPPER, types=2)}

# k = 5 N/m: Tc = 1.14e-4 s for l = 5 with original radius 0.1 mm
STYLES = cgm_properties(2, k=5.0, e=0.8, mu=0.4) + """
pair_style gran model cgm tangential history
pair_coeff * *
timestep 4e-6
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
""" + WALLS

LOADS = """
thermo_style custom step atoms ke f_floor[1] f_floor[2] f_floor[3] f_floor[4] f_floor[5] f_floor[6] &
    f_floor[7] f_floor[8] f_sides[1] f_sides[7] f_tube[1] f_tube[3] f_tube[5] f_tube[7] f_tube[8]
thermo_modify format float %.17g norm no
thermo 500
"""


def start(processors="* * *"):
    return preamble("grains.data", skin=1e-4, l=L, commands=f"processors {processors}\n") + STYLES


def output(every):
    return LOADS + dump_command("d", every)
