"""Scenes with gas: bubbling bed with a tube, die filling."""

import math

import numpy

import measures
from gas_case import inlet
from laws import Material
from scene import Gas, Scene, Wall, plane

def sides(lower, upper, axis, names):
    """Two walls that face each other."""
    return plane(names[0], axis, lower[axis], 1), plane(names[1], axis, upper[axis], -1)


# ---- bubbling bed: 25 x 5 mm, periodic along the depth, about 19 mm high, air at 0.5 m/s (minimum
# fluidization, Wen and Yu: 0.19)

BED_START = 0.3  # s, start-up that is left out
BED_TOP = (0.025, 0.005, 0.06)


def measure_bed(frames, scene, case, directory):
    rows = measures.series(directory)
    late = rows["time"] > BED_START
    times, pressure = rows["time"][late], rows["pressure_drop"][late]
    frames = [f for i, f in enumerate(frames) if i * scene.frame > BED_START]
    left = [(f[:, 1] < BED_TOP[0] / 2).mean() for f in frames]
    return {
        "pressure_drop": pressure.mean(),
        "pressure_deviation": pressure.std(),
        "pressure_frequency": measures.mean_crossing_frequency(times, pressure, 0.02),
        "bed_height": rows["bed_height"][late].mean(),
        "centre_height": numpy.mean([f[:, 3].mean() for f in frames]),
        "side_to_side": numpy.std(left),
        "granular_temperature": numpy.mean(
            [measures.granular_temperature(f, [1, 3], 0.005) for f in frames]),
    }


BED = Scene(
    name="bed", title="bubbling bed with a tube", size="50 wide, tube of 10",
    material=Material(diameter=5e-4, density=2500, spring=50, restitution=0.9, friction=0.3,
                      impact_speed=0.3),
    count=20736, lower=(0, 0, 0), upper=BED_TOP, boundary="f p f",
    region="region space block 0 0.025 0 0.005 0 0.059 units box\n"
           "region outside cylinder y 0.0125 0.01 0.0026 0 0.005 units box side out\n"
           "region fill intersect 2 space outside",
    walls=(*sides((0, 0, 0), BED_TOP, 0, ("left", "right")), plane("floor", 2, 0.0, 1),
           Wall("tube",
                "cylinder = {point = [0.0125, 0, 0.01], axis = [0, 1, 0], radius = 0.0025}",
                # stock takes z before x
                "primitive type 2 ycylinder 0.0025 0.01 0.0125", acts_on="")),
    settle=0.14, time=1.3, frame=0.02, measure=measure_bed, cell=1.25e-3, sampled_wall="tube",
    gas=Gas(floor=inlet(0.5), depth="periodic", series_interval=2.5e-3),
    quantities={"pressure_drop": ("Pa", "relative"), "pressure_deviation": ("Pa", "relative"),
                "pressure_frequency": ("Hz", "relative"), "bed_height": ("m", "relative"),
                "centre_height": ("m", "relative"), "side_to_side": ("-", "absolute"),
                "granular_temperature": ("m2/s2", "relative")})


# ---- die filling: die of 5 x 4 mm, 4 mm deep, below a shoe of 12 mm; the gate opens at once

DIE_LOWER, DIE_TOP = (0, 0, -0.004), (0.012, 0.004, 0.02)
DIE_LEFT, DIE_RIGHT = 0.0035, 0.0085


def ledge(x_from, x_to):
    """A block beside the die, beyond the sides of the box but where it meets the die."""
    return (f"box = {{lower = [{x_from:g}, -0.01, -0.02], upper = [{x_to:g}, 0.02, 0]}}")


def die_mesh():
    """Ledges and sides of the die for stock, ASCII STL, beyond the walls in front and back."""
    profile = [(-0.0015, 0.0), (DIE_LEFT, 0.0), (DIE_LEFT, -0.0055)]
    mirrored = [(0.0135, 0.0), (DIE_RIGHT, 0.0), (DIE_RIGHT, -0.0055)]
    text = "solid ledges\n"
    for line in (profile, mirrored):
        for (xa, za), (xb, zb) in zip(line, line[1:]):
            corners = [(xa, -5e-4, za), (xa, 4.5e-3, za), (xb, 4.5e-3, zb), (xb, -5e-4, zb)]
            for a, b, c in ((0, 1, 2), (0, 2, 3)):
                text += "facet normal 0 0 1\nouter loop\n"
                text += "".join("vertex {:g} {:g} {:g}\n".format(*corners[i]) for i in (a, b, c))
                text += "endloop\nendfacet\n"
    return text + "endsolid ledges\n"


def measure_die(frames, scene, case, directory):
    mass = scene.material.mass * case.l**3
    times = numpy.arange(len(frames)) * scene.frame
    filled = numpy.array([(frame[:, 3] < 0).sum() for frame in frames]) * mass
    rows = measures.series(directory)
    return {
        "filled_mass": filled[-5:].mean(),
        "half_time": measures.first_crossing(times, filled, 0.5 * filled[-1]),
        "ninety_percent_time": measures.first_crossing(times, filled, 0.9 * filled[-1]),
        "largest_pressure": rows["pressure_drop"].max(),
        "largest_energy": max((frame[:, 4:] ** 2).sum() / 2 / len(frame) for frame in frames),
    }


DIE = Scene(
    name="die", title="die filling", size="die 25 x 20",
    material=Material(diameter=2e-4, density=2500, spring=10, restitution=0.9, friction=0.3,
                      impact_speed=0.2),
    count=31104, lower=DIE_LOWER, upper=DIE_TOP, boundary="f f f",
    region="region fill block 0 0.012 0 0.004 0 0.0198 units box",
    walls=(*sides(DIE_LOWER, DIE_TOP, 0, ("left", "right")),
           *sides(DIE_LOWER, DIE_TOP, 1, ("front", "back")), plane("bottom", 2, -0.004, 1),
           Wall("ledge_a", ledge(-0.01, DIE_LEFT), "mesh n_meshes 1 meshes ledges",
                mesh="fix ledges all mesh/surface file ledges.stl type 2",
                acts_on=""),
           Wall("ledge_b", ledge(DIE_RIGHT, 0.03), "", acts_on=""),
           plane("gate", 2, 0.0, 1, gate=True)),
    settle=0.08, time=0.2, frame=0.0025, measure=measure_die, margin=0.002, cell=5e-4, sampled_wall="ledge_a",
    gas=Gas(floor="no-slip", depth="no-slip", series_interval=1e-3),
    quantities={"filled_mass": ("kg", "relative"), "half_time": ("s", "relative"),
                "ninety_percent_time": ("s", "relative"), "largest_pressure": ("Pa", "relative"),
                "largest_energy": ("J/kg", "relative")})
