"""Pictures of die filling: grains and void fraction in section at five times, and the curves."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import analysis  # noqa: E402
import frames  # noqa: E402
import numpy  # noqa: E402
import pictures  # noqa: E402
from pictures import MM, pyplot  # noqa: E402

RADIUS, DIE_HALF_WIDTH = 0.025, 0.0125  # of the shoe; of the die in the section x = 0; m
SNAPSHOTS = 5
FASTEST = 0.6  # m/s, end of the colour scale


def draw_walls(axes):
    """Die and floor of the shoe in the section x = 0."""
    for side in (-1, 1):
        corners = (side * MM * DIE_HALF_WIDTH, 0) if side > 0 else (-MM * RADIUS, 0)
        axes.add_patch(pyplot.Rectangle(corners, MM * (RADIUS - DIE_HALF_WIDTH),
                                        MM * analysis.DIE_HEIGHT, facecolor="0.8",
                                        edgecolor="0.3", linewidth=0.8, zorder=3))


def draw_grains(axes, grains, top):
    """Grains whose centre lies in a slab of two diameters about x = 0, by their speed."""
    speed = numpy.linalg.norm(grains["velocity"], axis=1)
    thickness = 2 * grains["radius"].max()
    circles = pictures.grains_in_section(axes, grains, (-thickness, thickness), speed,
                                         (0, FASTEST), "plasma", across="y")
    draw_walls(axes)
    pictures.frame_section(axes, (-RADIUS, RADIUS), (0, top), None, across="y")
    return circles


def draw_void_fraction(axes, gas, grid_top, top):
    """Mean of the two layers of cells at x = 0."""
    columns = gas["void_fraction"].shape[2]
    middle = slice(columns // 2 - 1, columns // 2 + 1)
    void = gas["void_fraction"][:, :, middle].mean(axis=2)
    void = numpy.where(gas["wall_fraction"][:, :, middle].mean(axis=2) > 0.5, numpy.nan, void)
    picture = pictures.void_fraction_in_section(axes, void, (-RADIUS, RADIUS, 0, grid_top))
    draw_walls(axes)
    pictures.frame_section(axes, (-RADIUS, RADIUS), (0, top), None, across="y")
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
    axes.set(ylabel="pressure below the shoe / Pa")


def draw_thrown(axes, table):
    thrown = 100 * table["thrown_share"]
    axes.plot(table["time"], thrown, color="C2")
    for time in analysis.splashes(table["time"], table["thrown_share"]):
        axes.axvline(time, color="0.3", linewidth=0.8, linestyle="--")
        axes.annotate(f" splash, {time:.2f} s", (time, 0.92), fontsize=8,
                      xycoords=("data", "axes fraction"))
    axes.axhline(100 * analysis.THROWN, color="0.6", linewidth=0.8, zorder=0)
    axes.set(ylabel="thrown grains / %", ylim=(0, max(0.5, 1.25 * thrown.max())))


def snapshot_times(table):
    """Times of the pictures, s: from the start to a little after the die is full."""
    end = min(table["time"][-1], analysis.time_full(table) + 0.1)
    return numpy.linspace(0, end, SNAPSHOTS)


def draw(directory, picture, table, title):
    """Writes `picture` (PNG) from the results in `directory` and the curves in `table`."""
    series = frames.read_time_series(directory)
    gas, grains = (frames.frame_files(directory, name) for name in ("gas", "grains"))
    times = numpy.array([time for time, _ in grains])
    top = 1e-3 * (5 + MM * (analysis.DIE_HEIGHT + table["highest_grain"].max()))
    figure = pyplot.figure(figsize=(11, 9.5), layout="constrained")
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
    upper.colorbar(circles, ax=sections[0], label="speed of grains / (m/s)", shrink=0.8)
    upper.colorbar(void, ax=sections[1], label="void fraction", shrink=0.8)
    curves = lower.subplots(1, 3, sharex=True)
    draw_heights(curves[0], table)
    draw_pressure(curves[1], series)
    draw_thrown(curves[2], table)
    for axes in curves:
        axes.set(xlabel="time / s", xlim=(0, table["time"][-1]))
    figure.savefig(picture, dpi=130)
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
