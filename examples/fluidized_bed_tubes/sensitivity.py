"""What the bed height and the pressure drop depend on: one cheap bed, one change at a time.

    sensitivity.py DIRECTORY [--only NAME ...]     runs what is not there yet, one after the other
"""

import argparse
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import common  # noqa: E402

BASE = ["--grain", "20", "--cell", "2.5", "--time", "2", "--start-up", "0.8", "--no-pictures"]
VARIANTS = {
    "base": [],
    "narrow kernel": ["--kernel", "1.25"],
    "wide kernel": ["--kernel", "4"],
    "finer cells": ["--cell", "1.6667", "--kernel", "2.4"],
    "stiffer spring": ["--spring", "2.5"],
    "less friction": ["--friction", "0.1"],
    "more friction": ["--friction", "0.5"],
    "Beetstra": ["--drag", "beetstra"],
    "Koch-Hill": ["--drag", "koch-hill"],
    "Di Felice": ["--drag", "difelice"],
    "tubes apart": ["--tubes", "12.5", "37.5", "20", "40"],
    "tubes higher": ["--tubes", "15", "35", "25", "45"],
    "shorter gas step": ["--gas-step", "5e-5"],
    "l = 16": ["--grain", "16"],
    "l = 10": ["--grain", "10"],
}


def row(name, arguments, directory):
    values = common.read_summary(directory)
    pressure = values["pressure_drop_mean"]
    return (f"| {name} | {' '.join(arguments) or ' '.join(BASE[:-1])} "
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
    parser.add_argument("--only", nargs="+", choices=VARIANTS, default=list(VARIANTS))
    parser.add_argument("--ranks", default="1")
    chosen = parser.parse_args()
    rows = ["| | options | height / mm | at 0.7 | 99 % solid | twice centre | bubbles | pressure drop / Pa |",
            "|---|---|---|---|---|---|---|---|"]
    for name, arguments in VARIANTS.items():
        out = chosen.directory / name.replace(" ", "_")
        if name in chosen.only:
            subprocess.run([sys.executable, str(HERE / "run.py"), *BASE, *arguments, "--ranks",
                            chosen.ranks, "--out", str(out)], check=True)
        if (out / "summary.json").exists():
            rows.append(row(name, arguments, out))
    table = "\n".join(rows) + "\n"
    (chosen.directory / "sensitivity.md").write_text(table)
    print(table)


if __name__ == "__main__":
    main()
