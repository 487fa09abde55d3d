"""Die filling from a stationary shoe (Mori, Wu, Sakai 2019, cases 2-1, 2-2, 3-1, 3-2)"""

import dataclasses
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

LOOSE = 0.26  # solid fraction from which the grains fall into a packing
SHOE_AREA = math.pi * 0.025**2  # m^2


@dataclasses.dataclass(frozen=True)
class Powder:
    name: str
    radius: float  # of the original particle, m
    density: float  # kg/m^3
    spring: float  # of the paper, N/m
    ratio: float  # l of the paper
    cheap_spring: float  # N/m, for twice the ratio


@dataclasses.dataclass(frozen=True)
class Case:
    powder: Powder
    height: float  # in the shoe at the start, m
    grains: int  # at the paper's ratio
    top: float  # of the gas grid, m
    settle: float  # s
    time: float  # after the gate opened, s


# CP-102: table 3 of the paper (its text says 50 N/m). The spring of NONPAREIL is that text's.
CP102 = Powder("CP-102", 90e-6, 1516.0, 100.0, 5, 2.0)
NONPAREIL = Powder("NONPAREIL", 50e-6, 1483.0, 50.0, 10, 0.5)
CASES = {
    "2-1": Case(CP102, 0.04, 120_941, 0.1, 0.2, 0.8),
    "2-2": Case(CP102, 0.12, 362_821, 0.18, 0.35, 1.2),
    "3-1": Case(NONPAREIL, 0.04, 88_898, 0.1, 0.2, 1.2),
    "3-2": Case(NONPAREIL, 0.12, 266_693, 0.18, 0.35, 1.6),
}


def given_options():
    parser = options.parser_of("die_filling", __doc__)
    parser.add_argument("--case", choices=CASES, default="2-1",
                        help="2-1, 2-2: CP-102, 40 and 120 mm in the shoe; 3-1, 3-2: NONPAREIL "
                             "(default %(default)s)")
    parser.add_argument("--paper", action="store_true",
                        help="grains, spring and 1.25 mm cells as in the paper (hours); else twice"
                             " its l")
    options.add_grains(parser, ("", "twice the paper's"), ("", "2; 0.5 in cases 3-1 and 3-2"))
    options.add_number(parser, "--time", "T", "simulated time after the gate opened, s",
                       "0.8 to 1.6, by case")
    options.add_number(parser, "--gas-step", "S", "largest gas step, s", "1e-4; 5e-5 with --paper")
    options.add_number(parser, "--cell", "MM", "cell of the gas, mm", "2.5")
    # The paper does not print them: those of the fluidized bed.
    options.add_closures(parser, friction=0.3, restitution=0.9)
    options.add_pieces(parser, "die_filling_CASE")
    chosen = parser.parse_args()
    case = CASES[chosen.case]
    powder = case.powder
    options.fill_in(chosen, {"time": case.time})
    options.fill_in(chosen, {"grain": powder.ratio, "spring": powder.spring, "cell": 1.25,
                             "gas_step": 5e-5} if chosen.paper else
                    {"grain": 2 * powder.ratio, "spring": powder.cheap_spring, "cell": 2.5,
                     "gas_step": 1e-4})
    options.require(parser, chosen, {"grain": 1, "ranks": 1, "time": 0, "spring": 0, "gas_step": 0,
                                     "cell": 0, "hours": 0})
    options.require_restitution(parser, chosen)
    if 2 * powder.radius * chosen.grain > 3e-3:
        parser.error(f"--grain is {chosen.grain:g}: grains above 3 mm do not fit a die of 25 mm")
    return chosen


def case_text(case, chosen, exchange):
    """The case file with what was chosen."""
    text = (HERE / "gas.toml").read_text()
    cells = [round(1e3 * length / chosen.cell) for length in (0.05, 0.05, case.top)]
    for old, new in (("upper = [0.025, 0.025, 0.1]", f"upper = [0.025, 0.025, {case.top:g}]"),
                     ("cells = [20, 20, 40]", f"cells = {cells}"),
                     ('drag = "gidaspow"', f'drag = "{chosen.drag}"')):
        text = common.set_text(text, old, new)
    text = common.set_mapping(common.set_kernel(text, chosen.kernel), chosen.mapping)
    text = common.set_key(text, "exchange_interval", exchange)
    return common.set_key(text, "largest_step", chosen.gas_step)


def make_job(case, chosen, out):
    """Writes script and case into `out`; prints what will be run."""
    powder = case.powder
    exchange = 2 * chosen.gas_step
    duration = grains.contact_time(powder.radius, powder.density, chosen.spring, chosen.restitution)
    step = grains.time_step(duration, exchange)
    original = case.grains * powder.ratio**3
    count = round(original / chosen.grain**3)
    solid = original * 4 / 3 * math.pi * powder.radius**3
    print(f"Die filling, case {chosen.case}: {1e3 * case.height:g} mm of {powder.name} above a die "
          f"of 50 x 25 x 25 mm, gas cells of {chosen.cell:g} mm")
    print(f"  grains         {count} of {2e3 * powder.radius * chosen.grain:g} mm (l = {chosen.grain:g}) "
          f"for {original / 1e6:.3g} million of {2e3 * powder.radius:g} mm")
    print(f"  gas            step at most {chosen.gas_step:g} s, exchange every {exchange:g} s")
    print(f"  spring         {chosen.spring:g} N/m (paper: {powder.spring:g}), contact time "
          f"{duration:.3g} s, step {step:.4g} s = contact time / {duration / step:.1f}")
    print(f"  time           {chosen.time:g} s after the gate has opened")
    print(f"  ranks          {chosen.ranks}")
    print(f"  results        {out}")
    (out / "gas.toml").write_text(case_text(case, chosen, exchange))
    (out / "fill.in").write_text((HERE / "fill.in").read_text())
    return pieces.Job(out, "fill.in", {
        "l": chosen.grain, "count": count, "radius": powder.radius, "density": powder.density,
        "k": chosen.spring, "e": chosen.restitution, "mu": chosen.friction, "dt": step,
        "top": 0.025 + solid / SHOE_AREA / LOOSE, "settle": case.settle, "time": chosen.time,
        "points": round(0.05 / step), "case": "gas.toml", "out": ".",
    }, packing=("l", "count", "radius", "density", "k", "e", "mu", "dt", "top", "settle"))


def main():
    chosen = given_options()
    case = CASES[chosen.case]
    out = common.results_directory(chosen.out, f"die_filling_{chosen.case}")
    job = make_job(case, chosen, out)
    pieces.run_piece(job, chosen)
    table = analysis.analyse(out, chosen.case)
    pieces.add_provenance(job, chosen, {"case": chosen.case, "paper_l": case.powder.ratio,
                                        "gas_cell": 1e-3 * chosen.cell})
    analysis.print_comparison(common.read_summary(out))
    if chosen.no_pictures:
        return
    plot.draw(out, out / "result.png", table, powder_line(case, chosen))
    plot.animate(out, out / "filling.gif", table)
    print(f"\npictures  {out}/result.png, filling.gif")
    print(f"curves    {out}/filling.csv: heights, share in the die, pressure, ejected grains")
    print(f"fields    {out}/*.xdmf (open in ParaView)")
    print(f"summary   {out / 'summary.json'}")


def powder_line(case, chosen):
    return (f"Case {chosen.case}: {case.powder.name}, {1e3 * case.height:g} mm in the shoe, "
            f"l = {chosen.grain:g}")


if __name__ == "__main__":
    main()
