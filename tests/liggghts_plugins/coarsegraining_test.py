"""The command `coarsegraining`: what is the grain's, what the original particle's, and what stock
LIGGGHTS scales. The claims of docs/coarse_graining.md."""

import unittest

from liggghts_run import (Bench, Grain, STOCK_OPTIONS, cgm_properties, data_file, dump_command,
                          largest_difference, preamble, stock_properties)

R0, L = 1e-4, 5.0
BOX = [-5e-3] * 3, [5e-3] * 3
PAIR = [Grain((-1.001 * L * R0, 0, 0), L * R0, (0.1, 0, 0)),
        Grain((1.001 * L * R0, 2e-4, 0), L * R0, type=2)]
CGM = "cgm tangential history"
STOCK = f"hooke/stiffness tangential history {STOCK_OPTIONS}"


def script(ratio, properties, model, more="", steps=0, every=1):
    return (preamble("pair.data", skin=1e-4, commands=ratio) + properties +
            f"pair_style gran model {model}\npair_coeff * *\ntimestep 1e-6\n{more}\n"
            f"fix integrate all nve/sphere\n" +
            dump_command("d", every, "x y z vx vy vz radius mass density type") +
            f"run {steps}\n")


def cgm(ratio, more="", **options):
    return script(ratio, cgm_properties(2), CGM, more, **options)


def bench():
    return Bench({"pair.data": data_file(PAIR, *BOX, types=2)})


class Conventions(unittest.TestCase):
    def radii(self, more, ratio="coarsegraining 5\n"):
        b = bench()
        b.run(cgm(ratio, more))
        return {i: values[6] for i, values in b.frames("d.dump")[-1].items()}

    def test_data_files_and_dumps_hold_the_grain(self):
        for radius in self.radii("").values():
            self.assertAlmostEqual(radius / (L * R0), 1, delta=1e-12)

    def test_set_diameter_gives_the_original(self):
        radii = self.radii(f"set atom 1 diameter {R0}\n")
        self.assertAlmostEqual(radii[1] / (L * R0 / 2), 1, delta=1e-12)
        self.assertAlmostEqual(radii[2] / (L * R0), 1, delta=1e-12)

    def test_template_radius_is_the_originals_for_every_type(self):
        template = f"""region r block -4e-3 4e-3 -4e-3 4e-3 1e-3 4e-3 units box
fix t all particletemplate/sphere 15485863 atom_type 2 density constant 2500 radius constant {R0}
fix m all particledistribution/discrete 32452843 1 t 1.0
fix i all insert/pack seed 49979687 distributiontemplate m insert_every once overlapcheck yes &
    particles_in_region 5 region r
run 2
"""
        for ratio in ("coarsegraining 5\n", "coarsegraining 5 5\n", "coarsegraining 3 5\n"):
            radii = self.radii(template, ratio)
            self.assertEqual(len(radii), 7)
            for i in range(3, 8):
                self.assertAlmostEqual(radii[i] / (L * R0), 1, delta=1e-12)

    def test_table_tells_original_and_grain_once(self):
        b = bench()
        log = b.run(cgm("coarsegraining 5 2\n") + "run 0\n").log
        rows = [line.split() for line in log.splitlines()]
        self.assertEqual(rows.count(["1", "5", "0.0002", "0.001", "1", "125"]), 1)
        self.assertEqual(rows.count(["2", "2", "0.0005", "0.001", "1", "8"]), 1)

    def test_without_the_command_nothing_is_printed(self):
        self.assertNotIn("oarse graining:", bench().run(cgm("")).log)


class StockModels(unittest.TestCase):
    def test_stock_model_that_does_not_scale_is_an_error_by_default(self):
        run = bench().run(script("coarsegraining 5\n", stock_properties(10, 1e-5, 1e-5), STOCK),
                          check=False)
        self.assertNotEqual(run.code, 0)
        self.assertIn("coarse-graining: model hooke/stiffness", run.text)

    def test_ratio_one_leaves_stock_models_alone(self):
        bench().run(script("coarsegraining 1\n", stock_properties(10, 1e-5, 1e-5), STOCK))

    def test_stock_hooks_scale_kn_by_l_and_gamman_abs_by_l_squared(self):
        def motion(ratio, k_n, gamma_n):
            b = bench()
            properties = stock_properties(10, 2e-5, 2e-5)
            properties = properties.replace("kn peratomtypepair 2 10 10 10 10",
                                            f"kn peratomtypepair 2 {f'{k_n} ' * 4}")
            old = [line for line in properties.splitlines() if "gamman_abs" in line][0]
            new = f"fix gn all property/global gamman_abs peratomtypepair 2 {f'{gamma_n} ' * 4}"
            b.run(script(ratio, properties.replace(old, new), STOCK, steps=2000, every=50))
            return b.frames("d.dump")

        scaled = motion("coarsegraining 5 model_check warn\n", 10, 2e-5)
        by_hand = motion("", 50, 50e-5)
        scale = [R0] * 3 + [0.1] * 3 + [R0, 1e-9, 2500, 1]
        self.assertLess(largest_difference(scaled, by_hand, scale), 1e-10)
        plain = motion("", 10, 2e-5)
        self.assertGreater(largest_difference(scaled, plain, scale), 1e-3)


if __name__ == "__main__":
    unittest.main()
