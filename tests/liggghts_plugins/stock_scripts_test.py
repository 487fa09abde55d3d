"""With the engine off, scripts without any of our styles give the same log as stock liggghts, character
for character."""

import re
import unittest

from liggghts_run import Bench, stock_liggghts

HEAD = """units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
region box block -0.02 0.02 -0.02 0.02 0 0.06 units box
create_box 1 box
neighbor 0.001 bin
neigh_modify delay 0
"""

HERTZ = """
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.6
fix m4 all property/global coefficientFriction peratomtypepair 1 0.4

pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix gravity all gravity 9.81 vector 0 0 -1
fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0
fix side all wall/gran model hertz tangential history primitive type 1 zcylinder 0.02 0 0
"""

INSERTION = """
region pour block -0.015 0.015 -0.015 0.015 0.03 0.055 units box
fix t1 all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.0015
fix t2 all particletemplate/sphere 15485867 atom_type 1 density constant 2500 radius constant 0.002
fix mix all particledistribution/discrete 32452843 2 t1 0.4 t2 0.6
fix ins all insert/rate/region seed 86028121 distributiontemplate mix nparticles 300 massrate 0.8 &
    insert_every 500 overlapcheck yes vel constant 0 0 -0.5 region pour
"""

POUR = HEAD + HERTZ + INSERTION + """
fix integrate all nve/sphere
compute spin all erotate/sphere
thermo_style custom step atoms ke c_spin
thermo 500
run 4000
write_restart pour.restart
run 500
"""

RESTARTED = """units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
read_restart pour.restart
neighbor 0.001 bin
neigh_modify delay 0
""" + HERTZ + """
fix integrate all nve/sphere
thermo_style custom step atoms ke
thermo 100
run 1000
"""

# a tetrahedron standing in the box
TETRAHEDRON = "solid t\n" + "".join(
    f"facet normal 0 0 1\nouter loop\n{''.join(f'vertex {v}{chr(10)}' for v in corners)}"
    "endloop\nendfacet\n" for corners in (
        ("-0.01 -0.01 0.005", "0.01 -0.01 0.005", "0 0.012 0.005"),
        ("-0.01 -0.01 0.005", "0.01 -0.01 0.005", "0 0 0.015"),
        ("0.01 -0.01 0.005", "0 0.012 0.005", "0 0 0.015"),
        ("0 0.012 0.005", "-0.01 -0.01 0.005", "0 0 0.015"))) + "endsolid t\n"

MESH = HEAD + """
fix m1 all property/global kn peratomtypepair 1 2000
fix m2 all property/global kt peratomtypepair 1 2000
fix m3 all property/global gamman_abs peratomtypepair 1 0.05
fix m4 all property/global gammat_abs peratomtypepair 1 0.05
fix m5 all property/global coefficientFriction peratomtypepair 1 0.4
pair_style gran model hooke/stiffness tangential history absolute_damping on
pair_coeff * *
timestep 1e-5
fix gravity all gravity 9.81 vector 0 0 -1
fix stl all mesh/surface file tetrahedron.stl type 1
fix mesh all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes stl &
    absolute_damping on
fix floor all wall/gran model hooke/stiffness tangential history primitive type 1 zplane 0 &
    absolute_damping on
""" + INSERTION + """
fix integrate all nve/sphere
compute spin all erotate/sphere
thermo_style custom step atoms ke c_spin
thermo 500
run 6000
"""

# what differs between two runs of one program: times of day, durations and shares of time
VARYING = re.compile(r"^gasgrain_engine |Setting up run at|Loop time of|time \(%\) =|CPU|compiled|log\.txt")


def comparable(log):
    return [line for line in log.splitlines() if not VARYING.search(line)]


class StockScripts(unittest.TestCase):
    def assert_same(self, scripts, ranks=1):
        logs = []
        for program, head in ((stock_liggghts(), ""), (None, "gasgrain_engine off\n")):
            bench = Bench({"tetrahedron.stl": TETRAHEDRON})
            logs.append([comparable(bench.run(head + s, ranks=ranks, program=program).log)
                         for s in scripts])
        self.assertEqual(logs[0], logs[1])
        self.assertGreater(len(logs[1][0]), 20)

    def test_hertz_pour_with_insertion_and_restart(self):
        self.assert_same([POUR, RESTARTED])

    def test_hooke_with_mesh_wall(self):
        self.assert_same([MESH])

    def test_hertz_pour_on_two_ranks(self):
        self.assert_same([POUR], ranks=2)


if __name__ == "__main__":
    unittest.main()
