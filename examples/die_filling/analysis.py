"""What the frames and the time series of a die filling say: heights, pressure, splashes.

Heights come from the grains: a packing of uniform density that fills a straight vessel to h has its
centre of mass at h/2, so the height in the shoe is twice the mean height of its grains above its
floor, and does not depend on how the void fraction is smoothed. The height in the die is the volume
of the grains in it over that of 25 mm packed as densely as the shoe was at the start.

Splash: gas bursts through the surface and throws grains up. While a shoe empties in peace the upper
edge of the grains only sinks, whatever shape the surface takes; so a splash is a time in which the
upper edge, the height above which EDGE_SHARE of all grains lie, is more than RISE above the lowest
value it had before. Two peaks are two splashes when the rise falls below half of the lower one in
between. The time of a splash is that of its peak.
"""

import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import frames  # noqa: E402
import numpy  # noqa: E402

import common  # noqa: E402

DIE_HEIGHT = 0.025  # m; the floor of the shoe lies there
DIE_AREA, SHOE_AREA = 0.05 * 0.025, math.pi * 0.025**2  # m^2
EDGE_SHARE = 1e-3
RISE = 2e-3  # m
FULL = 0.99  # share of the final content at which the die is called full
COLUMNS = ("time", "shoe_height", "shoe_surface", "die_height", "die_share", "die_pressure",
           "upper_edge", "highest_grain")

# Expected of each case: number of splashes and their times (s), from verification.md.
EXPECTED = {"2-1": (1, (0.5,)), "2-2": (0, ()), "3-1": (2, (0.7, 0.85)), "3-2": (0, ())}
START_HEIGHT = {"2-1": 0.04, "2-2": 0.12, "3-1": 0.04, "3-2": 0.12}  # m


def solid_fraction_of_start(grains):
    """Of the packing in the shoe before the gate opens."""
    volume = (4 / 3 * math.pi * grains["radius"] ** 3).sum()
    return volume / (SHOE_AREA * 2 * (grains["position"][:, 2] - DIE_HEIGHT).mean())


def measure(grains, surface, packed):
    """The row of one frame but for time and pressure. `surface`: bed height above the floor, m."""
    z = grains["position"][:, 2]
    above = z >= DIE_HEIGHT
    volume = 4 / 3 * math.pi * grains["radius"] ** 3
    in_die = volume[~above].sum()
    return {
        "shoe_height": 2 * (z[above] - DIE_HEIGHT).mean(),
        "shoe_surface": surface - DIE_HEIGHT,
        "die_height": in_die / (packed * DIE_AREA),
        "die_share": in_die / volume.sum(),
        "upper_edge": numpy.quantile(z, 1 - EDGE_SHARE) - DIE_HEIGHT,
        "highest_grain": z.max() - DIE_HEIGHT,
    }


def curves(directory):
    """Columns COLUMNS at the times of the frames, and the packed solid fraction of the start."""
    series = frames.read_time_series(directory)
    packed, rows = None, []
    for time, file in frames.frame_files(directory, "grains"):
        grains = frames.read_frame(file)
        packed = packed or solid_fraction_of_start(grains)
        surface = numpy.interp(time, series["time"], series["bed_height"])
        pressure = numpy.interp(time, series["time"], series["pressure_drop"])
        rows.append({"time": time, "die_pressure": pressure, **measure(grains, surface, packed)})
    return {name: numpy.array([row[name] for row in rows]) for name in COLUMNS}, packed


def rise(upper_edge):
    """Of the upper edge above its lowest value so far."""
    return upper_edge - numpy.minimum.accumulate(upper_edge)


def splashes(time, upper_edge):
    """Times of the splashes, s."""
    height = rise(upper_edge)
    peaks = [i for i in range(1, len(height) - 1)
             if height[i] > RISE and height[i] >= height[i - 1] and height[i] > height[i + 1]]
    kept = []
    for peak in peaks:
        if kept and height[kept[-1]:peak].min() > 0.5 * min(height[kept[-1]], height[peak]):
            if height[peak] > height[kept[-1]]:
                kept[-1] = peak
        else:
            kept.append(peak)
    return [float(time[peak]) for peak in kept]


def write_curves(path, table):
    with open(path, "w", newline="", encoding="ascii") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for row in zip(*(table[name] for name in COLUMNS)):
            writer.writerow([f"{value:.7g}" for value in row])


def time_full(table):
    """First time at which the die holds FULL of what it holds at the end, s."""
    share = table["die_share"]
    return float(table["time"][numpy.argmax(share >= FULL * share[-1])])


def plateau(series):
    """Begin and end (s) and mean (Pa) of the longest time in which the pressure below the shoe
    stays within 10 % of its middle value and above half of its largest, of means over 20 ms. Once
    the die is full it rests near zero."""
    width = max(1, round(0.02 / numpy.median(numpy.diff(series["time"]))))
    pressure = numpy.convolve(series["pressure_drop"], numpy.ones(width) / width, mode="valid")
    time = series["time"][width // 2:][:len(pressure)]
    best, first = (0, 0), 0
    for last in range(len(pressure)):
        if pressure[last] < 0.5 * pressure.max():
            first = last + 1
            continue
        while numpy.ptp(pressure[first:last + 1]) > 0.1 * (pressure[first:last + 1].max()
                                                           + pressure[first:last + 1].min()):
            first += 1
            if first > last:
                break
        if time[last] - time[min(first, last)] > time[best[1]] - time[best[0]]:
            best = (first, last)
    return time[best[0]], time[best[1]], float(pressure[best[0]:best[1] + 1].mean())


def quantity(name, value, unit, reference=None, tolerance=None, source=""):
    """A quantity of summary.json; `tolerance` is absolute here, relative there."""
    relative = tolerance / abs(reference) if tolerance is not None and reference else tolerance
    return {"name": name, "value": float(value), "unit": unit, "reference": reference,
            "tolerance": relative, "source": source}


def quantities(case, table, series, packed):
    count, times = EXPECTED[case]
    found = splashes(table["time"], table["upper_edge"])
    paper = "Mori, Wu, Sakai, Powder Technology, 2019"
    final = START_HEIGHT[case] - DIE_AREA * DIE_HEIGHT / SHOE_AREA
    last = slice(-5, None)
    begin, end, level = plateau(series)
    rows = [
        quantity("start_height", table["shoe_height"][0], "m", START_HEIGHT[case], 1e-3, paper),
        quantity("start_solid_fraction", packed, "-"),
        quantity("final_shoe_height", table["shoe_height"][last].mean(), "m", final, 1e-3,
                 "volume of the shoe at equal packing"),
        quantity("final_shoe_surface", table["shoe_surface"][last].mean(), "m", None, None,
                 "highest crossing of 0.8"),
        quantity("final_die_height", table["die_height"][last].mean(), "m", DIE_HEIGHT, 1e-3,
                 "filled as densely as the shoe was"),
        quantity("die_full_time", time_full(table), "s", 0.6 if case == "2-1" else None,
                 0.1 if case == "2-1" else None, paper if case == "2-1" else ""),
        quantity("splash_count", len(found), "-", count, 0.0, paper),
        quantity("largest_rise", rise(table["upper_edge"]).max(), "m"),
        quantity("largest_die_pressure", series["pressure_drop"].max(), "Pa"),
        quantity("plateau_begin", begin, "s", 0.2 if case == "3-1" else None,
                 0.1 if case == "3-1" else None, paper if case == "3-1" else ""),
        quantity("plateau_end", end, "s", 0.6 if case == "3-1" else None,
                 0.1 if case == "3-1" else None, paper if case == "3-1" else ""),
        quantity("plateau_pressure", level, "Pa"),
    ]
    for number, time in enumerate(found, 1):
        expected = times[number - 1] if number <= len(times) else None
        rows.append(quantity(f"splash_{number}_time", time, "s", expected,
                             0.1 if expected else None, paper))
    return rows


def analyse(directory, case):
    """Writes filling.csv and completes summary.json; returns the curves."""
    table, packed = curves(directory)
    series = frames.read_time_series(directory)
    write_curves(directory / "filling.csv", table)
    common.add_quantities(directory, quantities(case, table, series, packed))
    return table


def print_comparison(summary):
    print(f"\n{'quantity':<34}{'here':>10}{'reference':>11}")
    rows = (("height in the shoe at the start / mm", "start_height", 1e3),
            ("final height in the shoe / mm", "final_shoe_height", 1e3),
            ("final height in the die / mm", "final_die_height", 1e3),
            ("die full / s", "die_full_time", 1),
            ("splashes", "splash_count", 1),
            ("first splash / s", "splash_1_time", 1),
            ("second splash / s", "splash_2_time", 1),
            ("pressure constant from / s", "plateau_begin", 1),
            ("                    to / s", "plateau_end", 1),
            ("                    at / Pa", "plateau_pressure", 1))
    for label, name, scale in rows:
        if name in summary:
            row = summary[name]
            reference = "" if row["reference"] is None else f"{scale * row['reference']:.4g}"
            print(f"{label:<34}{scale * row['value']:>10.4g}{reference:>11}")
