"""Scenes of the stability map: scripts, case files and the laws that they are held against.

plug  a face-centred cubic lattice that moves as one (`fix aveforce`), floating in the upward flow
      that carries it: held at rest until the flow is steady (pressure drop), then pushed (the
      push must decay). No contacts damp it.
bed   a packing on a floor, below minimum fluidization: pressure drop, and grains that stay at rest.
jet   the same grains under a jet through the floor: finishes, balances close, and the grains never
      have more energy than they had at the speed of the jet.

The gas has no weight: its density is a matter of inertia and drag here, not of buoyancy.
"""

import dataclasses
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from gas_case import body, gas_case, inlet, plane  # noqa: E402

VISCOSITY = 1.8e-5  # Pa s
GRAIN_DENSITY = 2500.0  # kg/m^3
RESTITUTION = 0.5
PUSHED, RESTING = 24, 48  # exchanges
MOST_GAS_STEPS = 200  # of an exchange


def drag(void, slip, diameter, gas_density):
    """beta / (1 - eps), kg/(m^3 s): Ergun up to eps = 0.8, Wen and Yu above."""
    if void <= 0.8:
        return (150 * (1 - void) * VISCOSITY / (void * diameter**2)
                + 1.75 * gas_density * slip / diameter)
    reynolds = void * gas_density * slip * diameter / VISCOSITY
    multiple = 0.44 * reynolds / 24 if reynolds >= 1000 else 1 + 0.15 * reynolds**0.687
    return 18 * VISCOSITY / diameter**2 * multiple * void**-2.65


def pressure_gradient(void, velocity, diameter, gas_density):
    """-dp/dz, Pa/m, at a superficial velocity through grains at rest."""
    return (drag(void, velocity / void, diameter, gas_density) * (1 - void) / void
            * velocity / void)


def minimum_fluidization(void, diameter, gas_density):
    """Superficial velocity, m/s, at which the drag carries a bed."""
    low, high = 0.0, 100.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        carried = pressure_gradient(void, middle, diameter, gas_density)
        low, high = ((middle, high) if carried < 9.81 * (1 - void) * GRAIN_DENSITY
                     else (low, middle))
    return low


def cells_along(length, edge):
    """Cells of about `edge`; below three a single one."""
    count = round(length / edge)
    return count if count >= 3 else 1


@dataclasses.dataclass(frozen=True)
class Layout:
    """Of a point: lengths in m."""
    wide: float
    deep: float
    high: float
    cells: tuple
    lattice: float  # constant of the lattice
    count: tuple  # its cells per direction
    floor: float  # lowest plane of the lattice

    @property
    def thickness(self):
        """Of a layer of cells."""
        return self.high / self.cells[2]


def layout(point):
    d, edge = point.diameter * point.l, point.cell * point.diameter * point.l
    kernel = max(0.8 * edge, 1.2 * d)
    # beds are dropped from a loose lattice, plugs keep theirs
    void = point.void if point.scene == "plug" else 0.5
    lattice = d * (4 * math.pi / 6 / (1 - void)) ** (1 / 3)
    across = max(1, round((12 if point.scene == "jet" else 5) * d / lattice))
    deep = max(1, round(4 * d / lattice)) if point.scene == "jet" else across
    if point.scene != "jet" and point.void > 0.8:
        across = deep = 2 if point.void <= 0.9 else 1
    thick = {"plug": max(18 * d, 11 * edge, 4 * lattice), "bed": max(20 * d, 15 * edge), "jet": 6 * d}
    up = max(2, math.ceil(thick[point.scene] / lattice))
    bed = up * lattice
    below = 5 * kernel if point.scene == "plug" else 0.0
    above = {"plug": below, "bed": 6 * kernel, "jet": 40 * d}[point.scene]
    layers = max(6, round((below + bed + above) / edge))
    wide, depth = across * lattice, deep * lattice
    floor = below if point.scene == "plug" else 0.55 * d
    cells = (cells_along(wide, edge), cells_along(depth, edge), layers)
    return Layout(wide, depth, layers * edge, cells, lattice, (across, deep, up), floor)


@dataclasses.dataclass(frozen=True)
class Physics:
    """Of a point: what follows from its numbers."""
    gas_density: float
    velocity: float  # superficial, or of the jet, m/s
    void: float
    limit: float  # of the coupling interval, s
    interval: float  # asked for, s; 0: default
    step: float  # DEM, s
    exchange: float  # about the interval that will be, s


def physics(point):
    gas_density = GRAIN_DENSITY / point.density_ratio
    void = point.void if point.scene == "plug" else 0.42
    velocity = point.velocity
    if point.scene == "bed":
        velocity *= minimum_fluidization(void, point.diameter, gas_density)
    slip = velocity / void
    rate = drag(void, slip, point.diameter, gas_density)
    limit = 2 * void**2 * GRAIN_DENSITY / rate
    interval = point.interval * limit
    if point.varied == "gas_step" or point.scene == "plug":
        interval = min(interval or 0.05 * limit, MOST_GAS_STEPS * point.gas_step)
    mass = GRAIN_DENSITY * math.pi / 6 * point.diameter**3
    contact = math.pi * math.sqrt(mass / 2 / point.spring)
    exchange = min(interval or 0.05 * limit, 0.5 * limit)
    step = exchange / 8 if point.scene == "plug" else min(contact / 10, exchange / 4)
    step = exchange / math.ceil(exchange / step * (1 - 1e-9))
    return Physics(gas_density, velocity, void, limit, interval, step, exchange)


def floor_and_patch(point, box, what):
    """(condition of the lower side, its patch)"""
    if point.scene == "jet":
        half = max(1.5 * point.l * point.diameter, 0.51 * box.wide / box.cells[0])
        return "no-slip", f"""[[boundary.patch]]
name = "jet"
side = "z_lower"
box = {{lower = [{box.wide / 2 - half:g}, -1, -1], upper = [{box.wide / 2 + half:g}, 1, 1]}}
type = "inlet"
superficial_velocity = {what.velocity:g}
"""
    floor = inlet(what.velocity)
    if point.scene == "bed":  # an impulsive start throws light grains up, as it should
        half = 0.5 * max(RESTING * what.exchange, 5 * what.limit)
        floor += f", time_table = {{times = [0, {half:g}, 1e6], values = [0, 1, 1]}}"
    return floor, ""


def walls(point, box):
    """Names and planes of the grains' walls."""
    places = {"floor": plane((0, 0, 0), (0, 0, 1))} if point.scene != "plug" else {}
    if point.scene == "jet":
        places |= {"left": plane((0, 0, 0), (1, 0, 0)), "right": plane((box.wide, 0, 0), (-1, 0, 0)),
                   "lid": plane((0, 0, box.high), (0, 0, -1))}
    return places


def case_file(point):
    box, what = layout(point), physics(point)
    floor, patch = floor_and_patch(point, box, what)
    x, y = ("periodic" if count > 1 else "slip" for count in box.cells[:2])
    if point.scene == "jet":
        x = "no-slip" if x == "periodic" else x
    gas = gas_case((box.wide, box.deep, box.high), box.cells, x=x, y=y, below=floor,
                   density=what.gas_density, viscosity=VISCOSITY)
    bodies = "".join(body(name, shape, acts_on="grains")
                     for name, shape in walls(point, box).items())
    interval = f"exchange_interval = {what.interval:.10g}\n" if what.interval else ""
    return f"""{gas}{patch}{bodies}[numerics]
largest_step = {point.gas_step:g}
[coupling]
{interval}series_interval = {what.exchange:.10g}
[output]
interval = 1e3
fields = ["void_fraction", "pressure"]
"""


def head(point, box, what):
    boundary = {"plug": "p p f", "bed": "p p f", "jet": "f p f"}[point.scene]
    return f"""units si
atom_style granular
atom_modify map array
boundary {boundary}
newton off
communicate single vel yes
soft_particles yes
region box block 0 {box.wide:.12g} 0 {box.deep:.12g} 0 {box.high:.12g} units box
create_box 2 box
coarsegraining {point.l:g} model_check warn
neighbor {0.4 * point.diameter:g} bin
neigh_modify delay 0 contact_distance_factor 1.01
fix k all property/global cgmSpringConstant peratomtypepair 2 {" ".join([f"{point.spring:g}"] * 4)}
fix e all property/global coefficientRestitution peratomtypepair 2 {" ".join([f"{RESTITUTION}"] * 4)}
fix mu all property/global coefficientFriction peratomtypepair 2 0.3 0.3 0.3 0.3
pair_style gran model cgm tangential history
pair_coeff * *
timestep {what.step:.12g}
lattice custom 1.0 a1 {box.lattice:.12g} 0 0 a2 0 {box.lattice:.12g} 0 a3 0 0 {box.lattice:.12g} &
  basis 0.25 0.25 0 basis 0.75 0.75 0 basis 0.25 0.75 0.5 basis 0.75 0.25 0.5 origin 0 0 0
region fill block 0 {box.wide:.12g} 0 {box.deep:.12g} {box.floor:.12g} &
  {box.floor + box.count[2] * box.lattice - 1e-3 * box.lattice:.12g} units box
create_atoms 1 region fill
set group all density {GRAIN_DENSITY:g} diameter {point.diameter:.12g}
thermo_style custom step atoms ke
thermo_modify norm no lost error
thermo 100000000
"""


def push_of(point, what):
    """m/s: small against the slip, and stopped within a twentieth of a diameter."""
    return 0.05 * min(what.velocity / what.void, point.l * point.diameter / (0.5 * what.limit))


def steady_exchanges(point):
    """Until the plug that is held feels the pressure of the steady flow: light grains feel that of
    the impulsive start for some twenty exchanges, three quarters of it after each."""
    return 48 if point.density_ratio < 10 else 12


def plug_script(point, box, what):
    exchange = round(what.exchange / what.step)
    return head(point, box, what) + f"""
variable fz atom fz
compute weight all reduce sum v_fz
compute mass all property/atom mass
compute total all reduce sum c_mass
fix gas all couple/gas case case.toml out .
thermo_style custom step atoms ke c_weight c_total
thermo_modify norm no lost error
run {steady_exchanges(point) * exchange}
variable g equal $(c_weight/c_total)
fix gravity all gravity $g vector 0 0 -1
fix integrate all nve/sphere
fix rigid all aveforce 0 0 0
velocity all set 0 0 {push_of(point, what):g} units box
run {PUSHED * exchange}
"""


def settling(point, box, what):
    """Steps in which the grains fall and come to rest."""
    fall = math.sqrt(2 * box.count[2] * box.lattice / 9.81)
    return math.ceil(7 * fall / what.step)


def bed_script(point, box, what):
    fixes = "\n".join(f"fix {name} all wall/sdf case case.toml body {name} type 2"
                      for name in walls(point, box))
    exchange = round(what.exchange / what.step)
    # long enough for the flow to follow its ramp
    steps = max(RESTING * exchange, round(5 * what.limit / what.step))
    if point.scene == "jet":
        steps = math.ceil(0.1 * math.sqrt(point.l * point.diameter / 2e-3) / what.step)
    return head(point, box, what) + f"""
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
{fixes}
displace_atoms all random {0.02 * box.lattice:g} {0.02 * box.lattice:g} {0.01 * box.lattice:g} 49979687 units box
run {settling(point, box, what)}
velocity all set 0 0 0 units box
fix gas all couple/gas case case.toml out .
run {steps}
"""


def script(point):
    box, what = layout(point), physics(point)
    return (plug_script if point.scene == "plug" else bed_script)(point, box, what)
