"""Fluidized bed with four inserted tubes (Mori, Wu, Sakai 2019, case 1)"""

import argparse
import math
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import common  # noqa: E402
import plot  # noqa: E402

ORIGINAL_COUNT = 250_000 * 5**3  # the paper: 250 000 grains of ratio 5
ORIGINAL_RADIUS = 50e-6  # m
DENSITY = 2500.0  # kg/m^3
RESTITUTION = 0.9
START_UP = 0.3  # s: the packed bed rises as a plug before it bubbles
MEASURED_HEIGHT = {0.2: 0.0917, 0.3: 0.0949}  # gas velocity in m/s -> bed height in m


def contact_time(spring):
    """Duration of a contact of two original particles, s (half period of the damped spring)."""
    mass = DENSITY * 4 / 3 * math.pi * ORIGINAL_RADIUS**3
    damping_ratio = -math.log(RESTITUTION) / math.hypot(math.pi, math.log(RESTITUTION))
    return math.pi * math.sqrt(mass / 2 / spring) / math.sqrt(1 - damping_ratio**2)


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


def options():
    parser = argparse.ArgumentParser(prog="examples/run fluidized_bed_tubes", description=__doc__)
    parser.add_argument("--grain", type=float, default=10, metavar="L",
                        help="coarse-grain ratio l; the paper takes 5 (default %(default)g)")
    parser.add_argument("--velocity", type=float, default=0.2, metavar="U",
                        help="superficial gas velocity, m/s; the paper takes 0.2 and 0.3 (default %(default)g)")
    parser.add_argument("--time", type=float, default=0.8, metavar="T",
                        help="simulated time with gas, s; means leave out the first 0.3 s (default %(default)g)")
    parser.add_argument("--spring", type=float, default=0.25, metavar="K",
                        help="spring constant of the original particle, N/m; the paper takes 50 (default %(default)g)")
    parser.add_argument("--gas-step", type=float, default=1e-4, metavar="S",
                        help="largest gas step, s (default %(default)g)")
    parser.add_argument("--ranks", type=int, default=os.cpu_count(), metavar="N",
                        help="MPI ranks (default: all cores, here %(default)s)")
    parser.add_argument("--out", default=str(common.ROOT / "out" / "fluidized_bed_tubes"), metavar="DIR",
                        help="directory for the results (default out/fluidized_bed_tubes)")
    chosen = parser.parse_args()
    for name, lowest in (("grain", 1), ("velocity", 0), ("ranks", 1)):
        if not getattr(chosen, name) >= lowest:
            parser.error(f"--{name} is {getattr(chosen, name):g}, but must be at least {lowest}")
    for name in ("time", "spring", "gas_step"):
        if not getattr(chosen, name) > 0:
            parser.error(f"--{name.replace('_', '-')} is {getattr(chosen, name):g}, but must be positive")
    if chosen.grain > 25:
        parser.error(f"--grain is {chosen.grain:g}: grains above 2.5 mm (l = 25) do not fit between tubes and walls")
    return chosen


def main():
    chosen = options()
    out = pathlib.Path(chosen.out).resolve()
    out.mkdir(parents=True, exist_ok=True)
    for old in ("summary.json", "result.png"):
        (out / old).unlink(missing_ok=True)

    duration = contact_time(chosen.spring)
    exchange = 2 * chosen.gas_step
    step = exchange / math.ceil(exchange / (duration / 8))  # whole steps between exchanges
    count = round(ORIGINAL_COUNT / chosen.grain**3)
    start = min(START_UP, 0.5 * chosen.time)
    print("Fluidized bed with four tubes, 50 x 10 x 200 mm, gas cells of 1.25 mm")
    print(f"  grains         {count} of {2e3 * ORIGINAL_RADIUS * chosen.grain:g} mm "
          f"(l = {chosen.grain:g}) for {ORIGINAL_COUNT / 1e6:g} million of 0.1 mm")
    print(f"  gas velocity   {chosen.velocity:g} m/s, "
          f"gas step at most {chosen.gas_step:g} s, exchange with the grains every {exchange:g} s")
    print(f"  spring         {chosen.spring:g} N/m (paper: 50), contact time {duration:.3g} s, "
          f"step {step:.4g} s = contact time / {duration / step:.1f}")
    print(f"  time           {chosen.time:g} s with gas, averaged from {start:g} to {chosen.time:g} s")
    print(f"  ranks          {chosen.ranks}")
    print(f"  results        {out}\n")

    case = (HERE / "gas.toml").read_text()
    for key, value in (("superficial_velocity", chosen.velocity), ("exchange_interval", exchange),
                       ("largest_step", chosen.gas_step), ("average_from", start)):
        case = common.set_key(case, key, value)
    (out / "gas.toml").write_text(case)
    (out / "bed.in").write_text((HERE / "bed.in").read_text())

    common.run_gasgrain(out, "bed.in", chosen.ranks, {
        "l": chosen.grain, "count": count, "k": chosen.spring, "dt": step, "time": chosen.time,
        "case": "gas.toml", "out": ".",
    })
    quantities = common.complete_summary(
        out, lambda summary: add_experiment(summary, chosen.velocity))
    print_comparison(quantities)
    plot.draw(out, out / "result.png", start)
    print(f"\npicture   {out / 'result.png'}")
    print(f"fields    {out}/*.xdmf (open in ParaView)")
    print(f"summary   {out / 'summary.json'}")


if __name__ == "__main__":
    main()
