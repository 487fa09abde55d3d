"""Fluidized bed with four inserted tubes (Mori, Wu, Sakai 2019, cases 1-1 and 1-2)"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import common  # noqa: E402
import grains  # noqa: E402
import options  # noqa: E402
import pieces  # noqa: E402
import plot  # noqa: E402

ORIGINAL_COUNT = 250_000 * 5**3  # the paper: 250 000 grains of ratio 5
ORIGINAL_RADIUS = 50e-6  # m
DENSITY = 2500.0  # kg/m^3
SIZE = (0.05, 0.01, 0.2)  # m
MEASURED_HEIGHT = {0.2: 0.0917, 0.3: 0.0949}  # gas velocity in m/s -> bed height in m
CASES = {0.2: "1-1", 0.3: "1-2"}
ROW = 2e-3  # s between rows of loads.csv


def add_experiment(quantities, velocity):
    """Reference of the bed height where there is one: the experiment of the paper."""
    if velocity in MEASURED_HEIGHT:
        quantities["bed_height_mean"].update(
            reference=MEASURED_HEIGHT[velocity], tolerance=0.05,
            source="experiment, Mori, Wu, Sakai, Powder Technology, 2019")


def print_comparison(quantities):
    print(f"\n{'quantity':<30}{'here':>10}{'reference':>11}{'deviation':>11}")
    rows = (("mean bed height / mm", "bed_height_mean", 1e3, None),
            ("mean pressure drop / Pa", "pressure_drop_mean", 1.0, "pressure_drop_force_balance"))
    for label, name, scale, reference_name in rows:
        value = quantities[name]["value"]
        reference = (quantities[reference_name]["value"] if reference_name
                     else quantities[name]["reference"])
        if value is None:
            continue
        line = f"{label:<30}{scale * value:>10.4g}"
        if reference:
            line += f"{scale * reference:>11.4g}{100 * (value / reference - 1):>+10.1f} %"
        print(line)
    print("  (bed height: experiment of the paper; pressure drop: static estimate with buried tubes)")


def given_options():
    parser = options.parser_of("fluidized_bed_tubes", __doc__)
    parser.add_argument("--paper", action="store_true",
                        help="the paper's grains and spring, 1 s + 2 s: --grain 5 --spring 50 --time 3 "
                             "--start-up 1 unless stated (hours)")
    options.add_grains(parser, ("; the paper takes 5", "10"), ("; the paper takes 50", "0.25"))
    options.add_number(parser, "--velocity", "U",
                       "superficial gas velocity, m/s; the paper takes 0.2 and 0.3", 0.2)
    options.add_number(parser, "--time", "T", "simulated time with gas, s", "0.8")
    # The packed bed rises as a plug before it bubbles.
    options.add_start_up(parser, "0.3")
    options.add_number(parser, "--gas-step", "S", "largest gas step, s", 1e-4)
    options.add_number(parser, "--cell", "MM", "cell of the gas, mm", 1.25)
    options.add_closures(parser, friction=0.3, restitution=0.9)
    parser.add_argument("--tubes", type=float, nargs=4, default=(15, 35, 20, 40),
                        metavar=("X1", "X2", "Z1", "Z2"),
                        help="axes of the four tubes, mm; the paper does not print them (default "
                             "15 35 20 40)")
    options.add_pieces(parser, "fluidized_bed_tubes")
    chosen = parser.parse_args()
    options.fill_in(chosen, {"grain": 5.0, "spring": 50.0, "time": 3.0, "start_up": 1.0}
                    if chosen.paper else
                    {"grain": 10.0, "spring": 0.25, "time": 0.8, "start_up": 0.3})
    options.require(parser, chosen, {"grain": 1, "ranks": 1, "time": 0, "spring": 0, "gas_step": 0,
                                     "cell": 0, "hours": 0, "velocity": 0})
    options.require_restitution(parser, chosen)
    options.require_start_up(parser, chosen)
    if chosen.grain > 25:
        parser.error(f"--grain is {chosen.grain:g}: grains above 2.5 mm (l = 25) do not fit between tubes and walls")
    return chosen


def case_text(chosen, exchange):
    """The case file with what was chosen."""
    case = (HERE / "gas.toml").read_text()
    for key, value in (("superficial_velocity", chosen.velocity), ("exchange_interval", exchange),
                       ("largest_step", chosen.gas_step), ("average_from", chosen.start_up)):
        case = common.set_key(case, key, value)
    cells = [max(1, round(1e3 * length / chosen.cell)) for length in SIZE]
    case = common.set_text(case, "cells = [40, 8, 160]", f"cells = {cells}")
    case = common.set_text(case, 'drag = "gidaspow"', f'drag = "{chosen.drag}"')
    case = common.set_mapping(common.set_kernel(case, chosen.kernel), chosen.mapping)
    for number, (x, z) in enumerate(plot.tube_axes(chosen.tubes), 1):
        old = plot.tube_axes(plot.TUBES)[number - 1]
        case = common.set_text(case, f'"tube{number}"\ncylinder = {{point = [{old[0]:.3f}, 0.005, {old[1]:.3f}]',
                               f'"tube{number}"\ncylinder = {{point = [{x:g}, 0.005, {z:g}]')
    return case


def make_job(chosen, out):
    """Writes script and case into `out`; prints what will be run."""
    exchange = 2 * chosen.gas_step
    duration = grains.contact_time(ORIGINAL_RADIUS, DENSITY, chosen.spring, chosen.restitution)
    step = grains.time_step(duration, exchange)
    count = round(ORIGINAL_COUNT / chosen.grain**3)
    print(f"Fluidized bed with four tubes, 50 x 10 x 200 mm, gas cells of {chosen.cell:g} mm")
    print(f"  grains         {count} of {2e3 * ORIGINAL_RADIUS * chosen.grain:g} mm "
          f"(l = {chosen.grain:g}) for {ORIGINAL_COUNT / 1e6:g} million of 0.1 mm")
    print(f"  gas velocity   {chosen.velocity:g} m/s, gas step at most {chosen.gas_step:g} s, "
          f"exchange with the grains every {exchange:g} s")
    print(f"  spring         {chosen.spring:g} N/m (paper: 50), contact time {duration:.3g} s, "
          f"step {step:.4g} s = contact time / {duration / step:.1f}")
    print(f"  time           {chosen.time:g} s with gas, averaged from {chosen.start_up:g} s")
    print(f"  ranks          {chosen.ranks}")
    print(f"  results        {out}")
    (out / "gas.toml").write_text(case_text(chosen, exchange))
    (out / "bed.in").write_text((HERE / "bed.in").read_text())
    left, right, low, high = (1e-3 * value for value in chosen.tubes)
    sampling = max(1, round(ROW / 5 / step))
    return pieces.Job(out, "bed.in", {
        "l": chosen.grain, "count": count, "k": chosen.spring, "e": chosen.restitution,
        "mu": chosen.friction, "dt": step, "time": chosen.time, "left": left, "right": right,
        "low": low, "high": high,
        "rows": 5, "sampling": sampling, "points": 5 * sampling * round(0.05 / ROW),
        "case": "gas.toml", "out": ".",
    }, packing=("l", "count", "k", "e", "mu", "dt", "left", "right", "low", "high"))


def main():
    chosen = given_options()
    out = common.results_directory(chosen.out, "fluidized_bed_tubes")
    job = make_job(chosen, out)
    pieces.run_piece(job, chosen)
    quantities = common.complete_summary(
        out, lambda summary: add_experiment(summary, chosen.velocity))
    pieces.add_provenance(job, chosen, {"case": CASES.get(chosen.velocity, "1"), "paper_l": 5,
                                        "gas_cell": 1e-3 * chosen.cell})
    print_comparison(quantities)
    if chosen.no_pictures:
        return
    plot.draw(out, out / "result.png", chosen.start_up, chosen.tubes)
    plot.draw_tubes_closely(out, out / "tubes.png", chosen.start_up, chosen.tubes)
    plot.animate(out, out / "bed.gif", chosen.tubes)
    print(f"\npictures  {out}/result.png, tubes.png, bed.gif (tubes: gas around them, their loads)")
    print(f"fields    {out}/*.xdmf (open in ParaView)")
    print(f"loads     {out}/loads.csv: forces of the grains on tubes and walls; probe_tube*.csv: of the gas")
    print(f"summary   {out / 'summary.json'}")


if __name__ == "__main__":
    main()
