#!/usr/bin/python3
"""Makes docs/validation.md from the summaries of the paper's six cases.

    examples/validation.py [DIRECTORY ...]
    examples/validation.py --run DIRECTORY [--paper] [--cases 1-1 2-1 ...]

The second form first runs the cases, one after the other, in DIRECTORY/CASE; after two hours it
stops with a checkpoint and exit code 75, and the same command goes on. A finished run's summary and
picture are taken into docs/validation/, where the finest run of each case is kept. The page is then
made from what lies there.
"""

import argparse
import pathlib
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import common  # noqa: E402
import options  # noqa: E402
import pieces  # noqa: E402

STORE = common.ROOT / "docs" / "validation"
PAGE = common.ROOT / "docs" / "validation.md"
CASES = ("1-1", "1-2", "2-1", "2-2", "3-1", "3-2")
VELOCITIES = {"1-1": "0.2", "1-2": "0.3"}  # m/s
BALANCE = 1e-6  # of the weight: what closes to round-off, with room for grains that leave

# name in summary.json, label, factor, unit
DIE = (("start_height", "height in the shoe at the start", 1e3, "mm"),
       ("final_shoe_height", "final height in the shoe", 1e3, "mm"),
       ("final_die_height", "final height in the die", 1e3, "mm"),
       ("splash_count", "splashes", 1, ""),
       ("splash_1_time", "first splash", 1, "s"),
       ("splash_2_time", "second splash", 1, "s"),
       ("largest_rise", "largest rise of the upper edge", 1e3, "mm"),
       ("die_full_time", "die full", 1, "s"),
       ("plateau_begin", "pressure constant (+-10 %) from", 1, "s"),
       ("plateau_end", "to", 1, "s"),
       ("plateau_pressure", "at", 1, "Pa"),
       ("largest_die_pressure", "largest pressure below the shoe", 1, "Pa"))
BED = (("bed_height_mean", "mean bed height", 1e3, "mm"),
       ("pressure_drop_mean", "mean pressure drop", 1, "Pa"))
SPREAD = (("bed_height_void_0.7_mean", "at void fraction 0.7"),
          ("bed_height_void_0.9_mean", "at 0.9"), ("bed_height_solid_99_mean", "99 % of the grains"),
          ("bed_height_twice_centre_mean", "twice the centre of mass"))
PAPER_SPRINGS = {"1": 50, "2": 100, "3": 50}  # N/m, by the first digit of the case
PAPER_SIMULATION = {"1-1": 91.4, "1-2": 98.0}  # mm
INTERVALS = {"bed_height_mean": "bed_height_half_width",
             "pressure_drop_mean": "pressure_drop_half_width"}


def command(case, directory, chosen, hours):
    """Runs `case` through its example."""
    example = "fluidized_bed_tubes" if case in VELOCITIES else "die_filling"
    words = [sys.executable, str(common.ROOT / "examples" / example / "run.py"),
             "--out", str(directory / case), "--ranks", str(chosen.ranks), "--hours", f"{hours:.4f}"]
    words += (["--velocity", VELOCITIES[case], "--time", "3", "--start-up", "1"]
              if case in VELOCITIES else ["--case", case])
    return words + (["--paper"] if chosen.paper else [])


def run_case(words):
    """Exit code of the example; when we are told to end, so is it, and it writes a checkpoint."""
    process = subprocess.Popen(words)
    before = signal.signal(signal.SIGTERM, lambda *_: process.terminate())
    try:
        return process.wait()
    finally:
        signal.signal(signal.SIGTERM, before)


def run_cases(chosen):
    """Directories of the cases, all run to their ends; else the program ends here."""
    end = time.monotonic() + 3600 * chosen.hours
    for case in chosen.cases:
        left = max((end - time.monotonic()) / 3600, 1e-3)
        code = run_case(command(case, chosen.run, chosen, left))
        if code != 0:
            sys.exit(code)
    return [chosen.run / case for case in chosen.cases]


def store(directory):
    """Takes a run into STORE unless a finer one of its case is there."""
    summary = common.read_json(directory / "summary.json")
    made = summary.get("provenance", {"case": None})
    if made["case"] not in CASES:
        common.fail(f"{directory}/summary.json is not one of the paper's cases")
    kept = STORE / f"{made['case']}.json"
    if kept.exists() and common.read_json(kept)["provenance"]["l"] < made["l"]:
        print(f"{directory}: a run of case {made['case']} with smaller l is kept")
        return
    common.write_json(kept, summary)
    shutil.copyfile(directory / "result.png", STORE / f"{made['case']}.png")


def duration(seconds):
    return f"{seconds / 3600:.1f} h" if seconds >= 5400 else f"{seconds / 60:.1f} min"


def marked_ratio(made):
    return f"{made['l']:g}" if made["l"] == made["paper_l"] else f"**{made['l']:g}** (paper {made['paper_l']:g})"


def marked_spring(case, spring):
    paper = PAPER_SPRINGS[case[0]]
    return f"{spring:g}" if spring == paper else f"**{spring:g}** (paper {paper:g})"


def run_table(runs):
    rows = ["| case | l | grains | spring / N/m | gas cell / mm | simulated / s | DEM step / us | steps "
            "| machine | ranks | run time | commit |", "|" + "---|" * 12]
    for case, summary in runs.items():
        made = summary["provenance"]
        rows.append(f"| {case} | {marked_ratio(made)} | {made['grains']} | {marked_spring(case, made['spring'])} "
                    f"| {1e3 * made['gas_cell']:g} | {made['simulated']:g} | {1e6 * made['dem_step']:.3g} "
                    f"| {made['steps']} | {made['machine']} | {made['ranks']} "
                    f"| {duration(made['seconds'])} | {made['commit']} |")
    return rows


def allowed(quantity):
    """Absolute tolerance: that of summary.json is relative where the reference is not 0."""
    return quantity["tolerance"] * (abs(quantity["reference"]) or 1.0)


def comparison(name, quantity, scale):
    """The columns reference, deviation and verdict."""
    reference = quantity["reference"]
    if reference is None:
        return "| | | "
    deviation = quantity["value"] - reference
    words = (f"{100 * deviation / reference:+.1f} %" if name in INTERVALS
             else f"{scale * deviation:+.3g}")
    passed = abs(deviation) <= allowed(quantity) * (1 + 1e-9)
    return (f"| {scale * reference:.4g} +- {scale * allowed(quantity):.2g} | {words} "
            f"| {'pass' if passed else '**miss**'} ")


def number_row(case, name, values, label, scale, unit):
    quantity = values[name]
    label = f"{label} / {unit}" if unit else label
    if quantity["value"] is None:
        return f"| {case} | {label} | no value | | | | |"
    here = f"{scale * quantity['value']:.4g}"
    if name in INTERVALS:
        here += f" +- {scale * values[INTERVALS[name]]['value']:.2g}"
    return f"| {case} | {label} | {here} {comparison(name, quantity, scale)}| {quantity['source']} |"


def expected_splashes(values):
    """Rows for splashes that were expected and did not come."""
    count = values.get("splash_count")
    if not count:
        return []
    return [f"splash_{number}_time" for number in range(1, int(count["reference"]) + 1)
            if f"splash_{number}_time" not in values]


def bed_rows(case, values):
    """Bed height against the paper's simulation, and by other definitions."""
    if case not in PAPER_SIMULATION:
        return []
    height, paper = 1e3 * values["bed_height_mean"]["value"], PAPER_SIMULATION[case]
    spread = ", ".join(f"{label} {1e3 * values[name]['value']:.1f}" for name, label in SPREAD
                       if name in values)
    return [f"| {case} | the same | {height:.4g} | {paper:g} | {100 * (height / paper - 1):+.1f} % "
            "| | simulation of the paper |",
            f"| {case} | bed height / mm by other definitions | {spread} | | | | |"]


def number_table(runs):
    rows = ["| case | quantity | here | reference | deviation | | reference from, or what it is |",
            "|" + "---|" * 7]
    for case, summary in runs.items():
        values = {quantity["name"]: quantity for quantity in summary["quantities"]}
        for name, label, scale, unit in BED if case.startswith("1") else DIE:
            if name in values:
                rows.append(number_row(case, name, values, label, scale, unit))
            elif name in expected_splashes(values):
                rows.append(f"| {case} | {label} | none | | | **miss** | |")
        rows += bed_rows(case, values)
        balance = values["momentum_balance_residual"]["value"]
        rows.append(f"| {case} | vertical balance, largest residual over the weight | {balance:.1e} | 0 +- {BALANCE:g} "
                    f"| | {'pass' if balance <= BALANCE else '**miss**'} | |")
    return rows


def page(runs):
    notes = (STORE / "notes.md").read_text()
    sensitivity = STORE / "sensitivity.md"
    pictures = [f"![case {case}](validation/{case}.png)\n" for case in runs
                if (STORE / f"{case}.png").exists()]
    missing = [case for case in CASES if case not in runs]
    lines = ["# The paper's six cases", "",
             "Mori, Wu and Sakai (Powder Technology, 2019): a fluidized bed with four tubes at 0.2 (1-1) and "
             "0.3 m/s (1-2), and die filling from 40 and 120 mm of CP-102 (2-1, 2-2) and NONPAREIL "
             "(3-1, 3-2). This page is made by `examples/validation.py` from `docs/validation/*.json`; "
             "l and springs that are not the paper's are set bold.", "", "## Runs", "", *run_table(runs), ""]
    if missing:
        lines += [f"Not run yet: {', '.join(missing)}.", ""]
    lines += ["## Numbers", "", *number_table(runs), "", notes]
    if sensitivity.exists():
        lines += ["## What the bed's numbers depend on", "", (STORE / "sensitivity_notes.md").read_text(),
                  sensitivity.read_text()]
    lines += ["## Pictures", "", *pictures]
    return "\n".join(lines).rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directories", nargs="*", type=pathlib.Path, metavar="DIRECTORY")
    parser.add_argument("--run", type=pathlib.Path, metavar="DIRECTORY",
                        help="run the cases there first")
    parser.add_argument("--paper", action="store_true", help="at the paper's size (hours each)")
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    options.add_limits(parser)
    chosen = parser.parse_args()
    for directory in chosen.directories + (run_cases(chosen) if chosen.run else []):
        store(directory)
    runs = {case: common.read_json(STORE / f"{case}.json") for case in CASES
            if (STORE / f"{case}.json").exists()}
    PAGE.write_text(page(runs))
    print(f"{PAGE}: cases {', '.join(runs)}")


if __name__ == "__main__":
    main()
