"""Adhesion and rolling friction of model cgm against exact solutions, l = 1 beside l > 1, and a
small group of grains that must be similar to its originals."""

import math
import unittest

from liggghts_run import (Bench, Grain, cgm_properties, data_file, dump_command, preamble,
                          sphere_mass)

R0, DENSITY, K = 50e-6, 2500.0, 50.0
SCALINGS = ((1.0, 3), (5.0, 3), (5.0, 1), (5.0, 2))  # l, n


def surface_properties(types, work=0.0, rolling=0.0):
    return "".join(f"fix {name} all property/global {name} peratomtypepair {types} "
                   + " ".join([f"{value:.17g}"] * types**2) + "\n"
                   for name, value in (("cgmWorkOfAdhesion", work),
                                       ("cgmRollingFriction", rolling)))


def script(l, n, properties, step, commands, steps, every=10, skin=0.3, types=2):
    return (preamble("grains.data", skin=skin * l * R0, l=l) + properties +
            f"pair_style gran model cgm tangential history stiffness_exponent {n}\n"
            f"pair_coeff * *\ntimestep {step:.17g}\nfix integrate all nve/sphere\n" + commands +
            dump_command("d", every) + f"run {steps}\n")


class RollingFriction(unittest.TestCase):
    RATE, SPEED, STEP = 0.05, 0.02, 1e-6  # mu_r, m/s, s

    def rolled(self, l, n, wall):
        """Speeds along x, a millisecond apart, of a ball that rolls without slip over a floor."""
        radius = l * R0
        # it starts where the floor carries its weight
        sink = sphere_mass(radius, DENSITY) * 9.81 / (l**n * K)
        bench = Bench({
            "grains.data": data_file([Grain((0, 0, radius - sink), radius, (self.SPEED, 0, 0),
                                            (0, self.SPEED / radius, 0))],
                                     [-0.01] * 3, [0.01] * 3, types=2),
            "floor.toml": '[[body]]\nname = "floor"\nplane = {point = [0, 0, 0], '
                          'normal = [0, 0, 1]}\n'})
        floor = {"sdf": "wall/sdf case floor.toml body floor type 2\n",
                 "plane": "wall/gran model cgm tangential history primitive type 2 zplane 0\n"}
        bench.run(script(l, n, cgm_properties(2, K, 0.9, 0.3) +
                         surface_properties(2, rolling=self.RATE), self.STEP,
                         "fix gravity all gravity 9.81 vector 0 0 -1\n"
                         f"fix floor all {floor[wall]}", steps=80000, every=1000))
        return [frame[1][3] for frame in bench.frames("d.dump")]

    def test_rolling_ball_slows_down_by_five_sevenths_of_mu_g(self):
        for wall in ("sdf", "plane"):
            for l, n in SCALINGS:
                with self.subTest(wall=wall, l=l, n=n):
                    speeds = self.rolled(l, n, wall)
                    slope = (speeds[5] - speeds[40]) / 35e-3
                    self.assertAlmostEqual(slope / (5 / 7 * self.RATE * 9.81), 1, delta=0.005)
                    self.assertLess(abs(speeds[-1]), 1e-3 * self.SPEED)  # and it has stopped


class Adhesion(unittest.TestCase):
    WORK = 0.02  # J/m^2

    def pull_off(self):
        return 2 * math.pi * self.WORK * R0 / 2

    def collide(self, l, n, speed, restitution, steps, wall=False):
        radius = l * R0
        stretch = l ** ((3 - n) / 2)  # of the contact time
        gap = 1e-9
        bench = Bench({"grains.data": data_file(
            [Grain((-radius - gap, 0, 0), radius, (speed, 0, 0)), Grain((radius, 0, 0), radius)],
            [-10 * radius] * 3, [10 * radius] * 3, types=2)})
        bench.run(script(l, n, cgm_properties(2, K, restitution, 0.3) +
                         surface_properties(2, work=self.WORK), 2e-8 * stretch, "", steps))
        return [(2 * radius - (f[2][0] - f[1][0]), f[1][3], f[2][3])
                for f in bench.frames("d.dump")]

    def test_largest_overlap_is_that_of_the_energy_balance(self):
        """(F_a + sqrt(F_a^2 + k m_eff v^2))/k, and an elastic pair flies apart as fast."""
        speed, mass = 0.1, sphere_mass(R0, DENSITY) / 2
        force = self.pull_off()
        largest = (force + math.sqrt(force**2 + K * mass * speed**2)) / K
        for l, n in SCALINGS:
            with self.subTest(l=l, n=n):
                frames = self.collide(l, n, speed, restitution=1.0, steps=1500)
                found = max(overlap for overlap, _, _ in frames)
                self.assertAlmostEqual(found / (l ** ((3 - n) / 2) * largest), 1, delta=2e-3)
                self.assertAlmostEqual(frames[-1][2] / speed, 1, delta=1e-3)

    def test_pair_sticks_below_the_same_speed_for_every_l(self):
        """e = 0.9: the pair of 0.01 m/s sticks at the overlap F_a/k, that of 0.1 m/s parts."""
        for l, n in SCALINGS:
            with self.subTest(l=l, n=n):
                slow = self.collide(l, n, 0.01, restitution=0.9, steps=60000)
                rest = self.pull_off() / K * l ** ((3 - n) / 2)
                self.assertAlmostEqual(slow[-1][0] / rest, 1, delta=1e-3)
                self.assertAlmostEqual(slow[-1][1] / 0.005, 1, delta=1e-3)
                fast = self.collide(l, n, 0.1, restitution=0.9, steps=1500)
                self.assertLess(fast[-1][0], 0.0)
                self.assertGreater(fast[-1][2] - fast[-1][1], 0.05)


class Group(unittest.TestCase):
    def test_group_is_similar_to_its_originals(self):
        """27 grains that collide, roll and stick: with n = 1 a group of l = 4 is the group of
        originals, four times as large and slow; its energy per l^3 is the same."""
        places = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]

        def energies(l):
            radius = l * R0
            grains = [Grain(tuple(2.12 * radius * p + 0.05 * radius * math.sin(7.0 * i + d)
                                  for d, p in enumerate(place)), radius,
                            tuple(-0.1 * p + 0.02 * math.cos(3.0 * i + d)
                                  for d, p in enumerate(place)),
                            tuple(200.0 / l * math.sin(5.0 * i + d) for d in range(3)))
                      for i, place in enumerate(places)]
            bench = Bench({"grains.data": data_file(grains, [-20 * radius] * 3,
                                                    [20 * radius] * 3, types=1)})
            bench.run(script(l, 1, cgm_properties(1, K, 0.9, 0.3) +
                             surface_properties(1, work=0.01, rolling=0.1), 1e-7 * l, "",
                             steps=2000, every=200))
            mass = sphere_mass(radius, DENSITY)
            return [sum(0.5 * mass * sum(v * v for v in f[3:6]) +
                        0.2 * mass * radius**2 * sum(w * w for w in f[6:9])
                        for f in frame.values()) / l**3 for frame in bench.frames("d.dump")]

        originals, grains = energies(1.0), energies(4.0)
        self.assertLess(originals[-1], 0.7 * originals[0])  # they did collide
        for a, b in zip(originals, grains, strict=True):
            self.assertAlmostEqual(b / a, 1, delta=1e-6)

    def test_momentum_is_conserved_and_engine_names_the_reason(self):
        radius = R0
        bench = Bench({"grains.data": data_file(
            [Grain((-radius, 0, 0), radius, (0.1, 0.02, 0), (300, 0, 200)),
             Grain((1.001 * radius, 0.2 * radius, 0), radius, spin=(0, 400, 0))],
            [-1e-3] * 3, [1e-3] * 3)})
        run = bench.run(script(1, 3, cgm_properties(1, K, 0.9, 0.3) +
                               surface_properties(1, work=0.02, rolling=0.2), 2e-8, "", 2000,
                               types=1))
        self.assertIn("because of adhesion or rolling friction", run.log)
        mass, inertia = sphere_mass(R0, DENSITY), 0.4 * sphere_mass(R0, DENSITY) * R0**2

        def momenta(frame):
            linear = [mass * sum(g[3 + d] for g in frame.values()) for d in range(3)]
            angular = [inertia * sum(g[6 + d] for g in frame.values()) + mass * sum(
                g[(d + 1) % 3] * g[3 + (d + 2) % 3] - g[(d + 2) % 3] * g[3 + (d + 1) % 3]
                for g in frame.values()) for d in range(3)]
            return linear, angular

        frames = bench.frames("d.dump")
        first, last = momenta(frames[0]), momenta(frames[-1])
        for a, b in zip(first[0], last[0], strict=True):
            self.assertAlmostEqual(a, b, delta=1e-12 * mass * 0.1)
        for a, b in zip(first[1], last[1], strict=True):
            self.assertAlmostEqual(a, b, delta=1e-12 * mass * 0.1 * R0)


if __name__ == "__main__":
    unittest.main()
