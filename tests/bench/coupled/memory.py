#!/usr/bin/env python3
"""Memory of a coupled run per rank: 1e6 grains, 100 coupling steps, 4 ranks.

    tests/bench/coupled/memory.py BUILD_DIRECTORY [--ranks 4] [--grains 1000000] [--exchanges 100]

A packed bed of grains of 0.5 mm, 100 mm wide, on cells of 1.25 mm with air at 0.2 m/s from below,
an exchange every two DEM steps. Prints the largest resident memory of each rank since its start,
MPI's own share included, and the time per coupling step. More ranks than cores are fine: memory is
what counts. Four minutes on two busy cores.
"""

import argparse
import math
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from gas_case import body, gas_case, inlet, plane  # noqa: E402
from mpi_environment import patient_environment  # noqa: E402

DIAMETER, SPACING = 5e-4, 5.02e-4  # m
WIDTH, DEPTH = 0.1, 0.05  # m
CELL = 1.25e-3  # m
STEP = 5e-6  # s

SCRIPT = """units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
processors * * 1
coarsegraining 5 model_check warn  # create_atoms is not for l other than 1: sizes are set below
region box block 0 {width} 0 {depth} 0 {top} units box
create_box 2 box
neighbor 4e-5 bin
neigh_modify delay 0 contact_distance_factor 1.01
fix k all property/global cgmSpringConstant peratomtypepair 2 5 5 5 5
fix e all property/global coefficientRestitution peratomtypepair 2 0.9 0.9 0.9 0.9
fix mu all property/global coefficientFriction peratomtypepair 2 0.3 0.3 0.3 0.3
pair_style gran model cgm tangential history
pair_coeff * *
timestep {step}
lattice sc {spacing}
region bed block {half} {width} {half} {depth} {half} {bed} units box
create_atoms 1 region bed
set group all density 2500 diameter 1e-4
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
fix floor all wall/sdf case case.toml body floor type 2
fix gas all couple/gas case case.toml
thermo 1000000
run {steps}
"""

WORD = "LARGEST_RESIDENT_KIB"


def be_rank(command):
    """Runs the program as one rank and says what memory it took."""
    code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
    print(WORD, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, flush=True)
    sys.exit(code)


def options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, default=4)
    parser.add_argument("--grains", type=int, default=1_000_000)
    parser.add_argument("--exchanges", type=int, default=100)
    return parser.parse_args()


def write_case(directory, given):
    """Script and case file for about so many grains; returns their number."""
    layer = math.floor((WIDTH - SPACING / 2) / SPACING) * math.floor((DEPTH - SPACING / 2) / SPACING)
    layers = round(given.grains / layer)
    cells = [round(WIDTH / CELL), round(DEPTH / CELL), math.ceil(1.5 * layers * SPACING / CELL)]
    scene = {"width": WIDTH, "depth": DEPTH, "top": cells[2] * CELL, "spacing": SPACING,
             "half": SPACING / 2, "bed": (layers + 0.25) * SPACING, "step": STEP,
             "steps": 2 * given.exchanges}
    (directory / "scene.in").write_text(SCRIPT.format(**scene))
    (directory / "case.toml").write_text(
        gas_case((WIDTH, DEPTH, scene["top"]), cells, gravity=(0, 0, -9.81), below=inlet(0.2))
        + body("floor", plane((0, 0, 0), (0, 0, 1)), acts_on="grains")
        + f"[coupling]\nexchange_interval = {2 * STEP}\n")
    return cells


def main():
    given = options()
    with tempfile.TemporaryDirectory(prefix="gasgrain-memory-") as name:
        directory = pathlib.Path(name)
        cells = write_case(directory, given)
        done = subprocess.run(
            ["mpiexec", "--oversubscribe", "-n", str(given.ranks), sys.executable, "-B", __file__,
             "--be-rank", str((given.build / "bin" / "gasgrain").resolve()), "-in", "scene.in",
             "-log", "log"], cwd=directory, env=patient_environment(), text=True,
            stdout=subprocess.PIPE)
        log = (directory / "log").read_text(errors="replace")
        if done.returncode != 0:
            sys.exit(f"ERROR: exit code {done.returncode}\n" + log[-2000:])
    made = int(re.search(r"Created (\d+) atoms", log).group(1))
    sizes = sorted(int(line.split()[1]) / 1024**2 for line in done.stdout.splitlines()
                   if line.startswith(WORD))
    print(f"{made} grains, {cells[0] * cells[1] * cells[2]} gas cells, {given.ranks} ranks")
    for line in log.splitlines():
        if line.strip().startswith(("simulated", "wall time")):
            print(line)
    print("largest resident memory of the ranks: " + ", ".join(f"{size:.2f}" for size in sizes)
          + f" GiB; {1024**3 * sum(sizes) / made:.0f} bytes per grain in all")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--be-rank"]:
        be_rank(sys.argv[2:])
    main()
