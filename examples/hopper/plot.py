"""The picture of the hopper: grains in section at four times, mass in the hopper over time."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402

OPENING = 0.4  # s
GRAIN = 1.0  # radius, mm
WALL = [(-30, 120), (-30, 50), (-7, 6), (-7, 0)]  # mm


def draw_grains(axes, time, frame, height):
    section = numpy.abs(frame["y"]) < 1e-3 * GRAIN
    circles = [plt.Circle((1e3 * x, 1e3 * z), GRAIN)
               for x, z in zip(frame["x"][section], frame["z"][section])]
    # by the height at rest, in layers
    layer = numpy.floor(height[section] / 0.01) % 2
    axes.add_collection(matplotlib.collections.PatchCollection(
        circles, facecolor=numpy.where(layer == 1, "tab:orange", "tab:blue"), edgecolor="white",
        linewidth=0.2))
    for side in (1, -1):
        axes.plot([side * x for x, _ in WALL], [z for _, z in WALL], color="0.3", linewidth=1.5)
    if time <= OPENING:
        axes.plot([-10, 10], [-1, -1], color="0.3", linewidth=3)
    axes.set(aspect="equal", xlim=(-32, 32), ylim=(-30, 120), title=f"{time:.2f} s")
    axes.set_axis_off()


def draw(path, frames, at_rest, series, quantities):
    heights = dict(zip(at_rest["id"], at_rest["z"]))
    figure = plt.figure(figsize=(11, 5), constrained_layout=True)
    grid = figure.add_gridspec(1, 6)
    last = frames[-1][0]
    for n, wanted in enumerate((OPENING - 0.01, OPENING + 0.25, OPENING + 0.7, last)):
        time, frame = min(frames, key=lambda f: abs(f[0] - wanted))
        height = numpy.array([heights[i] for i in frame["id"]])
        draw_grains(figure.add_subplot(grid[0, n]), time, frame, height)
    mass = figure.add_subplot(grid[0, 4:])
    mass.plot(series["time"], 1e3 * series["mass"], label="grains in the hopper")
    discharge = quantities["discharge"]
    middle = numpy.searchsorted(series["time"], OPENING + 0.75)
    for flow, style, name in ((discharge["value"], "tab:red", "fit"),
                              (discharge["reference"], "black", "Beverloo")):
        time = OPENING + 0.75 + numpy.array([-0.35, 0.35])
        line = series["mass"][middle] - flow * (time - OPENING - 0.75)
        mass.plot(time, 1e3 * line, "--", color=style, label=f"{name}: {1e3 * flow:.1f} g/s")
    mass.set(xlabel="time (s)", ylabel="mass (g)", ylim=(0, None))
    mass.legend()
    figure.savefig(path, dpi=110)
