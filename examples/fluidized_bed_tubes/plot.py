"""Pictures of the bed: grains in section, void fraction, series; gas and loads at the tubes."""

import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import frames  # noqa: E402
import numpy  # noqa: E402
import pictures  # noqa: E402
from pictures import MM, pyplot  # noqa: E402

import common  # noqa: E402

WIDTH, DEPTH, SHOWN_HEIGHT = 0.05, 0.01, 0.15  # m
TUBES = (15, 35, 20, 40)  # left, right, low, high axes, mm
TUBE_RADIUS = 0.005  # m
TUBE_NAMES = ("lower left", "lower right", "upper left", "upper right")


def tube_axes(tubes):
    """(x, z) of the four axes, m, in the order of the bodies tube1 to tube4."""
    left, right, low, high = (1e-3 * value for value in tubes)
    return [(left, low), (right, low), (left, high), (right, high)]


def mark_tubes(axes, tubes):
    for x, z in tube_axes(tubes):
        axes.add_patch(pyplot.Circle((MM * x, MM * z), MM * TUBE_RADIUS, facecolor="0.75",
                                     edgecolor="0.3", linewidth=0.8, zorder=3))


def draw_grains(axes, grains, tubes):
    """Grains whose centre lies in the front half of the depth."""
    circles = pictures.grains_in_section(axes, grains, (0, DEPTH / 2), grains["velocity"][:, 2],
                                         (-0.4, 0.4), "coolwarm")
    mark_tubes(axes, tubes)
    pictures.frame_section(axes, (0, WIDTH), (0, SHOWN_HEIGHT), None)
    return circles


def draw_void_fraction(axes, gas, tubes):
    """Mean over the depth; the line marks 0.8, the surface of bubbles and bed."""
    void = gas["void_fraction"].mean(axis=1)
    height = void.shape[0] * WIDTH / void.shape[1]
    picture = pictures.void_fraction_in_section(axes, void, (0, WIDTH, 0, height))
    mark_tubes(axes, tubes)
    pictures.frame_section(axes, (0, WIDTH), (0, SHOWN_HEIGHT), None)
    return picture


def draw(directory, picture, start, tubes):
    """Writes `picture` (PNG) from the results in `directory`; `start` of the means in s."""
    series = frames.read_time_series(directory)
    summary = common.read_summary(directory)
    last_time, gas_file = frames.frame_files(directory, "gas")[-1]
    _, grain_file = frames.frame_files(directory, "grains")[-1]
    height = summary["bed_height_mean"]
    pressure = summary["pressure_drop_mean"]
    balance = summary["pressure_drop_force_balance"]

    figure = pyplot.figure(figsize=(11, 6.4), layout="constrained")
    grid = figure.add_gridspec(2, 4, width_ratios=[1, 1, 0.08, 1.9])
    grains_axes = figure.add_subplot(grid[:, 0])
    void_axes = figure.add_subplot(grid[:, 1], sharey=grains_axes)
    pressure_axes = figure.add_subplot(grid[0, 3])
    height_axes = figure.add_subplot(grid[1, 3], sharex=pressure_axes)

    circles = draw_grains(grains_axes, frames.read_frame(grain_file), tubes)
    grains_axes.set(title=f"grains, t = {last_time:.2f} s", ylabel="z / mm")
    void = draw_void_fraction(void_axes, frames.read_frame(gas_file), tubes)
    void_axes.set_title("void fraction")
    void_axes.tick_params(labelleft=False)
    figure.colorbar(circles, ax=grains_axes, location="bottom", label="vertical velocity / (m/s)")
    figure.colorbar(void, ax=void_axes, location="bottom", label="mean over the depth")

    pictures.series_with_mean(pressure_axes, series, "pressure_drop", pressure["value"],
                (balance["value"], "weight and buried tubes"), start, 1.0)
    pressure_axes.set(ylabel="pressure drop / Pa")
    pictures.series_with_mean(height_axes, series, "bed_height", height["value"],
                (height["reference"], "experiment"), start, MM)
    height_axes.set(ylabel="bed height / mm", xlabel="time with gas / s")
    figure.savefig(picture, dpi=130)
    pyplot.close(figure)


def read_loads(directory):
    """loads.csv: column -> array. Of a time that two pieces of a run wrote, the later row."""
    with open(pathlib.Path(directory) / "loads.csv", newline="", encoding="ascii") as file:
        rows = list(csv.reader(file))
    names = rows[0]
    by_time = {float(row[0]): [float(value) for value in row] for row in rows
               if len(row) == len(names) and row[0] != names[0]}
    table = numpy.array([by_time[time] for time in sorted(by_time)])
    return dict(zip(names, table.T))


def mean_gas_force(directory, number, start):
    """Horizontal and vertical force of the gas on a tube, mN."""
    table = frames.read_table(pathlib.Path(directory) / f"probe_tube{number}.csv")
    late = table["time_s"] >= start
    return [1e3 * sum(table[f"{kind}_force_{axis}_N"][late].mean()
                      for kind in ("pressure", "friction")) for axis in "xz"]


def draw_tubes_closely(directory, picture, start, tubes):
    """Mean gas flow around the tubes and the forces on them."""
    void, flux = frames.mean_gas(directory, start)
    loads = read_loads(directory)
    layers, columns = void.shape
    cell = WIDTH / columns
    top = max(z for _, z in tube_axes(tubes)) + 0.02
    figure, (flow, mean_axes, axes) = pyplot.subplots(
        1, 3, figsize=(12, 4.6), layout="constrained", width_ratios=[1.1, 0.8, 1.5])
    image = pictures.void_fraction_in_section(flow, void, (0, WIDTH, 0, layers * cell), "0.3")
    x, z = MM * cell * (numpy.arange(columns) + 0.5), MM * cell * (numpy.arange(layers) + 0.5)
    shown = z < MM * top
    flow.streamplot(x, z[shown], flux[shown, :, 0], flux[shown, :, 1], color="white",
                    linewidth=0.7, density=1.2, arrowsize=0.7)
    mark_tubes(flow, tubes)
    pictures.frame_section(flow, (0, WIDTH), (0, top), "mean gas flow")
    flow.set_ylabel("z / mm")
    figure.colorbar(image, ax=flow, location="bottom", label="mean void fraction")

    late = loads["time"] >= start
    window = max(1, round(0.02 / numpy.median(numpy.diff(loads["time"]))))
    for number, name in enumerate(TUBE_NAMES, 1):
        force = {axis: 1e3 * loads[f"tube{number}_{axis}"] for axis in "xz"}
        means = [force[axis][late].mean() for axis in "xz"]
        spread = [force[axis][late].std() for axis in "xz"]
        bars = mean_axes.errorbar(*means, xerr=spread[0], yerr=spread[1], fmt="o", capsize=2,
                                  label=name)
        mean_axes.plot(*mean_gas_force(directory, number, start), marker="D", markersize=5,
                       color=bars[0].get_color(), markerfacecolor="none", linestyle="")
        smooth = numpy.convolve(force["z"], numpy.ones(window) / window, mode="valid")
        axes.plot(loads["time"][window // 2:][:len(smooth)], smooth, linewidth=0.8, label=name)
    mean_axes.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    mean_axes.axvline(0, color="0.6", linewidth=0.6, zorder=0)
    mean_axes.set(xlabel="horizontal / mN", ylabel="vertical / mN",
                  title="mean forces: grains with\nstandard deviation, gas (open)")
    axes.set(xlabel="time with gas / s", ylabel="vertical / mN",
             title="vertical force of the grains, means over 20 ms")
    axes.axvspan(start, loads["time"][-1], color="0.95", zorder=0)
    axes.legend(frameon=False, fontsize=8)
    figure.savefig(picture, dpi=130)
    pyplot.close(figure)


def animate(directory, path, tubes, most=80):
    """Grains and void fraction over time."""
    gas, grains = (frames.frame_files(directory, name) for name in ("gas", "grains"))
    chosen = numpy.unique(numpy.linspace(0, len(gas) - 1, min(most, len(gas))).astype(int))
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(5, 6), sharey=True,
                                            layout="constrained")

    def draw_frame(number):
        for axes in (left, right):
            axes.clear()
        time, gas_file = gas[chosen[number]]
        draw_grains(left, frames.read_frame(grains[chosen[number]][1]), tubes)
        draw_void_fraction(right, frames.read_frame(gas_file), tubes)
        left.set(title=f"grains, t = {time:.2f} s", ylabel="z / mm")
        right.set_title("void fraction")

    pictures.animate(path, figure, len(chosen), draw_frame)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: plot.py DIRECTORY PICTURE.png START_OF_MEANS")
    draw(sys.argv[1], sys.argv[2], float(sys.argv[3]), TUBES)
