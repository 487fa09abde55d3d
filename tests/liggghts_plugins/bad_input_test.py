"""Bad input ends every rank with one clear error."""

import concurrent.futures
import unittest

from liggghts_run import Bench, Grain, cgm_properties, data_file, preamble

R = 2.5e-4
BOX = [-2e-3] * 3, [2e-3] * 3
GRAINS = data_file([Grain((0, 0, 0), R), Grain((1e-3, 0, 0), R)], *BOX, types=2)
CASE = """
[[body]]
name = "floor"
plane = {point = [0, 0, -1e-3], normal = [0, 0, 1]}
[[body]]
name = "gas only"
acts_on = ["gas"]
plane = {point = [0, 0, -1e-3], normal = [0, 0, 1]}
[[body]]
name = "narrow band"
sphere = {center = [0, 0, 0], radius = 4e-4}
spacing = 5e-5
band = 1e-4
lower = [-1e-3, -1e-3, -1e-3]
upper = [1e-3, 1e-3, 1e-3]
"""
FLOOR = "fix w all wall/sdf case case.toml body floor type 2\n"


def script(coarsegraining="coarsegraining 5", properties=cgm_properties(2),
           pair="gran model cgm tangential history", wall=FLOOR, late=""):
    return (preamble("grains.data", skin=1e-5, commands=coarsegraining + "\n") + properties +
            f"pair_style {pair}\npair_coeff * *\n{late}\ntimestep 1e-6\n"
            f"fix integrate all nve/sphere\n{wall}run 10\n")


def without(name):
    return "".join(line + "\n" for line in cgm_properties(2).splitlines() if name not in line)


CASES = {
    "ratio below one": (script("coarsegraining 0.5"), ["coarsegraining", "0.5", ">= 1"]),
    "ratio not a number": (script("coarsegraining five"), ["coarsegraining", "'five'"]),
    "no ratio": (script("coarsegraining"), ["coarsegraining", "needs l"]),
    "ratio for three of two types": (script("coarsegraining 2 3 4"), ["3 values", "2 atom types"]),
    "model check": (script("coarsegraining 2 model_check maybe"), ["model_check", "'maybe'"]),
    "coarsegraining after pair_style":
        (script("", late="coarsegraining 5"), ["must come before pair_style"]),
    "coarsegraining twice":
        (script("coarsegraining 5\ncoarsegraining 5"), ["coarsegraining", "twice"]),
    "missing spring constant":
        (script(properties=without("cgmSpringConstant")), ["missing property", "cgmSpringConstant"]),
    "missing restitution": (script(properties=without("coefficientRestitution")),
                            ["missing property", "coefficientRestitution"]),
    "missing friction":
        (script(properties=without("coefficientFriction")), ["missing property", "coefficientFriction"]),
    "restitution above one":
        (script(properties=cgm_properties(2, e=1.1)), ["coefficientRestitution", "1.1", "(0, 1]"]),
    "negative spring":
        (script(properties=cgm_properties(2, k=-50.0)), ["cgmSpringConstant", "-50"]),
    "unknown keyword":
        (script(pair="gran model cgm tangential history stifness_exponent 3"),
         ["'stifness_exponent'", "did you mean 'stiffness_exponent'"]),
    "exponent out of range":
        (script(pair="gran model cgm tangential history stiffness_exponent 4"), ["4", "[1, 3]"]),
    "rolling friction": (script(pair="gran model cgm tangential history rolling_friction cdt"),
                         ["model cgm", "rolling friction"]),
    "missing case file": (script(wall="fix w all wall/sdf case no.toml body floor type 2\n"),
                          ["no.toml"]),
    "missing body file": (script(wall="fix w all wall/sdf body no.h5 type 2\n"), ["no.h5"]),
    "file that is no SDF": (script(wall="fix w all wall/sdf body grains.data type 2\n"),
                            ["grains.data"]),
    "unknown body": (script(wall="fix w all wall/sdf case case.toml body flor type 2\n"),
                     ["flor", "floor"]),
    "body for gas only": (script(wall="fix w all wall/sdf case case.toml body 'gas only' type 2\n"),
                          ["gas only", "does not act on grains"]),
    "wall without type": (script(wall="fix w all wall/sdf case case.toml body floor\n"),
                          ["missing `type T`"]),
    "wall type out of range": (script(wall=FLOOR.replace("type 2", "type 3")), ["type = 3", "1..2"]),
    "wall keyword": (script(wall=FLOOR.replace("\n", " typo 3\n")), ["unknown keyword 'typo'"]),
    "grain larger than the band":
        (script(wall="fix w all wall/sdf case case.toml body 'narrow band' type 2\n"),
         ["narrow band", "band of 0.0001"]),
}


class BadInput(unittest.TestCase):
    def check(self, ranks):
        def run(name):
            bench = Bench({"grains.data": GRAINS, "case.toml": CASE})
            return bench.run(CASES[name][0], ranks=ranks, check=False)

        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            results = list(pool.map(run, CASES))
        for name, result in zip(CASES, results):
            with self.subTest(name):
                errors = [line for line in result.text.splitlines() if line.startswith("ERROR")]
                self.assertNotEqual(result.code, 0, result.text)
                self.assertEqual(len(errors), 1, result.text)
                for word in CASES[name][1]:
                    self.assertIn(word, errors[0])
                self.assertEqual(result.log.count("ERROR"), 1)

    def test_one_rank(self):
        self.check(1)

    def test_three_ranks(self):
        self.check(3)

    def test_good_input_runs(self):
        bench = Bench({"grains.data": GRAINS, "case.toml": CASE})
        bench.run(script())


if __name__ == "__main__":
    unittest.main()
