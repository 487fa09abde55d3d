"""Pictures of die filling: grains and void fraction in section at five times, and the curves."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import analysis  # noqa: E402
import frames  # noqa: E402
import numpy  # noqa: E402
import pictures  # noqa: E402
from pictures import MM, pyplot  # noqa: E402

RADIUS = 0.025  # of the shoe, and half the length of the die, m
SNAPSHOTS = 5
FASTEST = 0.5  # m/s, ends of the colour scale


def frame_axes(axes, top):
    """The section y = 0, in which shoe and die are equally wide; the line is where the gate was."""
    axes.axhline(MM * analysis.DIE_HEIGHT, color="0.3", linewidth=0.8, linestyle="--", zorder=3)
    pictures.frame_section(axes, (-RADIUS, RADIUS), (0, top), None)


def draw_grains(axes, grains, top):
    """Grains whose centre lies in a slab of four diameters about y = 0."""
    thickness = 4 * grains["radius"].max()
    circles = pictures.grains_in_section(axes, grains, (-thickness, thickness),
                                         grains["velocity"][:, 2], (-FASTEST, FASTEST), "coolwarm")
    frame_axes(axes, top)
    return circles


def draw_void_fraction(axes, gas, grid_top, top):
    """Mean of the two layers of cells at y = 0."""
    rows = gas["void_fraction"].shape[1]
    void = gas["void_fraction"][:, rows // 2 - 1:rows // 2 + 1].mean(axis=1)
    picture = pictures.void_fraction_in_section(axes, void, (-RADIUS, RADIUS, 0, grid_top))
    frame_axes(axes, top)
    return picture


def grid_top(gas):
    """Height of the grid, m: its cells are cubes."""
    return gas["void_fraction"].shape[0] * 2 * RADIUS / gas["void_fraction"].shape[2]


def draw_heights(axes, table):
    axes.plot(table["time"], MM * table["shoe_height"], label="shoe")
    axes.plot(table["time"], MM * table["shoe_surface"], color="C0", linewidth=0.8,
              linestyle=":", label="shoe, surface")
    axes.plot(table["time"], MM * table["die_height"], label="die")
    axes.axhline(MM * analysis.DIE_HEIGHT, color="0.6", linewidth=0.8, zorder=0)
    axes.set(ylabel="height / mm", ylim=(0, None))
    axes.legend(frameon=False, fontsize=8)


def draw_pressure(axes, series):
    axes.plot(series["time"], series["pressure_drop"], color="C3", linewidth=0.9)
    axes.set(ylabel="pressure in the die / Pa")


def draw_upper_edge(axes, table):
    axes.plot(table["time"], MM * table["upper_edge"], color="C2")
    axes.plot(table["time"], MM * (table["upper_edge"] - analysis.rise(table["upper_edge"])),
              color="0.5", linewidth=0.8, linestyle=":", label="lowest so far")
    for time in analysis.splashes(table["time"], table["upper_edge"]):
        axes.axvline(time, color="0.3", linewidth=0.8, linestyle="--", label=f"splash, {time:.2f} s")
    axes.set(ylabel="upper edge / mm", ylim=(0, None))
    axes.legend(frameon=False, fontsize=8)


def snapshot_times(table):
    """Times of the pictures, s: the start, the splash or half of the filling, a little after the
    last splash and the full die."""
    found = analysis.splashes(table["time"], table["upper_edge"])
    end = min(table["time"][-1], max(found + [analysis.time_full(table)]) + 0.1)
    middle = found[0] if found else 0.6 * end
    return numpy.interp([0, 1, 2, 3, 4], [0, 3, 4], [0, middle, end])


def draw(directory, picture, table, title):
    """Writes `picture` (PNG) from the results in `directory` and the curves in `table`."""
    series = frames.read_time_series(directory)
    gas, grains = (frames.frame_files(directory, name) for name in ("gas", "grains"))
    times = numpy.array([time for time, _ in grains])
    top = 1e-3 * (5 + MM * (analysis.DIE_HEIGHT + table["highest_grain"].max()))
    figure = pyplot.figure(figsize=(11, 10), layout="constrained")
    figure.suptitle(title)
    upper, lower = figure.subfigures(2, 1, height_ratios=[2.4, 1])
    sections = upper.subplots(2, SNAPSHOTS, sharex=True, sharey=True)
    for column, time in enumerate(snapshot_times(table)):
        number = int(numpy.argmin(abs(times - time)))
        frame = frames.read_frame(gas[number][1])
        circles = draw_grains(sections[0, column], frames.read_frame(grains[number][1]), top)
        void = draw_void_fraction(sections[1, column], frame, grid_top(frame), top)
        sections[0, column].set(title=f"t = {times[number]:.2f} s", xlabel=None)
    for row in sections:
        row[0].set_ylabel("z / mm")
    upper.colorbar(circles, ax=sections[0], label="vertical velocity / (m/s)", shrink=0.8)
    upper.colorbar(void, ax=sections[1], label="void fraction", shrink=0.8)
    curves = lower.subplots(1, 3, sharex=True, gridspec_kw={"wspace": 0.05})
    draw_heights(curves[0], table)
    draw_pressure(curves[1], series)
    draw_upper_edge(curves[2], table)
    for axes in curves:
        axes.set(xlabel="time / s", xlim=(0, table["time"][-1]))
    figure.savefig(picture, dpi=110)
    pyplot.close(figure)


def animate(directory, path, table, most=90):
    """Grains and void fraction in section, and the pressure, over time."""
    series = frames.read_time_series(directory)
    gas, grains = (frames.frame_files(directory, name) for name in ("gas", "grains"))
    chosen = numpy.unique(numpy.linspace(0, len(gas) - 1, min(most, len(gas))).astype(int))
    top = 1e-3 * (5 + MM * (analysis.DIE_HEIGHT + table["highest_grain"].max()))
    figure, (left, middle, right) = pyplot.subplots(
        1, 3, figsize=(9, 4.5), layout="constrained", width_ratios=[1, 1, 1.2])

    def draw_frame(number):
        for axes in (left, middle, right):
            axes.clear()
        time, gas_file = gas[chosen[number]]
        frame = frames.read_frame(gas_file)
        draw_grains(left, frames.read_frame(grains[chosen[number]][1]), top)
        draw_void_fraction(middle, frame, grid_top(frame), top)
        left.set(title=f"grains, t = {time:.2f} s", ylabel="z / mm")
        middle.set_title("void fraction")
        draw_pressure(right, series)
        right.axvline(time, color="0.3", linewidth=0.8)
        right.set(xlabel="time / s", xlim=(0, series["time"][-1]))

    pictures.animate(path, figure, len(chosen), draw_frame)
