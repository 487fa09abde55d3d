"""Discharge of a conical hopper against Beverloo's law"""

import math
import pathlib
import sys

import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import common  # noqa: E402
import options  # noqa: E402
import plot  # noqa: E402
import text_dump  # noqa: E402

DIAMETER, DENSITY = 2e-3, 2500.0  # of a grain: m, kg/m^3
OUTLET = 0.014  # m
SLOPE = 0.023 / 0.044  # of the cone: tangent of its half angle
STEP = 4e-5  # s
OPENING = 0.4  # s
MEASURED = (0.55, 0.95)  # s after the opening: steady flow


def beverloo(bulk_density):
    """Discharge, kg/s: C rho_b sqrt(g) (D - k d)^2.5 with C = 0.58, k = 1.5 (Beverloo, Leniger and van
    de Velde, Chemical Engineering Science 15, 1961, 260-269), for a flat bottom; through a cone
    steeper than the edge of the stagnant zone, taken as 45 degrees, tan(half angle)^-0.35 times as
    much (Rose and Tanaka, The Engineer 208, 1959, 465-469)."""
    flat = 0.58 * bulk_density * math.sqrt(9.81) * (OUTLET - 1.5 * DIAMETER) ** 2.5
    return flat * SLOPE**-0.35


def given_options():
    parser = options.parser_of("hopper", __doc__)
    options.add_count(parser, 14000)
    options.add_number(parser, "--time", "T",
                       f"simulated time, s; the gate opens at {OPENING} s", 1.9)
    options.add_run(parser, "hopper")
    chosen = parser.parse_args()
    if not 12000 <= chosen.grains <= 20000:
        parser.error(f"--grains is {chosen.grains}, but must be 12000 to 20000: fewer do not fill the "
                     "cone, more do not fit")
    if not chosen.time >= OPENING + MEASURED[1]:
        parser.error(f"--time is {chosen.time:g}, but must be at least {OPENING + MEASURED[1]:g} s")
    return chosen


def bulk_density(frame):
    """Of the grains at rest in the cylindrical bin, between 51 and 57 mm, kg/m^3."""
    lower, upper, radius = 0.051, 0.057, 0.03
    inside = (frame["z"] > lower) & (frame["z"] < upper)
    mass = DENSITY * math.pi / 6 * DIAMETER**3 * numpy.count_nonzero(inside)
    return mass / (math.pi * radius**2 * (upper - lower))


def summary(series, at_rest):
    time = series["time"] - OPENING
    steady = (time >= MEASURED[0]) & (time <= MEASURED[1])
    flow = -numpy.polyfit(time[steady], series["mass"][steady], 1)[0]
    resting = (time > -0.05) & (time < 0)
    load, weight = series["wall_load"][resting].mean(), series["weight"][resting].mean()

    density = bulk_density(at_rest)
    return [
        common.quantity("discharge", flow, "kg/s", reference=beverloo(density), tolerance=0.2,
                 source="Beverloo 1961 with the cone factor of Rose and Tanaka 1959"),
        common.quantity("load_at_rest", load, "N", reference=float(weight), tolerance=0.02,
                 source="weight of the grains"),
        common.quantity("bulk_density", density, "kg/m^3"),
    ]


def main():
    chosen = given_options()
    out = common.fresh_directory(chosen.out)
    print("Discharge of a conical hopper of 60 mm with an outlet of 14 mm")
    print(f"  grains         {chosen.grains} of {1e3 * DIAMETER:g} mm")
    print(f"  time           {chosen.time:g} s, gate opens at {OPENING} s, flow measured from "
          f"{OPENING + MEASURED[0]:g} to {OPENING + MEASURED[1]:g} s")
    print(f"  ranks          {chosen.ranks}")
    print(f"  results        {out}")
    print("\nabout a minute on two cores ...", flush=True)
    for name in ("hopper.toml", "hopper.in"):
        (out / name).write_text((HERE / name).read_text())
    common.run_gasgrain(out, "hopper.in", chosen.ranks, {"count": chosen.grains, "time": chosen.time})

    series = text_dump.read_table(out / "series.csv")
    frames = [(step * STEP, frame) for step, frame in text_dump.read_dump(out / "grains.dump")]
    at_rest = min(frames, key=lambda frame: abs(frame[0] - OPENING + 0.01))[1]
    quantities = common.write_summary(out, "hopper", summary(series, at_rest))
    common.print_quantities(quantities)
    plot.draw(out / "result.png", frames, at_rest, series, quantities)
    print(f"\npicture   {out / 'result.png'}")
    print(f"summary   {out / 'summary.json'}")


if __name__ == "__main__":
    main()
