#!/usr/bin/env python3
"""Runs gasgrain-sdf as a user would.

usage: gasgrain_sdf_test.py GASGRAIN_SDF
"""
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import zlib

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


def volume_error(case, directory, spacing, interpolation):
    """Relative to the exact volume of the ball."""
    result = run(case, "--body", "ball", "--spacing", str(spacing), "-o",
                 os.path.join(directory, "ball.h5"), "--interpolation", interpolation)
    assert result.returncode == 0, result.stderr
    exact = 4 / 3 * math.pi * 0.004**3
    return abs(number(r"solid volume +(\S+)", result.stdout) - exact) / exact


def write_box_stl(path, size, defects):
    """Binary STL of a box from the origin, in mm; with defects: a duplicate, a triangle turned."""
    corners = [[size[d] * (n >> d & 1) for d in range(3)] for n in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    if defects:
        triangles[4] = triangles[4][::-1]
        triangles.append(triangles[7])
    with open(path, "wb") as file:
        file.write(b"box".ljust(80) + struct.pack("<I", len(triangles)))
        for t in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *(x for n in t for x in corners[n]), 0))


def check_picture(path):
    """The slice through the middle of the ball: solid in the middle, flow domain in the corner."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, {}
    while at < len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        name, content = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(name + content)
        chunks[name] = content
        at += 12 + size
    columns, rows = struct.unpack(">II", chunks[b"IHDR"][:8])
    lines = zlib.decompress(chunks[b"IDAT"])
    assert len(lines) == rows * (3 * columns + 1)

    def pixel(x, y):
        start = int(y * rows) * (3 * columns + 1) + 1 + 3 * int(x * columns)
        return tuple(lines[start:start + 3])

    ball = pixel((0.02 + 2e-3) / 0.054, 1 - (0.02 + 2e-3) / 0.044)
    assert ball[0] < 180 and ball[0] > ball[2], ball  # a warm grey
    assert pixel(0.99, 0.01) == (255, 255, 255)


def check_stl(directory, fails):
    box, out = os.path.join(directory, "box.stl"), os.path.join(directory, "box.h5")
    write_box_stl(box, (20, 10, 30), defects=True)
    done = run("--stl", box, "--scale", "1e-3", "--rotate", "0", "0", "1", "90", "--translate",
               "0.1", "0", "0", "--spacing", "1e-3", "-o", out)
    assert done.returncode == 0, done.stderr
    assert "1            triangles that are there more than once" in done.stdout, done.stdout
    assert "1            triangles turned round" in done.stdout, done.stdout
    assert abs(number(r"solid volume +(\S+)", done.stdout) / 6e-6 - 1) < 0.02
    lower = [float(x) for x in re.search(r"box +\((.*?)\)", done.stdout).group(1).split(",")]
    assert abs(lower[0] - 0.082) < 1e-6 and abs(lower[1] + 0.008) < 1e-6, lower  # margin 8 mm

    # the same through a case file, as a sheet and as a vessel
    case = os.path.join(directory, "stl.toml")
    with open(case, "w") as file:
        file.write('[[body]]\nname = "walls"\n'
                   'stl = {file = ["box.stl"], scale = 1e-3, sheet_thickness = 4e-3}\n'
                   '[[body]]\nname = "vessel"\n'
                   'complement = {stl = {file = "box.stl", scale = 1e-3}}\n')
    for name in ("walls", "vessel"):
        made = run(case, "--body", name, "--spacing", "1e-3", "-o", out, "--lower", "0", "0", "0",
                   "--upper", "0.02", "0.01", "0.03")
        assert made.returncode == 0, made.stderr

    cut = os.path.join(directory, "cut.stl")
    with open(box, "rb") as whole, open(cut, "wb") as part:
        part.write(whole.read()[:300])
    fails("cut short", "--stl", cut, "--spacing", "1e-3", "-o", out)
    fails("cannot read STL", "--stl", "none.stl", "--spacing", "1e-3", "-o", out)
    fails("--spacing", "--stl", box, "-o", out)


def main():
    with tempfile.TemporaryDirectory() as directory:
        case = os.path.join(directory, "case.toml")
        with open(case, "w") as file:
            file.write(CASE)

        last = []
        for interpolation in ("linear", "quadratic"):
            errors = [volume_error(case, directory, h, interpolation) for h in (1e-3, 5e-4, 2.5e-4)]
            orders = [math.log2(a / b) for a, b in zip(errors, errors[1:])]
            print(interpolation, "volume errors", errors, "orders", orders)
            # over both halvings: on few cells per radius the errors of single spacings scatter
            assert sum(orders) / 2 > 1.7
            last.append(errors[-1])
        assert last[1] < 0.5 * last[0]

        picture = os.path.join(directory, "slice.png")
        inspected = run("--inspect", os.path.join(directory, "ball.h5"), "--picture", picture)
        check_picture(picture)
        assert inspected.returncode == 0 and "closed         yes" in inspected.stdout
        assert number(r"spacing +(\S+)", inspected.stdout) == 2.5e-4

        # an SDF file serves as the body of another case
        with open(os.path.join(directory, "second.toml"), "w") as file:
            file.write('[[body]]\nname = "copy"\nfile = "ball.h5"\n')
        copy = [os.path.join(directory, "second.toml"), "--body", "copy", "--spacing", "1e-3",
                "--lower", "0.01", "0", "0.01", "--upper", "0.03", "0.01", "0.03",
                "-o", os.path.join(directory, "copy.h5")]
        assert "give a narrower band" in run(*copy).stderr
        assert "four spacings more" in run(*copy, "--band", "2e-3").stderr
        copied = run(*copy, "--band", "2e-3", "--interpolation", "linear")
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
        check_stl(directory, fails)


if __name__ == "__main__":
    main()
