"""fix wall/sdf that a script moves: by keywords as by the case file, by variables, across restarts, in
both time loops; springs at a concave edge across ranks."""

import unittest

from liggghts_run import Bench, Grain, cgm_properties, data_file, largest_difference
from wall_sdf_test import (BODIES, BOX, E, K, L, RADIUS, SCALE, SPEED, STEP, flying_grain, script,
                           with_sdf)

# bodies of wall_sdf_test that move by the case file, at rest and for grains alone
RESTING = """
[[body]]
name = "still_piston"
plane = {point = [0, 0, -0.3e-3], normal = [0, 0, 1]}
acts_on = ["grains"]
[[body]]
name = "still_paddle"
box = {lower = [-1e-3, -0.2e-3, -1e-3], upper = [1e-3, -0.3e-4, -0.3e-3]}
acts_on = ["grains"]
[[body]]
name = "gas_plane"
plane = {point = [0, 0, -0.3e-3], normal = [0, 0, 1]}
"""
CASE = BODIES.replace("[grid]", RESTING + "[grid]")
THROWN = flying_grain((0.06, 0.01, -SPEED))
# a floor that swings with 0.05 mm at 500 Hz
SWING = ("variable z equal 5e-5*sin(2*PI*500*step*dt)\n"
         "variable w equal 5e-5*2*PI*500*cos(2*PI*500*step*dt)\n")


def bench_of(grains):
    return Bench({"case.toml": CASE, "grains.data": data_file(grains, *BOX, types=2)})


def moved(body, keywords, variables="", mode="fused", **options):
    text = script(L, "cgm tangential history", cgm_properties(2, K, E),
                  f"fix w all wall/sdf case case.toml body {body} type 2 {keywords}", **options)
    return f"gasgrain_engine {mode}\n{variables}{text}"


def frames_of(text, grains=THROWN, ranks=1):
    bench = bench_of(grains)
    bench.run(text, ranks=ranks)
    return bench.frames("d.dump")


class Keywords(unittest.TestCase):
    def assert_same(self, first, second, tolerance=1e-12):
        self.assertLess(largest_difference(first, second, SCALE), tolerance)
        turned = max(abs(a - b) for a, b in zip(first[0][1][3:6], first[-1][1][3:6]))
        self.assertGreater(turned, 0.1 * SPEED)  # it did bounce

    def test_translate_and_rotate_are_those_of_the_case_file(self):
        for body, keywords in (
                ("piston", "translate 0.03 -0.02 0.05"),
                ("paddle", "rotate 0 0 -0.3e-3 0 1 0 80")):
            with self.subTest(body=body):
                grains = flying_grain((0.06, -0.08, -SPEED))
                self.assert_same(frames_of(moved(f"still_{body}", keywords, steps=20000), grains),
                                 frames_of("gasgrain_engine fused\n" + with_sdf(body, steps=20000),
                                           grains))

    def test_a_velocity_by_variable_is_a_translation(self):
        variables = "variable a equal 0.03\nvariable b equal -0.02\nvariable c equal 0.05\n"
        self.assert_same(frames_of(moved("still_piston", "velocity v_a v_b v_c", variables)),
                         frames_of(moved("still_piston", "translate 0.03 -0.02 0.05")), 1e-9)

    def test_a_swinging_floor_by_displacement_velocity_and_keyword_is_one_motion(self):
        """The velocity that goes with a displacement lags by half a step, of a 5000th of a period;
        the damping of a bounce feels that."""
        oscillate = frames_of(moved("still_piston", "oscillate 0 0 5e-5 0.002"))
        for keywords in ("displacement NULL NULL v_z", "velocity NULL NULL v_w"):
            with self.subTest(keywords=keywords):
                self.assert_same(frames_of(moved("still_piston", keywords, SWING)), oscillate, 2e-3)


class Variables(unittest.TestCase):
    def test_both_loops_agree(self):
        frames = [frames_of(moved("still_piston", "displacement NULL NULL v_z", SWING, mode=mode))
                  for mode in ("off", "fused")]
        self.assertLess(largest_difference(*frames, SCALE), 1e-9)

    def test_a_wall_alone_comes_to_grains_at_rest(self):
        rise = "variable z equal 0.2*step*dt\n"
        for mode in ("off", "fused"):
            frames = frames_of(moved("still_piston", "displacement NULL NULL v_z", rise, mode=mode),
                               flying_grain((0, 0, 0), spin=(0, 0, 0)))
            self.assertGreater(frames[-1][1][5], 0.2)  # thrown upwards

    def test_a_variable_of_the_grains_needs_the_stock_loop(self):
        bench = bench_of(THROWN)
        text = moved("still_piston", "displacement NULL NULL v_z", "variable z equal 1e-9*ke\n",
                     mode="auto", steps=100)
        self.assertIn("moved by variables of more than the time", bench.run(text).log)

    def test_a_restart_finds_the_wall_where_it_was(self):
        for keywords in ("displacement NULL NULL v_z", "velocity NULL NULL v_w"):
            with self.subTest(keywords=keywords):
                text = moved("still_piston", keywords, SWING)
                bench = bench_of(THROWN)
                bench.run(text.replace("run 8000", "restart 3000 r1 r2\nrun 3000\nrun 5000"))
                whole = bench.frames("d.dump")[-1]
                bench.run(text.replace("read_data grains.data", "read_restart r1")
                          .replace("run 8000", "run 5000"))
                self.assertLess(
                    largest_difference([bench.frames("d.dump")[-1]], [whole], SCALE), 1e-12)


class Mistakes(unittest.TestCase):
    def test_are_told(self):
        for body, keywords, words in (
                ("gas_plane", "translate 0 0 1", "acts on the gas"),
                ("piston", "translate 0 0 1", "has a `motion`"),
                ("still_piston", "translate 0 1", "needs 3 values"),
                ("still_piston", "rotate 0 0 0 0 0 0 1", "axis must not be zero"),
                ("still_piston", "oscillate 0 0 1 0", "period"),
                ("still_piston", "start 1", "start and stop belong"),
                ("still_piston", "displacement NULL NULL z", "'z' is no variable"),
                ("still_piston", "displacement NULL NULL v_none", "no variable 'none'"),
                ("still_piston", "translate 1 0 0 velocity v_z NULL NULL", "stands alone"),
                ("still_piston", "displacement NULL NULL v_far", "it could pass grains")):
            with self.subTest(keywords=keywords):
                variables = SWING + "variable far equal 0.01*step\n"
                bench = bench_of(THROWN)
                result = bench.run(moved(body, keywords, variables, steps=100), check=False)
                self.assertNotEqual(result.code, 0)
                self.assertIn(words, " ".join(result.text.split()))


class EdgeAcrossRanks(unittest.TestCase):
    def test_springs_of_an_edge_move_with_the_grain(self):
        """A grain slides along an edge from one rank to the other."""
        grains = [Grain((-2e-5, -5.001e-5, -5.001e-5), RADIUS, (0.05, 0, 0), (0, 3, 0))]
        pull = "fix gravity all gravity 10 vector 0 -0.6 -0.8\n"
        text = with_sdf("bin", steps=12000, every=200, extra=pull)
        text = text.replace("newton off", "newton off\nprocessors * 1 1")
        one, two = frames_of(text, grains), frames_of(text, grains, ranks=2)
        self.assertGreater(one[-1][1][0], 1e-5)  # it has crossed x = 0
        self.assertLess(largest_difference(two, one, SCALE), 1e-9)


if __name__ == "__main__":
    unittest.main()
