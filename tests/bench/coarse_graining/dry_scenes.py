"""Scenes without gas: slumping column and rotating drum, periodic along their depth, and hopper
discharge."""

import math

import numpy

import measures
from laws import Material
from scene import Scene, Wall, plane

DIAMETER = 1e-3  # m
DEPTH = 12e-3  # m, of all three scenes


def sand(spring, wall_friction=None):
    return Material(diameter=DIAMETER, density=2500, spring=spring, restitution=0.8, friction=0.4,
                    impact_speed=0.3, wall_friction=wall_friction)


# ---- slumping column: 30 mm wide, about 48 mm high; the gate is taken away at once

def measure_column(frames, scene, case, directory):
    x, z = frames[-1][:, 1], frames[-1][:, 3]
    centres = [frame[:, 1].mean() for frame in frames]
    times = numpy.arange(len(frames)) * scene.frame
    return {
        "runout": numpy.quantile(x, 0.95),
        "height": numpy.quantile(z[x < 0.01], 0.95),
        "repose_angle": math.degrees(math.atan(z.mean() / x.mean())),
        "half_time": measures.first_crossing(times, centres, (centres[0] + centres[-1]) / 2),
        "largest_energy": max((frame[:, 4:] ** 2).sum() / 2 / len(frame) for frame in frames),
    }


COLUMN = Scene(
    name="column", title="slumping column", size="layer 20 high",
    material=sand(250), count=20736,
    lower=(0, 0, 0), upper=(0.8, DEPTH, 0.202), boundary="f p f",
    region="region fill block 0 0.03 0 0.012 0 0.2 units box",
    walls=(plane("floor", 2, 0.0, 1), plane("left", 0, 0.0, 1),
           plane("gate", 0, 0.03, -1, gate=True)),
    settle=0.3, time=0.5, frame=0.01, measure=measure_column,
    quantities={"runout": ("m", "relative"), "height": ("m", "relative"),
                "repose_angle": ("deg", "relative"), "half_time": ("s", "relative"),
                "largest_energy": ("J/kg", "relative")})


# ---- rotating drum: radius 30 mm, 4 rad/s (Froude number 0.05), filled to about 40 %

DRUM_RADIUS, DRUM_RATE = 0.03, 4.0


def measure_drum(frames, scene, case, directory):
    first = frames[0]
    marked = (first[:, 2] < numpy.median(first[:, 2])).astype(float)
    edge = 0.01
    mixing = [measures.lacey_index(marked, frame[:, [2, 3]], edge) for frame in frames]
    late = frames[len(frames) // 3:]
    angles = [math.degrees(math.atan2(abs(f[:, 2].mean()), -f[:, 3].mean())) for f in late]
    return {
        "centre_angle": numpy.mean(angles),
        "centre_radius": numpy.mean([math.hypot(f[:, 2].mean(), f[:, 3].mean()) for f in late]),
        "mixing_half_turn": numpy.interp(math.pi / DRUM_RATE,
                                         numpy.arange(len(frames)) * scene.frame, mixing),
        "mixing_end": mixing[-1],
        "kinetic_energy": numpy.mean([(f[:, 4:] ** 2).sum() / 2 / len(f) for f in late]),
        "granular_temperature": numpy.mean(
            [measures.granular_temperature(f, [2, 3], edge) for f in late]),
    }


# The wall is rough: at a friction of 0.4 the bed of two seeds of three slid along it as a whole (at
# atan 0.4 = 22 degrees) and that of the third was carried up to 28.5 degrees.
# Along x: stock's `shear` turns xcylinder and zcylinder, but moves the surface of a ycylinder
# along its radius. Across the axis it takes the rate in rad/s.
DRUM = Scene(
    name="drum", title="rotating drum", size="60 across",
    material=sand(100, wall_friction=1.0), count=15552,
    lower=(0, -0.031, -0.031), upper=(DEPTH, 0.031, 0.031), boundary="p f f",
    region="region fill cylinder x 0 0 0.0299 0 0.012 units box",
    walls=(Wall("drum",
                f"complement = {{cylinder = {{point = [0, 0, 0], axis = [1, 0, 0], "
                f"radius = {DRUM_RADIUS}}}}}\n"
                f"motion = {{rotate = {{point = [0, 0, 0], axis = [1, 0, 0], rate = {DRUM_RATE}}}, "
                "surface_only = true}",
                f"primitive type 2 xcylinder {DRUM_RADIUS} 0 0 shear y {DRUM_RATE:g}"),),
    settle=0.8, time=2.4, frame=0.02, measure=measure_drum, sampled_wall="drum",
    quantities={"centre_angle": ("deg", "relative"), "centre_radius": ("m", "relative"),
                "mixing_half_turn": ("-", "absolute"), "mixing_end": ("-", "absolute"),
                "kinetic_energy": ("J/kg", "relative"),
                "granular_temperature": ("m2/s2", "relative")})


# ---- hopper: 48 mm wide, 45 degrees, slot of 16 mm; the gate is taken away at once

SLOT, WIDTH = 0.016, 0.048


def hopper_mesh():
    """The two inclined plates for stock, ASCII STL, 1 mm beyond front and back."""
    side = (WIDTH - SLOT) / 2
    text = "solid plates\n"
    for top, bottom in ((0.0, side), (WIDTH, WIDTH - side)):
        corners = [(top, -1e-3, side), (top, DEPTH + 1e-3, side), (bottom, DEPTH + 1e-3, 0.0),
                   (bottom, -1e-3, 0.0)]
        for a, b, c in ((0, 1, 2), (0, 2, 3)):
            text += "facet normal 0 0 1\nouter loop\n"
            text += "".join("vertex {:g} {:g} {:g}\n".format(*corners[i]) for i in (a, b, c))
            text += "endloop\nendfacet\n"
    return text + "endsolid plates\n"


def plate(mirrored):
    """A plate of 30 x 6 mm whose upper face ends at the slot; a box, since its distance is exact."""
    half_length, half_thickness, side = 0.015, 0.003, (WIDTH - SLOT) / 2
    x = side - (half_length + half_thickness) / math.sqrt(2)
    z = (half_length - half_thickness) / math.sqrt(2)
    if mirrored:
        x = WIDTH - x
    return (f"box = {{lower = [{x - half_length:.9g}, -0.01, {z - half_thickness:.9g}], "
            f"upper = [{x + half_length:.9g}, 0.03, {z + half_thickness:.9g}], "
            f"rotation_axis = [0, 1, 0], rotation_angle = {-45 if mirrored else 45}}}")


def measure_hopper(frames, scene, case, directory):
    mass = scene.material.mass * case.l**3
    total = len(frames[0])
    inside = numpy.array([(frame[:, 3] > 0).sum() for frame in frames])
    out = total - inside
    times = numpy.arange(len(frames)) * scene.frame
    # between 15 and 60 % discharged: started up, and still covered
    chosen = (out > 0.15 * total) & (out < 0.60 * total)
    rate = numpy.polyfit(times[chosen], out[chosen] * mass, 1)[0] if chosen.sum() > 2 else math.nan
    middle = abs(frames[0][:, 1] - WIDTH / 2) < 0.012
    half = numpy.argmax(out > total / 2)
    zone = frames[half][(frames[half][:, 3] > 0) & (frames[half][:, 3] < 0.012)]
    return {
        "rate": rate,
        "half_time": measures.first_crossing(times, out, total / 2),
        "height": numpy.quantile(frames[0][middle, 3], 0.98),
        "left_behind": inside[-1] / total,
        "temperature_at_slot": measures.granular_temperature(zone, [1, 3], 0.008) if len(zone) > 4
        else math.nan,
    }


def beverloo_rate(l):
    """C rho_b sqrt(g) D (W - k d)^(3/2) of a slot with C = 1.03, k = 1.4 (Beverloo 1961, Brown and
    Richards 1970), packed to 0.58; kg/s."""
    return (1.03 * 0.58 * 2500 * math.sqrt(9.81) * DEPTH
            * (SLOT - 1.4 * l * DIAMETER) ** 1.5)


HOPPER = Scene(
    name="hopper", title="hopper discharge", size="slot of 16",
    material=sand(250), count=20736,
    lower=(0, 0, -0.03), upper=(WIDTH, DEPTH, 0.14), boundary="f f f",
    region=f"region fill block 0 {WIDTH} 0 {DEPTH} 0.0165 0.139 units box",
    walls=(plane("side_a", 0, 0.0, 1), plane("side_b", 0, WIDTH, -1),
           plane("front", 1, 0.0, 1), plane("back", 1, DEPTH, -1),
           Wall("plate_a", plate(mirrored=False),
                "mesh n_meshes 1 meshes plates",
                mesh="fix plates all mesh/surface file plates.stl type 2"),
           Wall("plate_b", plate(mirrored=True), ""),
           plane("gate", 2, 0.0, 1, gate=True)),
    settle=0.3, time=0.35, frame=0.005, measure=measure_hopper, margin=0.002,
    loses_grains=True,
    note="Beverloo's law gives " + ", ".join(
        f"{beverloo_rate(l):.3f} kg/s at l = {l}" for l in (1, 2, 3, 4))
    + ": a slot that is few grains wide is slower whatever the contact law.",
    quantities={"rate": ("kg/s", "relative"), "half_time": ("s", "relative"),
                "height": ("m", "relative"), "left_behind": ("-", "absolute"),
                "temperature_at_slot": ("m2/s2", "relative")})
