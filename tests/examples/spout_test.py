"""Spout, annulus and fountain of fields and grains whose answer is known."""

import math
import pathlib
import sys
import unittest

import numpy

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
sys.path[:0] = [str(EXAMPLES), str(EXAMPLES / "spouted_bed")]

import analysis  # noqa: E402


class Spout(unittest.TestCase):
    x = analysis.WIDTH * (numpy.arange(25) + 0.5) / 25

    def test_width_lies_between_the_changes_of_sign(self):
        rise = 0.012**2 - (self.x - 0.05) ** 2  # a parabola that ends 12 mm from the axis
        self.assertAlmostEqual(analysis.spout_width(self.x, rise), 0.024, delta=4e-4)

    def test_without_return_or_rise_there_is_no_spout(self):
        self.assertTrue(math.isnan(analysis.spout_width(self.x, numpy.ones(25))))
        self.assertTrue(math.isnan(analysis.spout_width(self.x, -numpy.ones(25))))

    def test_one_side_alone_is_none(self):
        self.assertTrue(math.isnan(analysis.spout_width(self.x, self.x - 0.05)))


class Annulus(unittest.TestCase):
    def test_level_of_the_outer_columns(self):
        height = numpy.linspace(0, analysis.HEIGHT, 63)
        middles = 0.5 * (height[1:] + height[:-1])
        void = numpy.repeat(numpy.clip(0.4 + (middles - 0.05) * 40, 0.4, 1)[:, None], 25, axis=1)
        void[:, 10:15] = 1.0  # the spout is empty
        self.assertAlmostEqual(analysis.annulus_height(void), 0.06, delta=1e-9)

    def test_empty_and_full(self):
        self.assertEqual(analysis.annulus_height(numpy.ones((62, 25))), 0.0)
        self.assertEqual(analysis.annulus_height(numpy.full((62, 25), 0.4)), analysis.HEIGHT)


class Grains(unittest.TestCase):
    def test_mean_motion_of_two_streams(self):
        position = numpy.array([[0.05, 0.006, 0.1], [0.05, 0.006, 0.1], [0.002, 0.006, 0.002]])
        velocity = numpy.array([[0.2, 0, 1.0], [-0.2, 0, 2.0], [0, 0, -0.1]])
        count, motion = analysis.mean_motion([{"position": position, "velocity": velocity}] * 3,
                                             25, 62)
        self.assertEqual(count.sum(), 3)
        numpy.testing.assert_allclose(motion[25, 12], [0, 1.5], atol=1e-15)
        numpy.testing.assert_allclose(motion[0, 0], [0, -0.1])

    def test_a_thousandth_flies_above_the_fountain(self):
        position = numpy.zeros((10001, 3))
        position[:, 2] = numpy.linspace(0, 0.1, 10001)
        self.assertAlmostEqual(analysis.fountain_top({"position": position}), 0.0999, delta=1e-9)


class Estimates(unittest.TestCase):
    def test_minimum_fluidization_of_glass_in_air(self):
        # Ar = 90 830: Re = sqrt(1135.7 + 3705.9) - 33.7 = 35.88
        value = analysis.minimum_fluidization_velocity(1e-3, 2500, 1.2, 1.8e-5)
        self.assertAlmostEqual(value, 35.88 * 1.8e-5 / 1.2e-3, delta=2e-4)


if __name__ == "__main__":
    unittest.main()
