"""Rotating drum with lifters from an STL file, torque and mixing measured"""

import math
import pathlib
import subprocess
import sys

import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import common  # noqa: E402
import drum_stl  # noqa: E402
import mixing  # noqa: E402
import options  # noqa: E402
import plot  # noqa: E402
import text_dump  # noqa: E402

RADIUS, DENSITY = 1e-3, 2500.0  # of a grain: m, kg/m^3
SPRING, STEP = 500.0, 4e-5  # N/m, s
START = 0.3  # s: the drum begins to turn
AVERAGE_FROM = 0.8  # s: the grains have found their slope


def given_options():
    parser = options.parser_of("rotating_drum", __doc__)
    options.add_count(parser, 6000)
    options.add_number(parser, "--speed", "RPM", "revolutions per minute", 60)
    options.add_number(parser, "--time", "T",
                       f"simulated time, s; the drum turns from {START} s on", 2.3)
    options.add_run(parser, "rotating_drum")
    chosen = parser.parse_args()
    if not 1 <= chosen.grains <= 9000:
        parser.error(f"--grains is {chosen.grains}, but must be 1 to 9000: more do not fit loosely")
    if not chosen.time > AVERAGE_FROM:
        parser.error(f"--time is {chosen.time:g}, but must exceed {AVERAGE_FROM} s")
    return chosen


def sample_drum(out):
    triangles = drum_stl.write(out / "drum.stl")
    print(f"  drum           {2e3 * drum_stl.RADIUS:g} x {1e3 * drum_stl.LENGTH:g} mm, "
          f"{drum_stl.LIFTERS} lifters, {triangles} triangles")
    inside = drum_stl.RADIUS + 2.5e-3
    command = [common.binary("gasgrain-sdf"), "--stl", "drum.stl", "--complement",
               "--spacing", "0.4e-3", "--lower", f"{-inside}", "-0.003", f"{-inside}",
               "--upper", f"{inside}", f"{drum_stl.LENGTH + 0.003}", f"{inside}",
               "--allow-cut", "--margin", "0", "--band", "1.2e-3", "-o", "drum.h5"]
    done = subprocess.run(command, cwd=out, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, env=common.mpi_environment(1))
    (out / "drum_sdf.txt").write_text(done.stdout)
    if done.returncode != 0:
        common.fail(f"gasgrain-sdf failed:\n{done.stdout}")


def summary(series, indices):
    steady = series["time"] >= AVERAGE_FROM
    torque, moment = series["torque"][steady].mean(), series["weight_moment"][steady].mean()

    return [
        common.quantity("torque_mean", torque, "N m", reference=float(moment), tolerance=0.05,
                 source="moment of the weight of the grains about the axis, mean over time"),
        common.quantity("mixing_index_end", indices[-1][1], "-"),
        common.quantity("grains_end", series["grains"][-1], "-", reference=float(series["grains"][0]),
                 tolerance=0.0, source="no grain may be lost"),
    ]


def main():
    chosen = given_options()
    out = common.fresh_directory(chosen.out)
    rate = 2 * math.pi * chosen.speed / 60
    print("Rotating drum with lifters, walls from an STL file")
    print(f"  grains         {chosen.grains} of {2e3 * RADIUS:g} mm")
    print(f"  speed          {chosen.speed:g} per minute, Froude number "
          f"{rate**2 * drum_stl.RADIUS / 9.81:.2f}")
    print(f"  time           {chosen.time:g} s, turning from {START} s on, means from {AVERAGE_FROM} s on")
    print(f"  ranks          {chosen.ranks}")
    print(f"  results        {out}")
    sample_drum(out)
    print("\nabout a minute on two cores ...", flush=True)

    case = (HERE / "drum.toml").read_text().replace("rate = 6.2832", f"rate = {rate:.10g}")
    (out / "drum.toml").write_text(case)
    (out / "drum.in").write_text((HERE / "drum.in").read_text())
    common.run_gasgrain(out, "drum.in", chosen.ranks, {"count": chosen.grains, "time": chosen.time})

    series = text_dump.read_table(out / "series.csv")
    frames = [(step * STEP, frame) for step, frame in text_dump.read_dump(out / "grains.dump")]
    start = min(frames, key=lambda frame: abs(frame[0] - START))[1]
    left = (start["x"] < numpy.median(start["x"])).astype(float)
    indices = [(time, mixing.index(frame, left, 10 * RADIUS)) for time, frame in frames
               if time >= START - 1e-9]
    quantities = common.write_summary(out, "rotating_drum", summary(series, indices))
    common.print_quantities(quantities)
    plot.draw(out / "result.png", frames, left, series, indices, rate)
    print(f"\npicture   {out / 'result.png'}")
    print(f"summary   {out / 'summary.json'}")


if __name__ == "__main__":
    main()
