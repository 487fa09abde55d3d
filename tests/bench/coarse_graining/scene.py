"""A scene of the benchmark: its LIGGGHTS script for any law, l and seed."""

import dataclasses
import math
import pathlib
import sys
import typing

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

import gas_case  # noqa: E402
from laws import LAWS, Material  # noqa: E402

SEEDS = (15485863, 32452843, 49979687, 67867967, 86028121, 104395301, 122949823)


@dataclasses.dataclass(frozen=True)
class Wall:
    """One wall, for our law as a body of the case file, for stock laws as primitive or mesh."""
    name: str
    body: str  # the shape's line of [[body]]
    stock: str  # what follows the model in fix wall/gran: `primitive type 2 xplane 0.0`, ...
    mesh: str = ""  # `fix mesh/surface` command before it
    gate: bool = False  # taken away when the measured time begins
    acts_on: str = "grains"  # or gas; empty: both


def plane(name, axis, place, sign, gate=False):
    """A plane across `axis` (0, 1, 2) whose free side is that of `sign`."""
    point, normal = [0.0] * 3, [0] * 3
    point[axis], normal[axis] = place, sign
    return Wall(name, gas_case.plane(point, normal),
                f"primitive type 2 {'xyz'[axis]}plane {place}", gate=gate)


@dataclasses.dataclass(frozen=True)
class Gas:
    """Air in the box of a scene, no-slip at its left and right, open above."""
    floor: str  # condition
    depth: str  # condition in front and back
    series_interval: float  # s


@dataclasses.dataclass(frozen=True)
class Case:
    """One run; the factors override what the scene says."""
    scene: str
    law: str
    l: float = 1
    seed: int = 1
    factor: str = ""  # which one is changed: see FACTORS
    value: str = ""

    @property
    def key(self):
        return (self.law, f"{self.l:g}", str(self.seed), self.factor, self.value)


# name: what it does
FACTORS = {
    "step": "contact time over time step (default 10)",
    "spring": "spring constant of the original particle, N/m",
    "interval": "coupling interval, s",
    "cell": "edge of a gas cell, m",
    "kernel": "kernel width, m",
    "spacing": "spacing of a sampled wall over the grain radius",
}


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    title: str
    size: str  # what is narrow in it, in diameters of the original
    material: Material
    count: int  # originals
    lower: tuple  # of the box, m
    upper: tuple
    boundary: str
    region: str  # LIGGGHTS region in which the grains are inserted
    walls: tuple
    settle: float  # s before the gate opens or the gas is switched on
    time: float  # s that are measured
    frame: float  # s between frames
    measure: typing.Callable  # (frames, scene, case, directory) -> {quantity: value}
    quantities: dict  # name -> (unit, "relative" or "absolute": how deviations count)
    gas: Gas | None = None
    cell: float = 0.0  # m
    sampled_wall: str = ""  # of the factor `spacing`
    margin: float = 0.0  # of the box beyond lower and upper, m
    loses_grains: bool = False  # they fall out of the box
    note: str = ""  # of the page, below the originals

    def spring_material(self, case):
        if case.factor != "spring":
            return self.material
        return dataclasses.replace(self.material, spring=float(case.value))

    def step(self, case):
        """s; whole steps fit into a frame."""
        share = float(case.value) if case.factor == "step" else 10.0
        largest = LAWS[case.law].contact_time(self.spring_material(case), case.l) / share
        return self.frame / math.ceil(self.frame / largest)

    def grains(self, case):
        return round(self.count / case.l**3)

    def wall_lines(self, law):
        for wall in self.walls:
            if law.stock:
                if wall.mesh:
                    yield wall.mesh
                if wall.stock:  # else part of another wall's mesh
                    yield f"fix {wall.name} all wall/gran model {law.model(wall.stock)}"
            else:
                yield f"fix {wall.name} all wall/sdf case case.toml body {wall.name} type 2"

    def script(self, case):
        law, material, dt = LAWS[case.law], self.spring_material(case), self.step(case)
        per_frame = round(self.frame / dt)
        box = " ".join(f"{a - self.margin:g} {b + self.margin:g}"
                       for a, b in zip(self.lower, self.upper))
        seeds = SEEDS[case.seed - 1:case.seed + 2]
        gates = "\n".join(f"unfix {wall.name}" for wall in self.walls if wall.gate)
        gas = "fix gas all couple/gas case case.toml out .\n" if self.gas else ""
        return f"""gasgrain_engine {"off" if law.stock else "fused"}
units si
atom_style granular
atom_modify map array
boundary {self.boundary}
newton off
communicate single vel yes
soft_particles yes
region box block {box} units box
create_box 2 box
coarsegraining {case.l:g} model_check warn
neighbor {0.4 * material.diameter:g} bin
neigh_modify delay 0 contact_distance_factor 1.01
{chr(10).join(law.properties(material, case.l))}
pair_style gran model {law.model()}
pair_coeff * *
timestep {dt:.12g}
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
{chr(10).join(self.wall_lines(law))}
{self.region}
fix original all particletemplate/sphere {seeds[0]} atom_type 1 density constant {material.density:g} radius constant {material.diameter / 2:g}
fix mixture all particledistribution/discrete {seeds[1]} 1 original 1.0
fix insert all insert/pack seed {seeds[2]} distributiontemplate mixture insert_every once overlapcheck yes all_in yes particles_in_region {self.grains(case)} region fill
thermo_style custom step atoms ke
thermo_modify norm no lost ignore
thermo 100000000
run {round(self.settle / self.frame) * per_frame}
unfix insert
{gates}
{gas}dump frames all custom {per_frame} frames.dump id x y z vx vy vz
dump_modify frames first yes
run {round(self.time / self.frame) * per_frame}
"""

    def case_file(self, case):
        """Bodies, and the gas where there is one."""
        text = ""
        for wall in self.walls:
            text += gas_case.body(wall.name, wall.body, wall.acts_on)
            if case.factor == "spacing" and wall.name == self.sampled_wall:
                spacing = float(case.value) * case.l * self.material.diameter / 2
                margin = 8 * spacing
                lower = [a - margin for a in self.lower]
                upper = [b + margin for b in self.upper]
                # wider than a grain's radius and than two cells of the gas
                band = max(8 * spacing, 0.75 * case.l * self.material.diameter, 2.5 * self.cell)
                text += f"spacing = {spacing:g}\nlower = {lower}\nupper = {upper}\ncut = true\n"
                text += f"band = {band:g}\n"
        if not self.gas:
            return text
        cell = float(case.value) if case.factor == "cell" else self.cell
        cells = [max(1, round((b - a) / cell)) for a, b in zip(self.lower, self.upper)]
        coupling = {"interval": "exchange_interval", "kernel": "kernel_width"}.get(case.factor)
        line = f"{coupling} = {case.value}\n" if coupling else ""
        return (text + gas_case.gas_case(self.upper, cells, lower=self.lower, x="no-slip",
                                         y=self.gas.depth, below=self.gas.floor,
                                         gravity=(0, 0, -9.81))
                + "[numerics]\npressure_tolerance = 1e-5\n"
                f"[coupling]\nseries_interval = {self.gas.series_interval:g}\n{line}"
                "[output]\ninterval = 1.0\n")
