"""Flat-bottomed spouted bed with a central jet: spout, fountain and annulus"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import analysis  # noqa: E402
import common  # noqa: E402
import grains  # noqa: E402
import options  # noqa: E402
import pieces  # noqa: E402
import plot  # noqa: E402

ORIGINAL_COUNT = 72_000
ORIGINAL_RADIUS, DENSITY, RESTITUTION = 0.5e-3, 2500.0, 0.9  # m, kg/m^3
GAS_DENSITY, VISCOSITY = 1.2, 1.8e-5  # kg/m^3, Pa s
EXCHANGE = 2e-4  # s
# A spouted bed at its greatest spoutable height needs less pressure than a fluidized one: by
# 2/pi (Lefroy and Davidson, Transactions of the Institution of Chemical Engineers 47, 1969,
# T120-T128) to 3/4 (Mamuro and Hattori, Journal of Chemical Engineering of Japan 1, 1968, 1-5).
# Both are for round columns without aeration: an indication here, not a target.
SPOUTING = 2 / math.pi


def given_options():
    parser = options.parser_of("spouted_bed", __doc__)
    options.add_grains(parser, (", originals are beads of 1 mm", 2.0), ("", 100.0))
    options.add_number(parser, "--jet", "U", "velocity of the jet in its slot of 12 mm, m/s", 10.0)
    options.add_number(parser, "--aeration", "U",
                       "superficial velocity through the rest of the floor, m/s", 0.25)
    options.add_number(parser, "--time", "T", "simulated time with gas, s", 1.6)
    options.add_start_up(parser, 0.6)
    options.add_pieces(parser, "spouted_bed")
    chosen = parser.parse_args()
    options.require(parser, chosen, {"grain": 1, "ranks": 1, "time": 0, "spring": 0, "jet": 0,
                                     "hours": 0})
    options.require_start_up(parser, chosen)
    if chosen.grain > 3:
        parser.error(f"--grain is {chosen.grain:g}: grains above 3 mm do not fit a depth of 12 mm")
    if chosen.aeration < 0:
        parser.error(f"--aeration is {chosen.aeration:g}, but must not be negative")
    return chosen


def case_text(chosen):
    """The case file with what was chosen."""
    case = common.set_key((HERE / "gas.toml").read_text(), "average_from", chosen.start_up)
    case = common.set_text(case, "superficial_velocity = 10.0",
                           f"superficial_velocity = {chosen.jet:g}")
    return common.set_text(case, "superficial_velocity = 0.25",
                           f"superficial_velocity = {chosen.aeration:g}")


def make_job(chosen, out):
    """Writes script and case into `out`; prints what will be run."""
    duration = grains.contact_time(ORIGINAL_RADIUS, DENSITY, chosen.spring, RESTITUTION)
    step = grains.time_step(duration, EXCHANGE)
    count = round(ORIGINAL_COUNT / chosen.grain**3)
    mean = (chosen.jet * analysis.JET
            + chosen.aeration * (analysis.WIDTH - analysis.JET)) / analysis.WIDTH
    fluidizing = analysis.minimum_fluidization_velocity(2 * ORIGINAL_RADIUS, DENSITY, GAS_DENSITY,
                                                        VISCOSITY)
    print("Flat-bottomed spouted bed, 100 x 12 x 248 mm, slot of 12 mm, gas cells of 4 mm")
    print(f"  grains         {count} of {2e3 * ORIGINAL_RADIUS * chosen.grain:g} mm "
          f"(l = {chosen.grain:g}) for {ORIGINAL_COUNT} glass beads of 1 mm")
    print(f"  gas            jet {chosen.jet:g} m/s, aeration {chosen.aeration:g} m/s, together "
          f"{mean:.3g} m/s;")
    print(f"                 minimum fluidization {fluidizing:.3g} m/s (Wen and Yu)")
    print(f"  spring         {chosen.spring:g} N/m, contact time {duration:.3g} s, "
          f"step {step:.4g} s = contact time / {duration / step:.1f}")
    print(f"  time           {chosen.time:g} s with gas, averaged from {chosen.start_up:g} s")
    print(f"  ranks          {chosen.ranks}")
    print(f"  results        {out}")
    (out / "gas.toml").write_text(case_text(chosen))
    (out / "bed.in").write_text((HERE / "bed.in").read_text())
    return pieces.Job(out, "bed.in", {
        "l": chosen.grain, "count": count, "k": chosen.spring, "dt": step, "time": chosen.time,
        "points": round(0.1 / step), "case": "gas.toml", "out": ".",
    }, packing=("l", "count", "k", "dt"))


def add_measured(out, result):
    """Adds what the frames say to summary.json; returns name -> quantity of what to print."""
    known = common.read_summary(out)
    pressure, load = (known[name] for name in ("pressure_drop_mean", "pressure_drop_weight_over_area"))
    rows = [
        common.quantity("pressure_drop_over_weight", pressure["value"] / load["value"], "-",
                        reference=SPOUTING, source="2/pi, Lefroy and Davidson 1969, tall round beds"),
        common.quantity("spout_width", result["spout_width"], "m"),
        common.quantity("annulus_height", result["annulus_height"], "m"),
        common.quantity("fountain_height", result["fountain_height"], "m"),
    ]
    common.add_quantities(out, rows)
    shown = ("flux_up_mid_mean", "flux_down_mid_mean", *(row["name"] for row in rows))
    found = common.read_summary(out)
    return {name: found[name] for name in shown}


def main():
    chosen = given_options()
    out = common.results_directory(chosen.out, "spouted_bed")
    job = make_job(chosen, out)
    pieces.run_piece(job, chosen)
    result = analysis.analyse(out, chosen.start_up)
    quantities = add_measured(out, result)
    pieces.add_provenance(job, chosen, {"case": "spouted_bed"})
    common.print_quantities(quantities)
    if chosen.no_pictures:
        return
    plot.draw(out, out / "result.png", chosen.start_up, result)
    plot.animate(out, out / "bed.gif", analysis.HEIGHT)
    print(f"\npictures  {out}/result.png, bed.gif")
    print(f"fields    {out}/*.xdmf (open in ParaView)")
    print(f"summary   {out / 'summary.json'}")


if __name__ == "__main__":
    main()
