"""What the bed height and the pressure drop depend on: one cheap bed, one change at a time.

    sensitivity.py DIRECTORY [--grain L] [--cell MM] [--only NAME ...]

runs what is not complete in DIRECTORY yet, one after the other, and writes sensitivity.md there.
"""

import argparse
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import common  # noqa: E402

ORIGINAL = 0.1  # mm, diameter of the original particle


def base(chosen):
    return ["--grain", f"{chosen.grain:g}", "--cell", f"{chosen.cell:g}", "--time", "2",
            "--start-up", "0.8", "--no-pictures"]


def variants(chosen):
    """Name -> options of run.py in place of those of the base."""
    kernel = max(0.8 * chosen.cell, 1.2 * ORIGINAL * chosen.grain)  # mm, the default
    return {
        "base": [],
        "narrow kernel": ["--kernel", f"{0.52 * kernel:.3g}"],
        "wide kernel": ["--kernel", f"{1.6 * kernel:.3g}"],
        "exact overlap": ["--mapping", "exact"],
        "finer cells": ["--cell", f"{chosen.cell / 1.5:.5g}", "--kernel", f"{kernel:.3g}"],
        "stiffer spring": ["--spring", "2.5"],
        "less friction": ["--friction", "0.1"],
        "more friction": ["--friction", "0.5"],
        "softer impacts": ["--restitution", "0.6"],
        "Beetstra": ["--drag", "beetstra"],
        "Koch-Hill": ["--drag", "koch-hill"],
        "Di Felice": ["--drag", "difelice"],
        "tubes apart": ["--tubes", "12.5", "37.5", "20", "40"],
        "tubes higher": ["--tubes", "15", "35", "25", "45"],
        "shorter gas step": ["--gas-step", "5e-5"],
        "smaller l": ["--grain", f"{0.8 * chosen.grain:g}"],
        "l halved": ["--grain", f"{0.5 * chosen.grain:g}"],
    }


def row(name, words, directory):
    values = common.read_summary(directory)
    pressure = values["pressure_drop_mean"]
    return (f"| {name} | {words} "
            f"| {1e3 * values['bed_height_mean']['value']:.1f} "
            f"+- {1e3 * values['bed_height_half_width']['value']:.1f} "
            f"| {1e3 * values['bed_height_void_0.7_mean']['value']:.1f} "
            f"| {1e3 * values['bed_height_solid_99_mean']['value']:.1f} "
            f"| {1e3 * values['bed_height_twice_centre_mean']['value']:.1f} "
            f"| {values['bubble_fraction_mean']['value']:.3f} "
            f"| {pressure['value']:.0f} +- {values['pressure_drop_half_width']['value']:.0f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--only", nargs="+", metavar="NAME", help="names of the table's rows")
    parser.add_argument("--grain", type=float, default=20, help="l of the base (default %(default)g)")
    parser.add_argument("--cell", type=float, default=2.5, help="its cells, mm (default %(default)g)")
    parser.add_argument("--ranks", default="1")
    chosen = parser.parse_args()
    rows = ["| | options | height / mm | at 0.7 | 99 % solid | twice centre | bubbles "
            "| pressure drop / Pa |", "|" + "---|" * 8]
    known = variants(chosen)
    unknown = set(chosen.only or []) - set(known)
    if unknown:
        parser.error(f"no rows {sorted(unknown)}; there are {', '.join(known)}")
    for name, arguments in known.items():
        out = chosen.directory / name.replace(" ", "_")
        if name in (chosen.only or known):
            subprocess.run([sys.executable, str(HERE / "run.py"), *base(chosen), *arguments,
                            "--ranks", chosen.ranks, "--out", str(out)], check=True)
        if (out / "summary.json").exists():
            rows.append(row(name, " ".join(arguments or base(chosen)[:-1]), out))
    table = "\n".join(rows) + "\n"
    (chosen.directory / "sensitivity.md").write_text(table)
    print(table)


if __name__ == "__main__":
    main()
