"""gasgrain-gas as a user meets it: files of a good run, one clear error for a bad one.

Usage: gasgrain_gas_test.py GASGRAIN_GAS MPIEXEC
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from gas_case import changed, gas_case, inlet  # noqa: E402

CASE = gas_case((0.004, 0.004, 0.0156), (2, 2, 13), below=inlet(0.01), density=10,
                viscosity=1.5e-3) + """
[fixed_bed]
void_fraction = 0.451335
diameter = 1e-3
[run]
end_time = 1e-3
step = 1e-4
[output]
interval = 5e-4
"""


def run(program, directory, text, ranks=1, out="out"):
    path = os.path.join(directory, "case.toml")
    with open(path, "w") as file:
        file.write(text)
    command = [program[1], "-n", str(ranks), "--oversubscribe", program[0], path]
    command += ["--out", os.path.join(directory, out)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def check(condition, message):
    if not condition:
        sys.exit("FAILED: " + message)


def good_run_writes_its_files(program, directory):
    result = run(program, directory, CASE, ranks=2)
    check(result.returncode == 0, result.stderr)
    out = os.path.join(directory, "out")
    files = sorted(os.listdir(out))
    check(files == sorted(["gas.csv", "gas.xdmf", "summary.json"] +
                           ["gas_%06d.h5" % n for n in range(3)]), str(files))
    with open(os.path.join(out, "gas.csv")) as file:
        rows = list(csv.DictReader(file))
    check(len(rows) == 10, "%d rows" % len(rows))
    drop = float(rows[-1]["z_lower_pressure_Pa"]) - float(rows[-1]["z_upper_pressure_Pa"])
    check(abs(drop - 115.09) < 0.005 * 115.09, "pressure drop %g Pa" % drop)
    check(abs(float(rows[-1]["time_s"]) - 1e-3) < 1e-15, rows[-1]["time_s"])
    check("time left" in result.stdout and "z_lower" in result.stdout, result.stdout)
    with open(os.path.join(out, "summary.json")) as file:
        quantities = {q["name"]: q["value"] for q in json.load(file)["quantities"]}
    check(quantities["steps"] == 10, str(quantities))
    check(abs(quantities["z_lower_pressure"] - float(rows[-1]["z_lower_pressure_Pa"])) < 1e-6,
          str(quantities))


def a_frame_holds_the_chosen_fields(program, directory):
    text = changed(CASE, "interval = 5e-4", 'fields = ["pressure"]')
    result = run(program, directory, text, ranks=2)
    check(result.returncode == 0, result.stderr)
    with open(os.path.join(directory, "out", "gas.xdmf")) as file:
        index = file.read()
    check('Name="pressure"' in index and 'Name="velocity"' not in index, index)


BAD = [
    ("an unknown key", ("density", "densty"), "did you mean 'density'"),
    ("a value out of range", ("density = 10", "density = -10"), "gas.density: is -10"),
    ("no end time", ("end_time = 1e-3", ""), "run.end_time"),
    ("a body outside", ("[run]", "[[body]]\nname = 'far'\nsphere = {center = [9, 9, 9], "
                        "radius = 1}\n[run]"), "body 'far'"),
    ("no outlet", ('{type = "outlet"}', '{type = "slip"}'), "has no outlet"),
    ("checkpoints without a place", ("end_time = 1e-3", "end_time = 1e-3\ncheckpoint_interval = -1"),
     "run.checkpoint_interval: is -1"),
    ("not TOML", ("[gas]", "[gas"), "not valid TOML"),
]


def bad_runs_say_why_once(program, directory):
    for name, (old, new), expected in BAD:
        result = run(program, directory, changed(CASE, old, new), ranks=2)
        check(result.returncode != 0, name + ": exit code 0")
        check(result.stderr.count("gasgrain-gas: error:") == 1, name + ": " + result.stderr)
        check(expected in result.stderr, name + ": " + result.stderr)
    thin = changed(CASE, "[2, 2, 13]", "[1, 1, 2]")
    result = run(program, directory, thin, ranks=3)
    check(result.returncode != 0 and "fewer ranks" in result.stderr, result.stderr)


# case, replacements, what the message must say
FAILING = [
    ("[numerics]\npressure_iterations = 1\npressure_tolerance = 1e-12\n"
     "pressure_fallback = \"none\"\n",
     ["step 1 from 0 s, dt = ", "the pressure equation is not solved", "in cell (",
      "likely cause"]),
    ("[initial]\nvelocity = [0, 0, 1e12]\n",
     ["the step had to fall to", "velocity z = 1e+12 in cell (0, 0, 1) at (0.001, 0.001, 0.0018) m",
      "initial.velocity"]),
]


def failing_steps_name_step_cell_field_and_cause(program, directory):
    for text, expected in FAILING:
        for ranks in (1, 2):
            result = run(program, directory, CASE + text, ranks)
            check(result.returncode == 1, result.stdout)
            check(result.stderr.count("gasgrain-gas: error:") == 1, result.stderr)
            for part in expected:
                check(part in result.stderr, "'%s' is not in: %s" % (part, result.stderr))


def a_missing_file_is_an_error(program, directory):
    result = subprocess.run([program[0], os.path.join(directory, "nope.toml")],
                            capture_output=True, text=True, timeout=60)
    check(result.returncode == 1 and "cannot read case file" in result.stderr, result.stderr)


def main():
    program = (sys.argv[1], sys.argv[2])
    for test in (good_run_writes_its_files, a_frame_holds_the_chosen_fields,
                 bad_runs_say_why_once,
                 failing_steps_name_step_cell_field_and_cause, a_missing_file_is_an_error):
        with tempfile.TemporaryDirectory() as directory:
            test(program, directory)
        print("ok", test.__name__)


main()
