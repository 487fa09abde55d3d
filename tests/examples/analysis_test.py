"""Heights, splashes and plateaus of curves whose answer is known; rows of the validation page."""

import math
import pathlib
import sys
import unittest

import numpy

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
sys.path[:0] = [str(EXAMPLES), str(EXAMPLES / "die_filling")]

import analysis  # noqa: E402
import grains  # noqa: E402
import validation  # noqa: E402


def column(height, count=200_000, radius=1e-4):
    """Grains spread evenly over the shoe up to `height` above its floor."""
    position = numpy.zeros((count, 3))
    position[:, 2] = analysis.DIE_HEIGHT + height * (numpy.arange(count) + 0.5) / count
    return {"position": position, "radius": numpy.full(count, radius)}


class Heights(unittest.TestCase):
    def test_uniform_column_has_its_height_and_its_density(self):
        bed = column(0.04)
        volume = 200_000 * 4 / 3 * math.pi * 1e-12
        packed = analysis.solid_fraction_of_start(bed)
        self.assertAlmostEqual(packed, volume / (analysis.SHOE_AREA * 0.04), delta=1e-9 * packed)
        row = analysis.measure(bed, surface=0.065, packed=packed)
        self.assertAlmostEqual(row["shoe_height"], 0.04, delta=1e-9)
        self.assertEqual(row["die_height"], 0.0)

    def test_die_as_dense_as_the_shoe_was_is_full(self):
        bed = column(0.04)
        packed = analysis.solid_fraction_of_start(bed)
        moved = round(200_000 * analysis.DIE_AREA * analysis.DIE_HEIGHT / (analysis.SHOE_AREA * 0.04))
        bed["position"][:moved, 2] = 0.01
        row = analysis.measure(bed, surface=0.065, packed=packed)
        self.assertAlmostEqual(row["die_height"], analysis.DIE_HEIGHT, delta=1e-6)

    def test_upper_edge_leaves_a_thousandth_above(self):
        bed = column(0.04)
        bed["position"][:250, 2] = analysis.DIE_HEIGHT + 0.06
        row = analysis.measure(bed, surface=0.065, packed=0.6)
        self.assertAlmostEqual(row["upper_edge"], 0.06, delta=1e-9)
        bed["position"][:150, 2] = 0.01
        row = analysis.measure(bed, surface=0.065, packed=0.6)
        self.assertAlmostEqual(row["upper_edge"], 0.04, delta=1e-4)


class Splashes(unittest.TestCase):
    time = numpy.arange(0, 1.2, 0.01)

    def bumps(self, *bumps):
        return sum(height * numpy.exp(-((self.time - at) / width) ** 2) for at, height, width in bumps)

    def splashes(self, *bumps):
        sinking = 0.04 - 0.01 * self.time
        found = analysis.splashes(self.time, sinking + self.bumps(*bumps))
        return [round(time, 9) for time in found]

    def test_none_in_silence_and_below_the_threshold(self):
        self.assertEqual(analysis.splashes(self.time, 0.04 - 0.02 * self.time), [])
        self.assertEqual(self.splashes((0.5, 1.5e-3, 0.05)), [])

    def test_one_and_two(self):
        self.assertEqual(self.splashes((0.5, 0.01, 0.05)), [0.5])
        self.assertEqual(self.splashes((0.7, 0.01, 0.03), (0.85, 0.005, 0.03)), [0.7, 0.85])

    def test_a_rough_peak_is_one_splash_at_its_highest(self):
        self.assertEqual(len(self.splashes((0.5, 0.01, 0.05), (0.56, 0.008, 0.03),
                                           (0.6, 0.0085, 0.04))), 1)


class Plateau(unittest.TestCase):
    def test_longest_constant_stretch_is_found(self):
        time = numpy.arange(0, 1, 0.002)
        pressure = numpy.interp(time, [0, 0.2, 0.6, 1.0], [0, 300, 300, 0])
        begin, end, level = analysis.plateau({"time": time, "pressure_drop": pressure})
        # 10 % about the middle of 300 and p: from p = 300 (1 - 0.1) / (1 + 0.1) on
        margin = 1 - 0.9 / 1.1
        self.assertAlmostEqual(begin, 0.2 - 0.2 * margin, delta=0.015)
        self.assertAlmostEqual(end, 0.6 + 0.4 * margin, delta=0.015)
        self.assertAlmostEqual(level, 291, delta=6)

    def test_rest_after_the_die_is_full_does_not_count(self):
        time = numpy.arange(0, 2, 0.002)
        pressure = numpy.interp(time, [0, 0.1, 0.3, 0.4], [300, 300, 300, 1])
        begin, end, level = analysis.plateau({"time": time, "pressure_drop": pressure})
        self.assertLess(begin, 0.02)
        self.assertAlmostEqual(end, 0.3, delta=0.03)
        self.assertGreater(level, 280)


class Steps(unittest.TestCase):
    def test_contact_time_of_the_paper(self):
        # the paper's bed: 1.137e-5 s for 50 um, 2500 kg/m^3, 50 N/m, e = 0.9
        self.assertAlmostEqual(grains.contact_time(50e-6, 2500, 50, 0.9), 1.137e-5, delta=1e-8)

    def test_step_divides_the_exchange_and_is_short_enough(self):
        step = grains.time_step(1.137e-5, 2e-4)
        self.assertLessEqual(step, 1.137e-5 / 8)
        self.assertAlmostEqual(2e-4 / step, round(2e-4 / step), delta=1e-9)
        self.assertGreater(step, 0.98 * 1.137e-5 / 8)


class Page(unittest.TestCase):
    def row(self, value, reference, tolerance, name="final_shoe_height"):
        quantity = {"name": name, "value": value, "reference": reference, "tolerance": tolerance,
                    "source": "s"}
        return validation.number_row("2-1", name, {name: quantity}, "label", 1e3, "mm")

    def test_pass_and_miss(self):
        self.assertIn("| pass ", self.row(0.025, 0.0241, 1e-3 / 0.0241))
        self.assertIn("**miss**", self.row(0.0252, 0.0241, 1e-3 / 0.0241))
        self.assertIn("**miss**", self.row(1, 2, 0.0))
        self.assertIn("| pass ", self.row(0, 0, 0.0))

    def test_without_reference_there_is_no_verdict(self):
        row = self.row(0.025, None, None)
        self.assertNotIn("pass", row)
        self.assertNotIn("miss", row)

    def test_every_row_has_the_columns_of_the_head(self):
        for row in (self.row(0.025, 0.0241, 0.1), self.row(0.025, None, None)):
            self.assertEqual(row.count("|"), 8, row)

    def test_ratio_that_is_not_the_papers_is_marked(self):
        self.assertEqual(validation.marked_ratio({"l": 5.0, "paper_l": 5}), "5")
        self.assertIn("**10**", validation.marked_ratio({"l": 10.0, "paper_l": 5}))


if __name__ == "__main__":
    unittest.main()
