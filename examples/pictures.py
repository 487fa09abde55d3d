"""Drawing that the examples share: grains and gas in section, curves, animations."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.collections  # noqa: E402
import matplotlib.pyplot as pyplot  # noqa: E402
import numpy  # noqa: E402
from matplotlib.animation import PillowWriter  # noqa: E402

MM = 1e3  # drawings are in millimetres


def grains_in_section(axes, grains, depth, colours, limits, colour_map):
    """Grains with depth[0] <= y < depth[1] (m), painted from back to front.

    `colours`: one number per grain, shown between `limits`.
    """
    position = grains["position"]
    order = numpy.argsort(-position[:, 1])
    shown = position[order, 1]
    order = order[(shown >= depth[0]) & (shown < depth[1])]
    diameter = 2 * MM * grains["radius"][order]
    circles = matplotlib.collections.EllipseCollection(
        diameter, diameter, numpy.zeros(len(order)), units="xy",
        offsets=MM * position[order][:, [0, 2]], transOffset=axes.transData,
        array=colours[order], cmap=colour_map, edgecolors="0.25", linewidths=0.1)
    circles.set_clim(*limits)
    axes.add_collection(circles)
    return circles


def void_fraction_in_section(axes, void, extent, line_colour="white"):
    """`void`: [z, x], nan where there is no gas; `extent`: x and z, m. The line marks 0.8."""
    extent = [MM * value for value in extent]
    picture = axes.imshow(void, origin="lower", extent=extent, cmap="viridis", vmin=0.4, vmax=1.0,
                          interpolation="nearest")
    axes.contour(void, levels=[0.8], extent=extent, origin="lower", colors=line_colour,
                 linewidths=0.8)
    return picture


def frame_section(axes, x, z, title):
    """Axes of a section: limits in m."""
    axes.set(xlim=[MM * value for value in x], ylim=[MM * value for value in z], aspect="equal",
             title=title, xlabel="x / mm")
    axes.tick_params(length=2)


def series_with_mean(axes, series, column, mean, reference, start, scale):
    """A column over time with its mean from `start` on, and a reference (value, name) dashed.

    `scale`: from SI to the unit of the axis.
    """
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


def animate(path, figure, count, draw, frames_per_second=12):
    """Writes a GIF of `count` pictures; draw(i) changes the figure to number i."""
    writer = PillowWriter(fps=frames_per_second)
    with writer.saving(figure, str(path), dpi=80):
        for number in range(count):
            draw(number)
            writer.grab_frame()
    pyplot.close(figure)
