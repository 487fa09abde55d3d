"""Runs LIGGGHTS scripts with gasgrain or stock liggghts and reads what they write."""

import dataclasses
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import weakref

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from mpi_environment import patient_environment  # noqa: E402

GASGRAIN = os.environ["GASGRAIN_EXECUTABLE"]
MPIEXEC = os.environ.get("GASGRAIN_MPIEXEC", "mpiexec")

ENVIRONMENT = patient_environment()


def stock_liggghts():
    program = shutil.which(os.environ.get("LIGGGHTS_EXECUTABLE", "liggghts"))
    if program is None:
        raise RuntimeError("stock liggghts not found: apt install liggghts, "
                           "or set LIGGGHTS_EXECUTABLE")
    return program


@dataclasses.dataclass
class Run:
    code: int
    text: str  # stdout and stderr
    log: str


class Bench:
    """A scratch directory in which scripts run; files that scripts read are put there first."""

    def __init__(self, files=None):
        self.directory = pathlib.Path(tempfile.mkdtemp(prefix="gasgrain-test-"))
        weakref.finalize(self, shutil.rmtree, self.directory, ignore_errors=True)
        for name, text in (files or {}).items():
            (self.directory / name).write_text(text)

    def run(self, script, ranks=1, program=None, name="in.script", check=True):
        (self.directory / name).write_text(script)
        # `-screen none` crashes stock LIGGGHTS with meshes and insertion: the screen is captured
        command = [program or GASGRAIN, "-in", name, "-log", "log.txt"]
        if ranks > 1:
            command = [MPIEXEC, "--oversubscribe", "-n", str(ranks), *command]
        done = subprocess.run(command, cwd=self.directory, env=ENVIRONMENT, text=True,
                              errors="replace", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=240)
        if check and done.returncode != 0:
            raise AssertionError(f"{command} failed:\n{done.stdout[-3000:]}")
        log = self.directory / "log.txt"
        return Run(done.returncode, done.stdout,
                   log.read_text(errors="replace") if log.exists() else "")

    def frames(self, name):
        return read_dump(self.directory / name)


def read_dump(path):
    """Frames of a custom text dump whose first column is id: {id: (values...)} per frame."""
    frames, lines = [], path.read_text().splitlines()
    at = 0
    while at < len(lines):
        if lines[at].startswith("ITEM: ATOMS"):
            frames.append({})
            at += 1
            while at < len(lines) and not lines[at].startswith("ITEM:"):
                values = lines[at].split()
                frames[-1][int(values[0])] = tuple(float(v) for v in values[1:])
                at += 1
        else:
            at += 1
    return frames


def thermo(log):
    """The rows of all thermo tables of a log whose lines are numbers only."""
    rows = []
    for line in log.splitlines():
        try:
            rows.append([float(word) for word in line.split()])
        except ValueError:
            continue
    return [row for row in rows if len(row) > 2]


def dump_command(name, every, columns="x y z vx vy vz omegax omegay omegaz"):
    formats = " ".join(["%d"] + ["%.17g"] * len(columns.split()))
    return (f"dump {name} all custom {every} {name}.dump id {columns}\n"
            f"dump_modify {name} format '{formats}' sort id\n")


def largest_difference(frames, others, scale):
    """Largest difference of two dumps, each column relative to scale[column]."""
    assert len(frames) == len(others) and frames, (len(frames), len(others))
    largest = 0.0
    for frame, other in zip(frames, others):
        assert frame.keys() == other.keys()
        for key, values in frame.items():
            for value, reference, unit in zip(values, other[key], scale):
                assert math.isfinite(value) and math.isfinite(reference)
                largest = max(largest, abs(value - reference) / unit)
    return largest


@dataclasses.dataclass
class Grain:
    position: tuple
    radius: float  # the grain's, m
    velocity: tuple = (0.0, 0.0, 0.0)
    spin: tuple = (0.0, 0.0, 0.0)
    density: float = 2500.0
    type: int = 1


def data_file(grains, lower, upper, types=1):
    """A LIGGGHTS data file; ids count from 1 in the order given."""
    def row(*values):
        return " ".join(v if isinstance(v, str) else f"{v:.17g}" for v in values)

    lines = ["grains", "", f"{len(grains)} atoms", f"{types} atom types"]
    lines += [row(lower[d], upper[d], f"{'xyz'[d]}lo", f"{'xyz'[d]}hi") for d in range(3)]
    lines += ["", "Atoms", ""]
    lines += [row(i, g.type, 2 * g.radius, g.density, *g.position)
              for i, g in enumerate(grains, 1)]
    lines += ["", "Velocities", ""]
    lines += [row(i, *g.velocity, *g.spin) for i, g in enumerate(grains, 1)]
    return "\n".join(lines) + "\n"


def preamble(data, skin, l=1.0, boundary="f f f", commands=""):
    """The part every script begins with; grains come from the data file `data`."""
    ratio = f"coarsegraining {l:.17g} model_check warn\n" if l != 1 else ""
    # LIGGGHTS multiplies the skin of `neighbor` by l
    return f"""units si
atom_style granular
atom_modify map array
boundary {boundary}
newton off
communicate single vel yes
{commands}{ratio}read_data {data}
neighbor {skin / l:.17g} bin
neigh_modify delay 0
"""


def cgm_properties(types=1, k=50.0, e=0.9, mu=0.3):
    def matrix(name, value):
        values = " ".join([f"{value:.17g}"] * types**2)
        return f"fix {name} all property/global {name} peratomtypepair {types} {values}\n"

    return (matrix("cgmSpringConstant", k) + matrix("coefficientRestitution", e) +
            matrix("coefficientFriction", mu))


def damping(e, effective_mass, k):
    """eta = -2 ln e sqrt(m_eff k / (pi^2 + ln^2 e)), docs/coarse_graining.md."""
    return -2 * math.log(e) * math.sqrt(effective_mass * k / (math.pi**2 + math.log(e)**2))


def stock_properties(k, eta_pair, eta_wall, mu=0.3):
    """hooke/stiffness with absolute damping; type 1 grains, type 2 walls. No coarsegraining here:
    all values are the grain's own."""
    def matrix(name, pair, wall):
        return (f"fix {name} all property/global {name} peratomtypepair 2 "
                f"{pair:.17g} {wall:.17g} {wall:.17g} {wall:.17g}\n")

    return (matrix("kn", k, k) + matrix("kt", k, k) + matrix("gamman_abs", eta_pair, eta_wall) +
            matrix("gammat_abs", eta_pair, eta_wall) + matrix("coefficientFriction", mu, mu))


STOCK_OPTIONS = "absolute_damping on tangential_damping on limitForce off"


def sphere_mass(radius, density):
    return density * 4 / 3 * math.pi * radius**3
