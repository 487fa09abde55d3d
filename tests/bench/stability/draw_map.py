"""map.png: a row per factor and scene, a mark per point, its colour the verdict."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402

from points import BED, FACTORS, JET, PLUG  # noqa: E402

COLOURS = {"good": "C2", "refused": "C0", "failed": "C3"}
BASES = {base.scene: base for base in (PLUG, BED, JET)}


def draw_factor(axes, rows, factor):
    shown = 0
    for number, scene in enumerate(BASES):
        for row in rows:
            kind = row["name"].split("=")[0].split(" ", 1)
            if row["scene"] != scene or kind[1] not in (factor, "base"):
                continue
            if kind[1] == "base" and factor == "void" and scene != "plug":
                continue
            value = float(row[factor])
            if value == 0:
                continue  # an interval by default has no place on the axis
            axes.plot(value, -number, "o" if kind[1] == factor else "D", markersize=8,
                      color=COLOURS[row["verdict"]],
                      markeredgecolor="0.2", fillstyle="full" if row["within"] == "1" else "left",
                      markerfacecoloralt="white")
            shown += 1
    axes.set(title=FACTORS[factor], ylim=(-2.6, 0.6), yticks=[0, -1, -2],
             yticklabels=list(BASES))
    if factor != "void":
        axes.set_xscale("log")
    axes.grid(axis="y", color="0.9")
    axes.title.set_fontsize(9)
    return shown


def draw(rows, picture):
    figure, grid = pyplot.subplots(4, 2, figsize=(11, 8.5), layout="constrained")
    for axes, factor in zip(grid.flat, FACTORS):
        draw_factor(axes, rows, factor)
    corners = [row for row in rows if "=" not in row["name"] and not row["name"].endswith("base")]
    good = sum(row["verdict"] == "good" for row in corners)
    figure.suptitle("Stability map: green stable and accurate, blue refused with a message, red "
                    f"failed; diamonds: base points;\nhalf filled: beyond the region of no refusal; "
                    f"{good} of {len(corners)} corners are good", fontsize=10)
    figure.savefig(picture, dpi=110)
    pyplot.close(figure)
