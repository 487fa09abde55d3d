"""Pictures of the spouted bed: grains, mean void fraction and gas, circulation, pressure drop."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import analysis  # noqa: E402
import frames  # noqa: E402
import numpy  # noqa: E402
import pictures  # noqa: E402
from pictures import MM, pyplot  # noqa: E402

import common  # noqa: E402

FASTEST = 1.0  # m/s, ends of the colour scale


def draw_jet(axes):
    """The slot in the floor."""
    middle = MM * analysis.WIDTH / 2
    axes.plot([middle - MM * analysis.JET / 2, middle + MM * analysis.JET / 2], [0, 0],
              color="C1", linewidth=5, zorder=4, clip_on=False, solid_capstyle="butt")


def draw_grains(axes, grains, top):
    """Grains whose centre lies in the front half of the depth."""
    circles = pictures.grains_in_section(axes, grains, (0, analysis.DEPTH / 2),
                                         grains["velocity"][:, 2], (-FASTEST, FASTEST), "coolwarm")
    pictures.frame_section(axes, (0, analysis.WIDTH), (0, top), None)
    draw_jet(axes)
    return circles


def draw_mean_gas(axes, result, top):
    layers, columns = result["void"].shape
    image = pictures.void_fraction_in_section(axes, result["void"],
                                              (0, analysis.WIDTH, 0, analysis.HEIGHT), "0.3")
    x = MM * analysis.WIDTH * (numpy.arange(columns) + 0.5) / columns
    z = MM * analysis.HEIGHT * (numpy.arange(layers) + 0.5) / layers
    shown = z < MM * top
    axes.streamplot(x, z[shown], result["gas"][shown, :, 0], result["gas"][shown, :, 1],
                    color="white", linewidth=0.6, density=1.0, arrowsize=0.6)
    pictures.frame_section(axes, (0, analysis.WIDTH), (0, top), "mean void fraction\nand gas flow")
    draw_jet(axes)
    return image


def draw_circulation(axes, result, top):
    """Mean velocity of the grains where a cell holds at least a tenth of a grain on average."""
    count, motion = result["grains"], result["motion"]
    layers, columns = count.shape
    z, x = numpy.meshgrid(MM * analysis.HEIGHT * (numpy.arange(layers) + 0.5) / layers,
                          MM * analysis.WIDTH * (numpy.arange(columns) + 0.5) / columns,
                          indexing="ij")
    seen = (count > 0.1) & (z < MM * top)
    # The annulus is ten times slower than the spout: the square root lets both be seen.
    speed = numpy.hypot(motion[..., 0], motion[..., 1])
    arrows = motion / numpy.sqrt(numpy.maximum(speed, 1e-6))[..., None]
    quiver = axes.quiver(x[seen], z[seen], arrows[seen, 0], arrows[seen, 1], motion[seen, 1],
                         cmap="coolwarm", clim=(-FASTEST, FASTEST), angles="xy", scale=14,
                         width=5e-3, edgecolor="0.4", linewidth=0.2)
    level = MM * analysis.MIDDLE
    axes.axhline(level, color="0.6", linewidth=0.6, linestyle=":", zorder=0)
    axes.axhline(MM * result["annulus_height"], color="0.3", linewidth=0.8, linestyle="--")
    pictures.frame_section(axes, (0, analysis.WIDTH), (0, top),
                           "mean velocity of the grains\n(length: square root)")
    draw_jet(axes)
    return quiver


def draw(directory, picture, start, result):
    """Writes `picture` (PNG); `result` is that of analysis.analyse."""
    series = frames.read_time_series(directory)
    summary = common.read_summary(directory)
    last_time, grain_file = frames.frame_files(directory, "grains")[-1]
    annulus = result["annulus_height"]
    top = min(analysis.HEIGHT, 1.25 * (annulus + result["fountain_height"]))
    figure = pyplot.figure(figsize=(12, 5.2), layout="constrained")
    grid = figure.add_gridspec(2, 4, width_ratios=[1, 1, 1, 1.3])
    left, middle, right = (figure.add_subplot(grid[:, n]) for n in range(3))
    circles = draw_grains(left, frames.read_frame(grain_file), top)
    left.set(title=f"grains, t = {last_time:.2f} s\n", ylabel="z / mm")
    void = draw_mean_gas(middle, result, top)
    arrows = draw_circulation(right, result, top)
    for drawn, axes, label in ((circles, left, "vertical velocity / (m/s)"),
                               (void, middle, "void fraction"),
                               (arrows, right, "vertical velocity / (m/s)")):
        figure.colorbar(drawn, ax=axes, location="bottom", label=label)

    pressure, height = figure.add_subplot(grid[0, 3]), figure.add_subplot(grid[1, 3])
    pictures.series_with_mean(pressure, series, "pressure_drop",
                              summary["pressure_drop_mean"]["value"],
                              (series["weight_over_area"][-1], "weight"), start, 1.0)
    pressure.set(ylabel="pressure drop / Pa")
    late = frames.frame_files(directory, "grains")
    times = numpy.array([time for time, _ in late])
    tops = numpy.array([analysis.fountain_top(frames.read_frame(file)) for _, file in late])
    pictures.series_with_mean(height, {"time": times, "top": tops}, "top",
                              annulus + result["fountain_height"], (annulus, "annulus"), start, MM)
    height.set(ylabel="top of the fountain / mm", xlabel="time with gas / s")
    figure.savefig(picture, dpi=130)
    pyplot.close(figure)


def animate(directory, path, top, most=80):
    """Grains over time."""
    grains = frames.frame_files(directory, "grains")
    chosen = numpy.unique(numpy.linspace(0, len(grains) - 1, min(most, len(grains))).astype(int))
    figure, axes = pyplot.subplots(figsize=(3.4, 6), layout="constrained")

    def draw_frame(number):
        axes.clear()
        time, file = grains[chosen[number]]
        draw_grains(axes, frames.read_frame(file), top)
        axes.set(title=f"t = {time:.2f} s", ylabel="z / mm")

    pictures.animate(path, figure, len(chosen), draw_frame)
