"""The picture of the rotating drum: grains at four times, torque and mixing over time."""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402

import drum_stl  # noqa: E402

START = 0.3  # s
GRAIN = 1e-3  # radius, m


def turned_outline(angle):
    """Cross-section of the drum, mm, after a turn about y (z towards x)."""
    x, z = numpy.array(drum_stl.outline() + drum_stl.outline()[:1]).T
    return (1e3 * (math.cos(angle) * x + math.sin(angle) * z),
            1e3 * (math.cos(angle) * z - math.sin(angle) * x))


def draw_grains(axes, time, frame, left, rate):
    section = (frame["y"] > 0.5 * drum_stl.LENGTH - GRAIN) & (frame["y"] < 0.5 * drum_stl.LENGTH + GRAIN)
    for chosen, colour in ((left == 1, "tab:orange"), (left == 0, "tab:blue")):
        here = section & chosen
        circles = [plt.Circle((1e3 * x, 1e3 * z), 1e3 * GRAIN)
                   for x, z in zip(frame["x"][here], frame["z"][here])]
        axes.add_collection(matplotlib.collections.PatchCollection(
            circles, facecolor=colour, edgecolor="white", linewidth=0.2))
    axes.plot(*turned_outline(rate * max(0.0, time - START)), color="0.3", linewidth=1.5)
    axes.set(aspect="equal", xlim=(-53, 53), ylim=(-53, 53), title=f"{time:.2f} s")
    axes.set_axis_off()


def draw(path, frames, left, series, mixing, rate):
    figure = plt.figure(figsize=(10, 6), constrained_layout=True)
    grid = figure.add_gridspec(2, 4, height_ratios=(1, 1))
    last = frames[-1][0]
    for n, share in enumerate((0, 0.12, 0.5, 1)):
        wanted = START + share * (last - START)
        time, frame = min(frames, key=lambda f: abs(f[0] - wanted))
        draw_grains(figure.add_subplot(grid[0, n]), time, frame, left, rate)
    torque = figure.add_subplot(grid[1, :2])
    torque.plot(series["time"], 1e3 * series["torque"], label="grains on drum and end walls")
    torque.plot(series["time"], 1e3 * series["weight_moment"], "k--", linewidth=1,
                label="weight times its lever")
    torque.set(xlabel="time (s)", ylabel="torque about the axis (mN m)")
    steady = 1e3 * numpy.abs(series["torque"][len(series["torque"]) // 2:]).max()
    torque.set_ylim(-1.5 * steady, 0.5 * steady)  # the jerk of the start goes beyond
    torque.legend()
    index = figure.add_subplot(grid[1, 2:])
    index.plot(*zip(*mixing), "o-", markersize=3)
    index.set(xlabel="time (s)", ylabel="mixing index (Lacey)", ylim=(-0.05, 1.05))
    figure.savefig(path, dpi=110)
