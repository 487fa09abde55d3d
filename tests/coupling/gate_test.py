"""Grains on a gate between a sealed die and a vented shoe; the gate is drawn aside in the run."""

import unittest

import coupled_bed as bed

OPENS = 0.004  # s
TOP = 0.0066  # of the gate, m
GATE = f"""
[[body]]
name = "gate"
box = {{lower = [-0.0002, -1, 0.0035], upper = [0.0077, 1, {TOP}]}}
motion = {{translate = {{velocity = [1.5, 0, 0]}}, start = {OPENS}}}
"""


def case():
    text = bed.case(bottom="no-slip", coupling="series_interval = 5e-4", interval=0.1)
    tube = text.index('[[body]]\nname = "tube"')
    after = text.index("[numerics]")
    text = text[:tube] + GATE + text[after:]
    return text.replace("pressure_tolerance = 1e-10", "pressure_tolerance = 1e-13")


def script(runs):
    return bed.script(runs).replace("body tube", "body gate").replace("fix tube", "fix gate")


def grains_on_gate():
    """The lattice of the small bed, of the part that is above the tube, put on the gate."""
    spacing = 1.04 * bed.DIAMETER
    header, atoms = bed.grains_data().split("Atoms\n\n")
    lines = []
    for line in atoms.splitlines():
        *words, z = line.split()
        if float(z) > 0.0045:
            words[0] = str(len(lines) + 1)
            lines.append(" ".join([*words, f"{float(z) - 0.0045 + TOP + 0.2 * spacing:.9g}"]))
    count = header.split("\n\n")[1].split()[0]
    return (header.replace(f"{count} atoms", f"{len(lines)} atoms") + "Atoms\n\n"
            + "\n".join(lines) + "\n")


class Gate(unittest.TestCase):
    def test_gas_of_the_sealed_die_joins_that_of_the_shoe(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                bench = bed.Bench({"case.toml": case(), "grains.data": grains_on_gate()})
                bench.run(script("run 4500"), ranks=ranks)
                rows = bed.series(bench.directory)
                self.assertGreater(rows[-1]["time"], 0.05)
                for row in rows:
                    self.assertEqual(row["grains_outside"], 0)
                    self.assertLess(abs(row["momentum_residual"]), 1e-9)
                    for name in ("removed_mean", "third_law_residual", "pressure_force_residual",
                                 "solid_volume_residual"):
                        self.assertLess(abs(row[name]), 1e-12, f"{name} at {row['time']}")
                    self.assertLess(row["divergence"], 1e-9)
                # the sealed die is a region of its own, of which the mean is removed (rounding
                # errors here), until the gate opens; with the shoe's outlet there is none
                self.assertGreater(max(row["removed_mean"] for row in rows
                                       if row["time"] < OPENS), 0.0)
                self.assertEqual({row["removed_mean"] for row in rows
                                  if row["time"] > OPENS + 1e-3}, {0.0})
                held = [row for row in rows if 0.002 < row["time"] < OPENS]
                for row in held:  # on the gate
                    self.assertGreater(row["bed_height"], TOP)
                last = rows[-1]
                self.assertLess(last["bed_height_solid_99"], TOP)  # in the die
                # what fell drove the gas up through itself: fallen freely it would be faster
                self.assertGreater(max(row["kinetic_energy"] for row in rows),
                                   20 * held[-1]["kinetic_energy"])
                self.assertEqual(bed.quantities(bench.directory)["audit_violations"], 0)


if __name__ == "__main__":
    unittest.main()
