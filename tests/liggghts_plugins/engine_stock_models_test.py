"""The fused engine moves grains of unchanged LIGGGHTS scripts as the stock loop does.

Reference: the same executable with `gasgrain_engine off`, as in engine_test.py.
"""

import unittest

from engine_scenes import (FORCES, RADIUS, SCALE, SIDE, EngineTest, crowd, files, reference_log,
                           scene, thermo_of)
from liggghts_run import Bench, dump_command, largest_difference, preamble, thermo


def matrices(types, **values):
    """`fix property/global` of one value, or of a list of values, for all pairs of types."""
    text = ""
    for name, value in values.items():
        entries = value if isinstance(value, (list, tuple)) else [value] * types**2
        text += (f"fix {name} all property/global {name} peratomtypepair {types} " +
                 " ".join(f"{entry:.17g}" for entry in entries) + "\n")
    return text


STIFFNESSES = matrices(2, kn=[50, 40, 40, 60], kt=[40, 30, 30, 55], gamman=3e3, gammat=2e3,
                       gamman_abs=[1e-4, 8e-5, 8e-5, 2e-4], gammat_abs=1e-4,
                       coefficientFriction=[.4, .3, .3, .6])
MATERIALS = ("fix Y all property/global youngsModulus peratomtype 5e6 8e6\n"
             "fix nu all property/global poissonsRatio peratomtype 0.3 0.4\n"
             "fix V all property/global characteristicVelocity scalar 0.5\n" +
             matrices(2, coefficientRestitution=[.8, .7, .7, .9],
                      coefficientFriction=[.4, .3, .3, .6]))


def stock_scene(model, properties, moving="all", groups="", last=""):
    """Grains between stock walls of the same model, without any style of ours."""
    names, *options = model.split(" with ")
    options = " ".join(options)
    walls = "".join(f"fix {name} all wall/gran model {names} primitive type 2 {kind} {place:.17g} "
                    f"{options}\n"
                    for name, kind, place in (
                        ("west", "xplane", 0), ("east", "xplane", 2 * SIDE), ("south", "yplane", 0),
                        ("north", "yplane", SIDE), ("floor", "zplane", 0), ("lid", "zplane",
                                                                           2 * SIDE)))
    head = preamble("grains.data", skin=0.2 * RADIUS)
    return (head.replace("delay 0", "delay 0 contact_distance_factor 1.01") + properties +
            f"pair_style gran model {names} {options}\npair_coeff * *\ntimestep 4e-6\n"
            f"{groups}fix gravity all gravity 9.81 vector 0 0 -1\n"
            f"fix integrate {moving} nve/sphere\n" + walls + last)


class StockModels(EngineTest):
    """Scripts of plain LIGGGHTS users, with every model and option that is fused."""
    TWO_SIZES = {"types": 2, "radii": (RADIUS, 0.8 * RADIUS)}

    def check(self, model, properties, ranks=1, rest="", **scene_options):
        text = stock_scene(model, properties, **scene_options)
        rest = dump_command("d", 100, FORCES) + rest + "run 600\nrun 400\n"
        reference, fused, run = self.off_and_fused(text, rest, files(crowd(**self.TWO_SIZES)),
                                                   ranks)
        self.assertIn(f"Engine: fused: {model.split(' ')[0]} tangential", run.text)
        frames, others = reference.frames("d.dump"), fused.frames("d.dump")
        self.assertGreaterEqual(len(frames), 11)
        force = max(abs(value) for frame in frames for grain in frame.values()
                    for value in grain[9:12])
        self.assertGreater(force, 0)
        scale = SCALE + [force] * 3 + [force * RADIUS] * 3
        self.assertLess(largest_difference(others[:4], frames[:4], scale), 1e-10)
        self.assertLess(largest_difference(others, frames, scale), 1e-7)
        return frames, others

    def test_hooke_stiffness(self):
        for tangential in ("history", "no_history", "off"):
            for options in ("", " with absolute_damping on",
                            " with tangential_damping off limitForce on"):
                with self.subTest(tangential=tangential, options=options):
                    self.check(f"hooke/stiffness tangential {tangential}{options}", STIFFNESSES)

    def test_hooke(self):
        for tangential, options in (("history", ""), ("no_history", ""), ("off", ""),
                                    ("history", " with ktToKnUser on tangential_damping off")):
            with self.subTest(tangential=tangential, options=options):
                self.check(f"hooke tangential {tangential}{options}", MATERIALS)

    def test_hertz(self):
        for tangential, options in (("history", ""), ("no_history", ""), ("off", ""),
                                    ("history", " with tangential_damping off limitForce on")):
            with self.subTest(tangential=tangential, options=options):
                self.check(f"hertz tangential {tangential}{options}", MATERIALS)

    def test_ranks(self):
        self.check("hertz tangential history", MATERIALS, ranks=2)

    def test_frozen_grains(self):
        """A layer of grains that stays where it is; `fix freeze` reports the force on it."""
        groups = ("region low block INF INF INF INF INF " + f"{SIDE / 3:.17g} units box\n"
                  "group frozen region low\ngroup moving subtract all frozen\n")
        freeze = "fix frozen frozen freeze\n"
        rest = thermo_of("f_frozen[1] f_frozen[3]")
        for model, properties in (("hertz tangential history", MATERIALS),
                                  ("hooke/stiffness tangential history", STIFFNESSES)):
            for ranks in (1, 2):
                with self.subTest(model=model, ranks=ranks):
                    frames, _ = self.check(model, properties, ranks, rest, moving="moving",
                                           groups=groups, last=freeze)
                    still = [tag for tag, grain in frames[0].items() if grain[2] < SIDE / 3]
                    self.assertGreater(len(still), 100)
                    for tag in still:
                        self.assertEqual(frames[0][tag][:3], frames[-1][tag][:3])
        text = (scene().replace("integrate all", "integrate moving")
                .replace("fix gravity", groups + "fix gravity") + freeze)
        scene_files = files(crowd())
        logs = []
        for mode in ("off", "fused"):
            bench = Bench(scene_files)
            bench.run(f"gasgrain_engine {mode}\n" + text + rest + "run 500\n")
            logs.append(thermo(reference_log(bench)))
        for row, other in zip(*logs, strict=True):
            for a, b in zip(row[2:], other[2:], strict=True):
                self.assertLess(abs(a - b), 1e-8 * max(abs(value) for value in logs[0][-1]))

    def test_what_the_models_cannot_do_is_named(self):
        for model, properties, name in (
                ("hooke tangential history with viscous on", MATERIALS + matrices(
                    2, FluidViscosity=1e-5, CriticalStokes=10, MaximumRestitution=.9), "viscous"),
                ("hertz tangential history rolling_friction cdt", MATERIALS + matrices(
                    2, coefficientRollingFriction=.1), "pair style other than")):
            with self.subTest(name):
                text = stock_scene(model, properties)
                text = "\n".join(line for line in text.split("\n") if "wall/gran" not in line)
                run = Bench(files(crowd())).run("gasgrain_engine fused\n" + text + "run 10\n",
                                                check=False)
                self.assertNotEqual(run.code, 0)
                self.assertIn(name, run.text)


if __name__ == "__main__":
    unittest.main()
