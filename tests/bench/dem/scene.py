"""The scene of the grain benchmarks and the scripts of the programs that run it.

A box of 50 x 10 x 200 mm with or without the four tubes of examples/fluidized_bed_tubes, all
lengths times `scale`, filled with grains of 0.5 mm: at scale 1 the tubes are buried in 250 000
grains.
Contact law of every program: linear spring and dashpot with tangential history,
k = k_t = 6250 N/m, e = 0.9, mu = 0.3, steps of 1e-6 s (an eleventh of the contact time).
"""

import dataclasses
import math
import pathlib
import random
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from gas_case import body, plane  # noqa: E402
from mpi_environment import mpi_environment  # noqa: E402

DENSITY = 2500.0  # kg/m^3
K, E, MU, STEP = 6250.0, 0.9, 0.3, 1e-6  # N/m, -, -, s
YOUNG, POISSON = 5e6, 0.3  # Pa, - (hertz)
SIZE = 5e-4  # m
DIAMETER = {"A": 4.8e-4, "B": SIZE, "C": SIZE}  # m
SPEED = {"A": 0.1, "B": 0.1, "C": 0.0}  # m/s
GRAINS_AT_SCALE_ONE = 250_000

# Programs whose executable is not ours.
STOCK_EXECUTABLE = {"stock": "liggghts", "primitive": "liggghts", "lammps": "lmp"}
# Programs with stock's contact model; `unchanged` and `meshes` run in gasgrain.
MESH_TUBES = ("stock", "meshes")
STOCK_SCRIPT = (*MESH_TUBES, "primitive", "unchanged")
ENGINE = {"unchanged": "gasgrain_engine fused\n", "meshes": "gasgrain_engine fused\n",
          "cgm": "gasgrain_engine off\n",
          "fused": "gasgrain_engine fused\n",
          "mixed": "gasgrain_engine fused precision mixed\n"}


@dataclasses.dataclass(frozen=True)
class Scene:
    scale: float = 1.0
    with_tubes: bool = False
    copies: int = 1  # of the box, side by side along y

    @property
    def upper(self):  # m
        return [0.05 * self.scale, 0.01 * self.scale * self.copies, 0.2 * self.scale]

    def planes(self):
        for d in range(3):
            for place, sign in ((0.0, 1), (self.upper[d], -1)):
                yield f"{'xyz'[d]}{'lo' if sign > 0 else 'hi'}", d, place, sign

    def tubes(self):
        """x, z and radius of the tubes, which lie along y."""
        if self.with_tubes:
            for x, z in ((0.015, 0.02), (0.035, 0.02), (0.015, 0.04), (0.035, 0.04)):
                yield x * self.scale, z * self.scale, 0.005 * self.scale

    def files(self):
        """What the programs read besides their script and the grains."""
        surfaces = {f"tube{n}.stl": tube_surface(self, *tube)
                    for n, tube in enumerate(self.tubes())}
        return {"case.toml": self.case_file(), **surfaces}

    def bodies(self):
        return [name for name, *_ in self.planes()] + (["tubes"] if self.with_tubes else [])

    def case_file(self):
        text = ""
        for name, d, place, sign in self.planes():
            point, normal = [0.0] * 3, [0] * 3
            point[d], normal[d] = place, sign
            text += body(name, plane(point, normal))
        if self.with_tubes:
            members = "".join(f"  {{cylinder = {{point = [{x}, 0, {z}], axis = [0, 1, 0], "
                              f"radius = {radius}}}}},\n" for x, z, radius in self.tubes())
            text += f'[[body]]\nname = "tubes"\nunion = [\n{members}]\n'
        return text


def tube_surface(scene, x, z, radius, facets=48):
    """STL of a tube through the whole depth."""
    ends = (-1e-4, scene.upper[1] + 1e-4)
    corner = [(x + radius * math.cos(2 * math.pi * n / facets),
               z + radius * math.sin(2 * math.pi * n / facets)) for n in range(facets + 1)]
    text = "solid tube\n"
    for (xa, za), (xb, zb) in zip(corner, corner[1:]):
        quad = [(xa, ends[0], za), (xb, ends[0], zb), (xb, ends[1], zb), (xa, ends[1], za)]
        for places in ((0, 1, 2), (0, 2, 3)):
            text += "facet normal 0 0 0\n outer loop\n"
            text += "".join("  vertex {:.12g} {:.12g} {:.12g}\n".format(*quad[n]) for n in places)
            text += " endloop\nendfacet\n"
    return text + "endsolid tube\n"


def data_file(scene, bed, state):
    """Grains of a settled bed as `read_data` of LIGGGHTS and LAMMPS takes them."""
    numbers = random.Random(7)
    diameter, speed = DIAMETER[state], SPEED[state] / math.sqrt(3)
    # masses of state A are those of 0.5 mm grains
    density = DENSITY * (SIZE / diameter) ** 3
    depth = scene.upper[1] / scene.copies
    places = [(x, y + copy * depth, z) for copy in range(scene.copies) for x, y, z in bed]
    lines = ["grains", "", f"{len(places)} atoms", "2 atom types"]
    lines += [f"{-1e-3} {scene.upper[d] + 1e-3} {'xyz'[d]}lo {'xyz'[d]}hi" for d in range(3)]
    lines += ["", "Atoms", ""]
    lines += [f"{i} 1 {diameter} {density:.17g} {x} {y} {z}"
              for i, (x, y, z) in enumerate(places, 1)]
    lines += ["", "Velocities", ""]
    for i in range(1, len(places) + 1):
        v = " ".join(f"{numbers.gauss(0, 1) * speed:.9g}" for _ in range(3))
        lines.append(f"{i} {v} 0 0 0")
    return "\n".join(lines) + "\n"


def damping(mass):
    return -2 * math.log(E) * math.sqrt(mass * K / (math.pi**2 + math.log(E) ** 2))


MASS = DENSITY * math.pi / 6 * SIZE**3  # kg, in every state
DAMPING, DAMPING_AT_WALL = damping(MASS / 2), damping(MASS)


def property_global(name, pair, wall):
    return f"fix {name} all property/global {name} peratomtypepair 2 {pair} {wall} {wall} {wall}\n"


def cgm_styles(scene, spring=K, restitution=E):
    """Our contact law and SDF walls."""
    text = property_global("cgmSpringConstant", spring, spring)
    text += property_global("coefficientRestitution", restitution, restitution)
    text += property_global("coefficientFriction", MU, MU)
    text += "pair_style gran model cgm tangential history\npair_coeff * *\n"
    return text + "".join(f"fix {name} all wall/sdf case case.toml body {name} type 2\n"
                          for name in scene.bodies())


def stock_styles(scene, model, mesh_tubes):
    """Stock models and walls; `model` is hooke/stiffness or hertz."""
    if model == "hertz":
        options = ""
        text = (f"fix Y all property/global youngsModulus peratomtype {YOUNG} {YOUNG}\n"
                f"fix nu all property/global poissonsRatio peratomtype {POISSON} {POISSON}\n")
        text += property_global("coefficientRestitution", E, E)
    else:
        options = "absolute_damping on tangential_damping on limitForce off"
        text = property_global("kn", K, K) + property_global("kt", K, K)
        text += property_global("gamman_abs", DAMPING, DAMPING_AT_WALL)
        text += property_global("gammat_abs", DAMPING, DAMPING_AT_WALL)
    text += property_global("coefficientFriction", MU, MU)
    text += f"pair_style gran model {model} tangential history {options}\npair_coeff * *\n"
    wall = f"all wall/gran model {model} tangential history"
    for name, d, place, _ in scene.planes():
        text += f"fix {name} {wall} primitive type 2 {'xyz'[d]}plane {place} {options}\n"
    tubes = list(scene.tubes())
    for n, (x, z, radius) in enumerate(tubes):
        if mesh_tubes:
            text += f"fix mesh{n} all mesh/surface file tube{n}.stl type 2\n"
        else:  # a ycylinder's axis is given by z, then x
            text += (f"fix tube{n} {wall} primitive type 2 ycylinder {radius} {z} {x} "
                     f"{options}\n")
    if tubes and mesh_tubes:
        meshes = " ".join(f"mesh{n}" for n in range(len(tubes)))
        text += f"fix tubes {wall} mesh n_meshes {len(tubes)} meshes {meshes} {options}\n"
    return text


def lammps_styles(scene):
    """gran/hooke/history, whose dashpots are per mass."""
    pair = f"{K} {K} {2 * DAMPING / MASS} {2 * DAMPING / MASS} {MU} 1"
    wall = (f"hooke/history {K} {K} {DAMPING_AT_WALL / MASS} {DAMPING_AT_WALL / MASS} {MU} 1")
    text = f"pair_style gran/hooke/history {pair}\npair_coeff * *\n"
    for d in range(3):
        text += f"fix w{'xyz'[d]} all wall/gran {wall} {'xyz'[d]}plane 0 {scene.upper[d]}\n"
    tubes = list(scene.tubes())
    for n, (x, z, radius) in enumerate(tubes):
        text += f"region tube{n} cylinder y {x} {z} {radius} INF INF side out\n"
    if tubes:
        names = " ".join(f"tube{n}" for n in range(len(tubes)))
        text += f"region tubes intersect {len(tubes)} {names}\n"
        text += f"fix tubes all wall/gran/region {wall} region tubes\n"
    return text


def styles(program, scene, stock_model):
    if program == "lammps":
        return lammps_styles(scene)
    if program in STOCK_SCRIPT:
        return stock_styles(scene, stock_model, program in MESH_TUBES)
    return cgm_styles(scene)


def head(program, skin, ranks=1):
    """Units, box and grains."""
    lammps = program == "lammps"
    modify = "every 1 check yes" if lammps else "contact_distance_factor 1.01"
    return f"""{ENGINE.get(program, '')}units si
atom_style {'sphere' if lammps else 'granular'}
atom_modify map array
boundary f f f
newton off
{'comm_modify vel yes' if lammps else 'communicate single vel yes'}
processors {ranks} 1 1
read_data grains.data
neighbor {skin} bin
neigh_modify delay 0 {modify}
"""


TAIL = """fix gravity all gravity 9.81 vector 0 0 -1
{more}fix integrate all nve/sphere
thermo_style custom step atoms ke
thermo 100000
thermo_modify norm no lost error
run {warm_up}
run {steps}
"""


def script(program, scene, given, more=""):
    """`given`: steps, skin, ranks, stock_model."""
    return (head(program, given.skin, given.ranks) + styles(program, scene, given.stock_model) +
            f"timestep {STEP}\n" +
            TAIL.format(more=more, warm_up=max(given.steps // 5, 50), steps=given.steps))


@dataclasses.dataclass(frozen=True)
class Measured:
    seconds: float  # of the last `run`
    bytes: int  # largest resident size of a process
    text: str


# A process starts with the largest size of the one that started it: ours holds the bed, this one
# nothing.
LAUNCHER = """
import resource, subprocess, sys
code = subprocess.call(sys.argv[1:])
print("largest process:", resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, "KiB")
sys.exit(code)
"""


def run(command, directory, script_text):
    (directory / "in.script").write_text(script_text)
    done = subprocess.run([sys.executable, "-c", LAUNCHER, *command, "-in", "in.script", "-log",
                           "none"], cwd=directory, env=mpi_environment(), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    text = done.stdout
    times = re.findall(r"Loop time of (\S+) on", text)
    if done.returncode != 0 or not times:
        raise SystemExit(f"{command} failed:\n{text[-3000:]}")
    largest = int(re.findall(r"largest process: (\d+) KiB", text)[-1])
    return Measured(float(times[-1]), 1024 * largest, text)


def mpi(ranks):
    return ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
