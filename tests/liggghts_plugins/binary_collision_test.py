"""Two grains collide: model cgm against stock hooke/stiffness with absolute damping, and against the
published numbers (l = 1: overlap 3.436e-7 m, contact time 1.137e-5 s, largest force 1.722e-5 N)."""

import unittest

from liggghts_run import (Bench, Grain, STOCK_OPTIONS, cgm_properties, damping, data_file,
                          dump_command, largest_difference, preamble, sphere_mass,
                          stock_properties, thermo)

R0, DENSITY, K, E = 50e-6, 2500.0, 50.0, 0.9
SPEED, STEP = 0.1, 2e-8


def collision_bench(l, offset):
    """Grain 1 flies along x at grain 2, which rests `offset` radii beside its path and spins."""
    radius = l * R0
    gap = (4 - offset**2)**0.5 * radius + 1e-9
    pair = [Grain((-gap, 0, 0), radius, (SPEED, 0, 0)),
            Grain((0, offset * radius, 0), radius, spin=(0, 0.1 * SPEED / radius, 0))]
    half = 10 * radius
    return Bench({"pair.data": data_file(pair, [-half] * 3, [half] * 3, types=2)})


def collision_script(l, model, properties, ratio=1.0, steps=900):
    return (preamble("pair.data", skin=0.2 * l * R0, l=ratio) + properties +
            f"pair_style gran model {model}\npair_coeff * *\ntimestep {STEP}\n"
            "fix integrate all nve/sphere\n" +
            dump_command("d", 10, "x y z vx vy vz omegax omegay omegaz fx tqz") +
            f"run {steps}\n")


def cgm(l, options="", steps=900):
    return collision_script(l, f"cgm tangential history {options}",
                            cgm_properties(types=2, k=K, e=E), ratio=l, steps=steps)


def stock(l):
    mass = sphere_mass(l * R0, DENSITY)
    eta = damping(E, mass / 2, l**3 * K)
    return collision_script(l, f"hooke/stiffness tangential history {STOCK_OPTIONS}",
                            stock_properties(l**3 * K, eta, eta))


def head_on_impact(frames, radius):
    """Largest overlap and force, and duration of contact, from densely dumped frames."""
    overlaps = [2 * radius - (f[2][0] - f[1][0]) for f in frames]
    touching = [o for o in overlaps if o > 0]
    return max(overlaps), max(abs(f[1][9]) for f in frames), len(touching) * STEP * 10


class BinaryCollision(unittest.TestCase):
    def assert_equal_to_stock(self, offset):
        for l in (1.0, 5.0, 10.0):
            with self.subTest(l=l):
                bench = collision_bench(l, offset)
                bench.run(stock(l))
                reference = bench.frames("d.dump")
                bench.run(cgm(l))
                frames = bench.frames("d.dump")
                radius = l * R0
                force = max(abs(f[1][9]) for f in reference)
                scale = [radius] * 3 + [SPEED] * 3 + [SPEED / radius] * 3 + [force, force * radius]
                self.assertLess(largest_difference(frames, reference, scale), 1e-11)
                self.assertGreater(abs(reference[-1][2][3]), 0.01 * SPEED)  # they did collide

    def test_head_on_equals_stock(self):
        self.assert_equal_to_stock(offset=0.0)

    def test_oblique_equals_stock(self):
        self.assert_equal_to_stock(offset=1.2)

    def test_head_on_has_published_values(self):
        for l, n, factors in ((1.0, 3, (1, 1, 1)), (5.0, 3, (1, 125, 1)), (10.0, 3, (1, 1000, 1)),
                              (5.0, 1, (5, 25, 5))):
            with self.subTest(l=l, n=n):
                bench = collision_bench(l, offset=0.0)
                bench.run(cgm(l, f"stiffness_exponent {n}", steps=900 * factors[2]))
                overlap, force, duration = head_on_impact(bench.frames("d.dump"), l * R0)
                self.assertAlmostEqual(overlap / (3.436e-7 * factors[0]), 1, delta=1e-3)
                self.assertAlmostEqual(force / (1.722e-5 * factors[1]), 1, delta=1e-3)
                # the contact is sampled every 2e-7 s
                self.assertAlmostEqual(duration, 1.137e-5 * factors[2], delta=3e-7)

    def test_contact_forces_of_computes_equal_stock(self):
        """compute pair/gran/local, and the virial (stress/atom)."""
        more = ("compute c all pair/gran/local pos vel id force torque history\n"
                "dump c all local 50 c.dump c_c[1] c_c[2] c_c[7] c_c[13] c_c[14] c_c[16] c_c[17] "
                "c_c[18] c_c[19] c_c[20] c_c[21] c_c[22] c_c[23] c_c[24]\n"
                "compute s all stress/atom\ncompute p all reduce sum c_s[1] c_s[2] c_s[4]\n"
                "thermo_style custom step atoms ke c_p[1] c_p[2] c_p[3]\nthermo 50\n"
                "thermo_modify format float %.12g norm no\nrun ")
        bench = collision_bench(5.0, offset=1.2)
        rows = []
        for script in (stock(5.0), cgm(5.0)):
            log = bench.run(script.replace("run ", more)).log
            contacts = [[float(word) for word in line.split()]
                        for line in (bench.directory / "c.dump").read_text().splitlines()
                        if not line.startswith("ITEM")]
            table = [1, 5, 2 * R0, 10 * R0, 2, 250]  # of the coarsegraining command
            rows.append([row for row in thermo(log) + contacts if len(row) > 5 and row != table])
        self.assertGreater(sum(len(row) == 14 for row in rows[0]), 5)  # contacts were listed
        for expected, found in zip(*rows, strict=True):
            for a, b in zip(expected, found, strict=True):
                # dumps show six digits
                self.assertAlmostEqual(a, b, delta=2e-5 * abs(a) + 1e-15)

    def test_unlike_ratios_conserve_momentum(self):
        gap = ((7 * R0)**2 - (2 * R0)**2)**0.5 + 1e-9
        bench = Bench({"pair.data": data_file(
            [Grain((-gap, 0, 0), 2 * R0, (SPEED, 0, 0)),
             Grain((0, 2 * R0, 0), 5 * R0, type=2)], [-2e-3] * 3, [2e-3] * 3, types=2)})
        script = cgm(1.0).replace("read_data", "coarsegraining 2 5 model_check warn\nread_data")
        bench.run(script)
        frames = bench.frames("d.dump")
        masses = sphere_mass(2 * R0, DENSITY), sphere_mass(5 * R0, DENSITY)
        for frame in frames:
            for axis in range(3):
                momentum = sum(m * frame[i][3 + axis] for i, m in enumerate(masses, 1))
                self.assertAlmostEqual(momentum / (masses[0] * SPEED), 1.0 if axis == 0 else 0.0,
                                       delta=1e-13)
        self.assertLess(frames[-1][1][3], 0.5 * SPEED)

    def test_frozen_grain_is_a_wall(self):
        """A frozen partner neither moves nor counts as inertia: e is that of a wall contact."""
        bench = collision_bench(5.0, offset=0.0)
        script = cgm(5.0, steps=1500).replace(
            "dump d", "group rest id 2\nfix hold rest freeze\ndump d", 1).replace(
                "fix integrate all", "group free id 1\nfix integrate free")
        bench.run(script)
        last = bench.frames("d.dump")[-1]
        self.assertAlmostEqual(last[1][3] / SPEED, -E, delta=1e-4)
        self.assertEqual(last[2][3], 0.0)


if __name__ == "__main__":
    unittest.main()
