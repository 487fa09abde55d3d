"""Tables and Pareto plots of the stored runs: docs/coarse_graining_errors.md and its pictures, and
what `gasgrain estimate` knows of them: liggghts_plugins/scene_errors.inc.

    tests/bench/coarse_graining/tables [--results DIR] [--page FILE] [--errors FILE]
"""

import argparse
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402

import errors  # noqa: E402
from cases import RATIOS, SCENES, SEEDS, TRUTH, all_cases  # noqa: E402
from laws import LAWS  # noqa: E402
from scene import FACTORS  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
MARKS = {"cgm-n3": ("o", "C0"), "cgm-n2": ("s", "C0"), "cgm-n1": ("^", "C0"),
         "stock-cg": ("v", "C3"), "stock-hooke": ("D", "C1"), "stock-hertz": ("P", "C2"),
         "stock-hand": ("X", "C5")}


def per_cent(part):
    if not math.isfinite(part.value):
        return "-"
    bar = f" +- {100 * part.bar:.1f}" if math.isfinite(part.bar) else ""
    return f"{100 * part.value:+.1f}{bar}"


def signed_row(name, l, rows, truth, scene):
    parts = errors.deviations(rows, truth, scene)
    error, missing = errors.total_error(parts)
    note = f" ({missing} none)" if missing else ""
    cells = [name, f"{l:g}", str(len(rows)), f"{errors.cost(rows, 'cpu_seconds'):.3g}",
             f"{errors.cost(rows, 'grain_steps'):.3g}", f"{100 * error:.1f}{note}",
             *(per_cent(parts[quantity]) for quantity in scene.quantities)]
    return "| " + " | ".join(cells) + " |"


def header(first, scene):
    names = [f"{name}" for name in scene.quantities]
    cells = [first, "l", "seeds", "CPU s", "grain-steps", "error %", *names]
    return ["| " + " | ".join(cells) + " |", "|" + "---|" * len(cells)]


def truth_line(truth, scene):
    values = []
    for name, (unit, _) in scene.quantities.items():
        mean, variance = errors.mean_and_variance(truth, name)
        spread = f" +- {math.sqrt(variance * len(truth)):.1g}" if math.isfinite(variance) else ""
        values.append(f"{name} {mean:.4g}{spread} {unit}")
    return (f"Originals ({len(truth)} seeds, +- one standard deviation; "
            f"{errors.cost(truth, 'cpu_seconds'):.3g} s CPU, "
            f"{errors.cost(truth, 'grain_steps'):.3g} grain-steps; scatter "
            f"{100 * errors.scatter(truth, scene):.1f} %): " + ", ".join(values) + ".")


def law_table(groups, truth, scene):
    lines = header("law", scene)
    for l in sorted((1, *RATIOS)):
        for law in LAWS:
            rows = groups.get(errors.Group(law, float(l), "", ""))
            if rows and (law, l) != (TRUTH, 1):
                lines.append(signed_row(law, l, rows, truth, scene))
    return lines


def factor_table(groups, truth, scene):
    lines = []
    for factor in FACTORS:
        chosen = [group for group in groups if group.factor == factor]
        for group in sorted(chosen, key=lambda group: float(group.value)):
            lines.append(signed_row(f"{factor} {group.value}", group.l, groups[group], truth, scene))
    return header("factor", scene) + lines if lines else []


def draw(groups, truth, scene, path):
    figure, axes = pyplot.subplots(1, 2, figsize=(11, 4.2), sharey=True, layout="constrained")
    for axis, cost, label in ((axes[0], "cpu_seconds", "CPU time, s"),
                              (axes[1], "grain_steps", "grain-steps")):
        for law in LAWS:
            points = []
            for l in sorted(RATIOS):
                rows = groups.get(errors.Group(law, float(l), "", ""))
                if rows:
                    error, _ = errors.total_error(errors.deviations(rows, truth, scene))
                    points.append((errors.cost(rows, cost), 100 * error, l))
            if points:
                mark, color = MARKS[law]
                x, y, ratios = zip(*points)
                axis.plot(x, y, marker=mark, color=color, label=law,
                          linestyle="-" if law.startswith("cgm") else "--")
                for place in zip(x, y, ratios):
                    axis.annotate(f"{place[2]:g}", place[:2], fontsize=7, xytext=(3, 3),
                                  textcoords="offset points")
        noise = errors.scatter(truth, scene)
        if math.isfinite(noise):
            axis.axhspan(0, 100 * noise, color="0.9", label="scatter of the originals")
        axis.set(xscale="log", yscale="log", xlabel=label)
        axis.grid(True, which="both", color="0.93")
    axes[0].set_ylabel("error against l = 1, %")
    axes[1].legend(fontsize=8)
    figure.suptitle(f"{scene.title}: error against cost (numbers: l)")
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def section(scene, results, pictures):
    rows = errors.read_rows(results, scene.name)
    groups = errors.group_rows(rows)
    wanted = [case for case in all_cases() if case.scene == scene.name]
    truth = groups.get(errors.Group(TRUTH, 1.0, "", ""), [])
    lines = [f"## {scene.title.capitalize()}", "",
             f"{len(rows)} of {len(wanted)} runs are stored."]
    if len(truth) < 2:
        return [*lines, "The originals are missing: nothing to compare with yet.", ""]
    lines += ["", truth_line(truth, scene), ""]
    if scene.note:
        lines += [scene.note, ""]
    lines += [*law_table(groups, truth, scene), ""]
    if len(truth) < len(SEEDS):
        lines += [f"Only {len(truth)} of {len(SEEDS)} seeds of the originals: bars are wide.", ""]
    factors = factor_table(groups, truth, scene)
    if factors:
        lines += ["One factor at a time (default: step 10):", "", *factors, ""]
    picture = pictures / f"coarse_graining_{scene.name}.png"
    draw(groups, truth, scene, picture)
    return [*lines, f"![{scene.title}]({picture.name})", ""]


def error_rows(scene, results):
    """Of the own law: a row of scene_errors.inc per exponent n."""
    groups = errors.group_rows(errors.read_rows(results, scene.name))
    truth = groups[errors.Group(TRUTH, 1.0, "", "")]
    scatter = errors.scatter(truth, scene)
    for n in (1, 2, 3):
        found = [errors.total_error(errors.deviations(groups[errors.Group(f"cgm-n{n}", float(l), "",
                                                                          "")], truth, scene))[0]
                 for l in sorted(RATIOS)]
        shares = ", ".join(f"{error:.3f}" for error in (*found, scatter))
        yield f'    {{"{scene.title} ({scene.size})", {n}, {shares}}},'


PREAMBLE = """# Coarse graining: measured errors and costs

Made by `tests/bench/coarse_graining/tables` from the rows in `tests/bench/coarse_graining/results/`, which `tests/bench/coarse_graining/run` makes. Deviations in per cent from runs of the originals (l = 1) with 95 % intervals; a `-` is a quantity that a run did not reach. Mixing, sides and shares are differences, not relative. The error of a row is the root mean square over its quantities. CPU seconds are of the whole process on one core, set-up included. Laws: `tests/bench/coarse_graining/laws.py`.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=pathlib.Path, default=HERE / "results")
    parser.add_argument("--page", type=pathlib.Path,
                        default=ROOT / "docs" / "coarse_graining_errors.md")
    parser.add_argument("--errors", type=pathlib.Path,
                        default=ROOT / "liggghts_plugins" / "scene_errors.inc")
    given = parser.parse_args()
    lines = [PREAMBLE]
    for scene in SCENES.values():
        lines += section(scene, given.results, given.page.parent)
    given.page.write_text("\n".join(lines).rstrip() + "\n")
    rows = [row for scene in SCENES.values() for row in error_rows(scene, given.results)]
    given.errors.write_text("\n".join(["// Made by tests/bench/coarse_graining/tables. Shares: l = 2, 3,"
                                       " 4; scatter of l = 1.", *rows]) + "\n")
    print(f"wrote {given.page} and {given.errors}")


if __name__ == "__main__":
    main()
