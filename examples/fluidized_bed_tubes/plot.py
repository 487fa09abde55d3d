"""Picture of the bed: grains in section, void fraction, bed height and pressure drop over time."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import frames  # noqa: E402
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402
import numpy  # noqa: E402

import common  # noqa: E402

WIDTH, DEPTH, SHOWN_HEIGHT = 0.05, 0.01, 0.15  # m
TUBES = [(0.015, 0.020), (0.035, 0.020), (0.015, 0.040), (0.035, 0.040)]  # x, z in m
TUBE_RADIUS = 0.005  # m


def draw_tubes(axes):
    for x, z in TUBES:
        axes.add_patch(pyplot.Circle((1e3 * x, 1e3 * z), 1e3 * TUBE_RADIUS, facecolor="0.75",
                                     edgecolor="0.3", linewidth=0.8, zorder=3))


def frame_axes(axes, title):
    axes.set(xlim=(0, 1e3 * WIDTH), ylim=(0, 1e3 * SHOWN_HEIGHT), aspect="equal", title=title,
             xlabel="x / mm")
    axes.tick_params(length=2)


def draw_grains(axes, grains):
    """Grains whose centre lies in the front half of the depth, painted from back to front."""
    position, velocity, radius = grains["position"], grains["velocity"], grains["radius"]
    order = numpy.argsort(-position[:, 1])
    order = order[position[order, 1] < DEPTH / 2]
    circles = matplotlib.collections.EllipseCollection(
        2e3 * radius[order], 2e3 * radius[order], numpy.zeros(len(order)), units="xy",
        offsets=1e3 * position[order][:, [0, 2]], transOffset=axes.transData,
        array=velocity[order, 2], cmap="coolwarm", edgecolors="0.25", linewidths=0.1)
    circles.set_clim(-0.4, 0.4)
    axes.add_collection(circles)
    draw_tubes(axes)
    return circles


def draw_void_fraction(axes, gas):
    """Mean over the depth; the line marks 0.8, the surface of bubbles and bed."""
    void = gas["void_fraction"].mean(axis=1)
    height = void.shape[0] * WIDTH / void.shape[1]
    extent = (0, 1e3 * WIDTH, 0, 1e3 * height)
    picture = axes.imshow(void, origin="lower", extent=extent, cmap="viridis", vmin=0.4, vmax=1.0,
                          interpolation="nearest")
    axes.contour(void, levels=[0.8], extent=extent, origin="lower", colors="white", linewidths=0.8)
    draw_tubes(axes)
    return picture


def draw_series(axes, series, column, mean, reference, start, scale):
    time = series["time"]
    axes.axvspan(start, time[-1], color="0.93", zorder=0)
    axes.plot(time, scale * series[column], color="C0", linewidth=0.9)
    # The first instants press the bed against nothing yet; what follows sets the range.
    top = 1.25 * numpy.nanmax(series[column][time > 0.25 * start])
    axes.set_ylim(0, scale * top)
    if mean:
        axes.plot([start, time[-1]], [scale * mean] * 2, color="C3", linewidth=1.4,
                  label=f"mean {scale * mean:.4g}")
    value, text = reference
    if value:
        axes.axhline(scale * value, color="0.2", linewidth=1, linestyle="--",
                     label=f"{text} {scale * value:.4g}")
    axes.set_xlim(0, time[-1])
    axes.legend(loc="best", frameon=False, fontsize=8)


def draw(directory, picture, start):
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

    circles = draw_grains(grains_axes, frames.read_frame(grain_file))
    frame_axes(grains_axes, f"grains, t = {last_time:.2f} s")
    grains_axes.set_ylabel("z / mm")
    void = draw_void_fraction(void_axes, frames.read_frame(gas_file))
    frame_axes(void_axes, "void fraction")
    void_axes.tick_params(labelleft=False)
    figure.colorbar(circles, ax=grains_axes, location="bottom", label="vertical velocity / (m/s)")
    figure.colorbar(void, ax=void_axes, location="bottom", label="mean over the depth")

    draw_series(pressure_axes, series, "pressure_drop", pressure["value"],
                (balance["value"], "weight and buried tubes"), start, 1.0)
    pressure_axes.set(ylabel="pressure drop / Pa")
    draw_series(height_axes, series, "bed_height", height["value"],
                (height["reference"], "experiment"), start, 1e3)
    height_axes.set(ylabel="bed height / mm", xlabel="time with gas / s")
    figure.savefig(picture, dpi=130)
    pyplot.close(figure)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: plot.py DIRECTORY PICTURE.png START_OF_MEANS")
    draw(sys.argv[1], sys.argv[2], float(sys.argv[3]))
