#!/usr/bin/env python3
"""Runs gasgrain-sdf as a user would.

usage: gasgrain_sdf_test.py GASGRAIN_SDF
"""
import math
import os
import re
import subprocess
import sys
import tempfile

CASE = """
[grid]
lower = [0, 0, 0]
upper = [0.05, 0.01, 0.04]
[[body]]
name = "ball"
sphere = {center = [0.02, 0.005, 0.02], radius = 0.004}
[[body]]
name = "tube"
cylinder = {point = [0.02, 0, 0.02], axis = [0, 1, 0], radius = 0.004}
"""


def run(*arguments):
    return subprocess.run([sys.argv[1], *arguments], capture_output=True, text=True)


def number(pattern, text):
    return float(re.search(pattern, text).group(1))


def volume_error(case, directory, spacing):
    """Relative to the exact volume of the ball."""
    result = run(case, "--body", "ball", "--spacing", str(spacing), "-o",
                 os.path.join(directory, "ball.h5"))
    assert result.returncode == 0, result.stderr
    exact = 4 / 3 * math.pi * 0.004**3
    return abs(number(r"solid volume +(\S+)", result.stdout) - exact) / exact


def main():
    with tempfile.TemporaryDirectory() as directory:
        case = os.path.join(directory, "case.toml")
        with open(case, "w") as file:
            file.write(CASE)

        errors = [volume_error(case, directory, h) for h in (1e-3, 5e-4, 2.5e-4)]
        orders = [math.log2(a / b) for a, b in zip(errors, errors[1:])]
        print("volume errors", errors, "orders", orders)
        assert min(orders) > 1.8

        inspected = run("--inspect", os.path.join(directory, "ball.h5"))
        assert inspected.returncode == 0 and "closed         yes" in inspected.stdout
        assert number(r"spacing +(\S+)", inspected.stdout) == 2.5e-4

        # an SDF file serves as the body of another case
        with open(os.path.join(directory, "second.toml"), "w") as file:
            file.write('[[body]]\nname = "copy"\nfile = "ball.h5"\n')
        copy = [os.path.join(directory, "second.toml"), "--body", "copy", "--spacing", "1e-3",
                "--lower", "0.01", "0", "0.01", "--upper", "0.03", "0.01", "0.03",
                "-o", os.path.join(directory, "copy.h5")]
        assert "give a narrower band" in run(*copy).stderr
        copied = run(*copy, "--band", "2e-3")
        assert copied.returncode == 0, copied.stderr

        def fails(text, *arguments):
            result = run(*arguments)
            assert result.returncode != 0 and text in result.stderr + result.stdout, result

        out = os.path.join(directory, "x.h5")
        fails("did you mean 'ball'", case, "--body", "bal", "--spacing", "1e-3", "-o", out)
        fails("body not closed", case, "--body", "tube", "--spacing", "1e-3", "-o", out)
        fails("--spacing", case, "--body", "ball", "-o", out)
        fails("no/x.h5", case, "--body", "ball", "--spacing", "1e-3", "-o",
              os.path.join(directory, "no/x.h5"))
        fails("missing.h5", "--inspect", "missing.h5")
        fails("cannot read case file", "missing.toml", "--body", "b", "--spacing", "1", "-o", out)
        assert not os.path.exists(out)
        assert run(case, "--body", "tube", "--spacing", "1e-3", "-o", out,
                   "--allow-cut").returncode == 0
        assert os.path.exists(out)


if __name__ == "__main__":
    main()
