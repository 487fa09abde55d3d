"""Makes docs/verification.md and its figures from references.csv and results/*.csv."""

import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
DOCS = HERE.parents[1] / "docs"
RESULTS = HERE / "results"

HEAD = """# Verification of gas, walls and grains in gas

Made by `tests/verification/run` from the stored results; do not edit by hand. Every program of
[tests/verification](../tests/verification) asserts the same bounds when it runs as a test:
`tests/verification/run` runs the cheap ones, `--slow` all of them.

Error: relative to the reference, or the value itself where the reference is 0. Values without a
bound are for comparison: coarser grids, and published values with a known error of their own.
References and their sources: [references.csv](../tests/verification/references.csv).
"Prototype": a small program, written apart from this code before it, with the same scheme. A new case is a
test that calls `Report::check` (`tests/verification/report.hpp`) and a row there per quantity.
"""

NOTES = HERE / "notes.md"


def read_result(path):
    """(head as a dict, rows as dicts) of one results file."""
    lines = path.read_text().splitlines()
    head = dict(l[2:].split(": ", 1) for l in lines if l.startswith("# "))
    return head, list(csv.DictReader(l for l in lines if not l.startswith("# ")))


def references():
    """{case: {quantity: row}} in the order of the file."""
    cases = {}
    with open(HERE / "references.csv") as file:
        for row in csv.DictReader(file):
            cases.setdefault(row["case"], {})[row["quantity"]] = row
    return cases


def error_text(value, reference):
    if not reference:
        return ""
    exact = float(reference)
    if exact == 0:
        return f"{abs(float(value)):.2g}"
    return f"{100 * (float(value) / exact - 1):+.2f} %"


def table(rows, listed):
    lines = ["| quantity | grid | value | reference | error | bound | | source |",
             "|---|---|---|---|---|---|---|---|"]
    for row in rows:
        # a coarser grid's row carries the reference only to show the error
        known = listed.get(row["quantity"], {})
        error = error_text(row["value"], row["reference"])
        lines.append(
            f"| {row['quantity']} | {row['grid']} | {float(row['value']):.5g} | "
            f"{row['reference']} | {error} | {row['pass']} | {row['result']} | "
            f"{known.get('source', '')} |")
    return "\n".join(lines)


def anchor(title):
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def worst_error(rows):
    """Largest relative error among the values that are held to a share of their reference."""
    errors = [abs(float(r["value"]) / float(r["reference"]) - 1) for r in rows
              if r["pass"].endswith("%")]
    return f"{100 * max(errors):.2g} %" if errors else ""


def page(cases):
    parts, passed, missed, absent = [], 0, [], []
    overview = ["| case | values within bounds | largest error |", "|---|---|---|"]
    for case, listed in cases.items():
        path = RESULTS / f"{case}.csv"
        if not path.exists():
            absent.append(case)
            continue
        head, rows = read_result(path)
        passed += sum(row["result"] == "pass" for row in rows)
        missed += [f"{head['title']}: {row['quantity']}" for row in rows if row["result"] == "MISS"]
        title = head["title"][0].upper() + head["title"][1:]
        bounded = [row for row in rows if row["pass"]]
        good = sum(row["result"] == "pass" for row in bounded)
        overview.append(f"| [{title}](#{anchor(title)}) | {good} of {len(bounded)} | "
                        f"{worst_error(bounded)} |")
        parts.append(f"## {title}\n\n`{head['command']}`, program `{head['program']}`, commit "
                     f"{head['commit']}, {head['date']}\n\n{table(rows, listed)}\n")
    summary = f"{len(parts)} cases, {passed} values within their bounds, {len(missed)} not.\n\n"
    summary += "\n".join(overview) + "\n"
    if missed:
        summary += "\nOutside:\n\n" + "".join(f"- {m}\n" for m in missed)
    if absent:
        summary += "\nNo results stored yet: " + ", ".join(absent) + ".\n"
    figures = "".join(f"![{text}]({name})\n\n" for name, text in FIGURES if (DOCS / name).exists())
    notes = NOTES.read_text() if NOTES.exists() else ""
    return "\n".join([HEAD, summary, figures, notes] + parts).rstrip() + "\n"


FIGURES = [
    ("verification_cavity.png", "Centre-line velocities of the lid-driven cavity"),
    ("verification_cylinder.png", "Drag of a cylinder in a channel"),
]


def ghia():
    """{'u': {Re: (positions, values)}, 'v': ...} of Ghia, Ghia & Shin 1982."""
    tables, columns = {"u": {}, "v": {}}, []
    for line in (HERE / "ghia1982.csv").read_text().splitlines():
        if line.startswith("#"):
            continue
        fields = line.split(",")
        if not fields[0][0].isdigit():
            columns = fields[1:]
            continue
        for name, value in zip(columns, fields[1:]):
            component, reynolds = name.split("_Re")
            misprint = name == "v_Re400" and fields[0] == "0.9063"
            if not misprint:
                x, y = tables[component].setdefault(int(reynolds), ([], []))
                x.append(float(fields[0]))
                y.append(float(value))
    return tables


def columns_of(path):
    rows = [row for row in read_result(path)[1]]
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def draw_cavity():
    runs = {re: RESULTS / f"cavity_re_{re}_profiles.csv" for re in (100, 400, 1000)}
    if not any(path.exists() for path in runs.values()):
        return
    published = ghia()
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), constrained_layout=True)
    for (re, path), colour in zip(runs.items(), ("tab:blue", "tab:orange", "tab:green")):
        if not path.exists():
            continue
        run = columns_of(path)
        left.plot(run["u"], run["position"], color=colour, label=f"Re {re}")
        right.plot(run["position"], run["v"], color=colour, label=f"Re {re}")
        heights, u = published["u"][re]
        left.plot(u, heights, "o", color=colour, mfc="none", ms=4)
        right.plot(*published["v"][re], "o", color=colour, mfc="none", ms=4)
    left.set(xlabel="u at x = 1/2", ylabel="y")
    right.set(xlabel="x", ylabel="v at y = 1/2")
    right.legend(title="lines: 128 x 128\ncircles: Ghia 1982", fontsize=8, title_fontsize=8)
    figure.savefig(DOCS / "verification_cavity.png", dpi=110)


def draw_cylinder():
    steady, trace = RESULTS / "cylinder_2d1.csv", RESULTS / "cylinder_2d2_trace.csv"
    if not steady.exists():
        return
    rows = [r for r in read_result(steady)[1] if r["quantity"] == "drag coefficient"]
    cells = [float(row["grid"].split()[1]) for row in rows]
    errors = [100 * abs(float(row["value"]) / float(row["reference"]) - 1) for row in rows]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
    left.loglog(cells, errors, "o-", label="Re 20 (2D-1)")
    left.loglog(cells, [errors[0] * (cells[0] / c) ** 2 for c in cells], "k--", label="order 2")
    left.set(xlabel="cells per diameter", ylabel="error of the drag coefficient (%)")
    left.set_xticks(cells, [f"{c:.0f}" for c in cells])
    left.set_yticks([0.2, 0.5, 1, 2, 5], ["0.2", "0.5", "1", "2", "5"])
    left.minorticks_off()
    left.legend()
    if trace.exists():
        run = columns_of(trace)
        right.plot(run["time"], run["drag"], label="drag")
        right.plot(run["time"], run["lift"], label="lift")
        right.set(xlabel="time (s)", ylabel="coefficient", title="Re 100 (2D-2), 20 cells per diameter")
        right.legend()
    else:
        right.set_visible(False)
    figure.savefig(DOCS / "verification_cylinder.png", dpi=110)


def main():
    RESULTS.mkdir(exist_ok=True)
    draw_cavity()
    draw_cylinder()
    (DOCS / "verification.md").write_text(page(references()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
