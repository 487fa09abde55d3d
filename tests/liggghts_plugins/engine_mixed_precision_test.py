"""`gasgrain_engine fused precision mixed`: the same statistics as in double, and its restart files.

Reference: the same script in full precision; trajectories part (collisions are chaotic), so that
means over time and grains are compared.
"""

import statistics
import unittest

from engine_scenes import RADIUS, SCALE, EngineTest, crowd, files, scene, thermo_of
from liggghts_run import Bench, Grain, dump_command, largest_difference, sphere_mass, thermo

BODIES = ("west", "east", "south", "north", "floor", "lid")
COLUMNS = ("compute c all contact/atom\ncompute m all reduce ave c_c\n"
           "compute h all reduce ave z\ncompute r all erotate/sphere\n" +
           "variable load equal " + "+".join(f"f_{wall}[3]" for wall in BODIES) + "\n" +
           thermo_of("c_r c_m c_h v_load").replace("thermo 100\n", "thermo 50\n"))
AGITATED, SETTLED = 1000, 16000  # steps


def engine(precision):
    return f"gasgrain_engine fused precision {precision}\n"


def rows_of(precision, seed):
    """Step, grains, kinetic and rotational energy, contacts per grain, mean height, vertical load
    of the walls of a crowd that falls and comes to rest."""
    bench = Bench(files(crowd(seed=seed)))
    bench.run(engine(precision) + scene() + COLUMNS + f"run {SETTLED}\n")
    return [row for row in thermo((bench.directory / "log.txt").read_text()) if len(row) == 7]


class Statistics(EngineTest):
    def test_bed_that_falls_and_settles(self):
        seeds = (1, 2, 3)
        runs = {precision: [rows_of(precision, seed) for seed in seeds]
                for precision in ("full", "mixed")}
        self.assertNotEqual(runs["full"][0][-1], runs["mixed"][0][-1])

        def mean(precision, column, first, last):
            return statistics.fmean(row[column] for rows in runs[precision] for row in rows
                                    if first <= row[0] <= last)

        agitated, settled = (0, AGITATED), (SETTLED - 2000, SETTLED)
        for name, column, times, tolerance in (
                ("kinetic energy", 2, agitated, 0.01), ("rotational energy", 3, agitated, 0.02),
                ("contacts per grain", 4, settled, 0.02), ("mean height", 5, settled, 0.01),
                ("vertical load of the walls", 6, settled, 0.002)):
            with self.subTest(name):
                full, mixed = (mean(precision, column, *times) for precision in runs)
                self.assertLess(abs(mixed / full - 1), tolerance)
        weight = 9.81 * len(crowd()) * sphere_mass(RADIUS, Grain.density)
        self.assertLess(abs(mean("mixed", 6, *settled) / -weight - 1), 0.002)


class RestartFiles(EngineTest):
    MESSAGE = "Engine: the restart file was written in "

    def continued(self, before, after):
        """The last frame of a run of 600 steps, that of one continued after 400, and its output."""
        bench = Bench(files(crowd()))
        rest = scene() + "gasgrain_checkpoint 400 points\n" + dump_command("d", 200)
        bench.run(engine(before) + rest + "run 600\n")
        whole = bench.frames("d.dump")[-1]
        again = rest.replace("read_data grains.data", "read_restart points/grains.400.restart")
        run = bench.run(engine(after) + again + "run 600 upto\n")
        return whole, bench.frames("d.dump")[-1], run.text

    def test_same_bits_in_the_same_precision(self):
        for precision in ("full", "mixed"):
            with self.subTest(precision):
                whole, again, text = self.continued(precision, precision)
                self.assertEqual(again, whole)
                self.assertNotIn(self.MESSAGE, text)

    def test_another_precision_goes_on_with_a_message(self):
        for before, after in (("full", "mixed"), ("mixed", "full")):
            with self.subTest(before):
                whole, again, text = self.continued(before, after)
                self.assertIn(f"{self.MESSAGE}{before} precision", text)
                difference = largest_difference([again], [whole], SCALE)
                self.assertGreater(difference, 0)
                self.assertLess(difference, 1e-4)


class Command(EngineTest):
    def test_plan_names_the_precision(self):
        for words, named in (("fused precision mixed", "Engine: fused, mixed precision: cgm"),
                             ("fused precision full", "Engine: fused: cgm"),
                             ("fused", "Engine: fused: cgm")):
            run = Bench(files(crowd())).run(f"gasgrain_engine {words}\n" + scene() + "run 1\n")
            self.assertIn(named, run.text)

    def test_bad_words_are_errors_that_list_the_good_ones(self):
        for words, remedy in (("fused precision half", "full, mixed"), ("fused precision", "full"),
                              ("fused speed 3", "precision full|mixed")):
            with self.subTest(words):
                run = Bench(files(crowd())).run(f"gasgrain_engine {words}\n" + scene(), check=False)
                self.assertNotEqual(run.code, 0)
                self.assertIn(remedy, run.text)


class OtherKernels(EngineTest):
    def test_models_and_ranks_stay_near_full_precision(self):
        """Each part of the mixed code against the full one, before collisions amplify round-off."""
        for tangential, ranks in (("off", 1), ("no_history", 1), ("history", 2)):
            with self.subTest(tangential=tangential, ranks=ranks):
                benches = []
                for precision in ("full", "mixed"):
                    benches.append(Bench(files(crowd(radii=(RADIUS, 0.8 * RADIUS)))))
                    benches[-1].run(engine(precision) + scene(tangential=tangential) +
                                    dump_command("d", 100) + "run 300\n", ranks=ranks)
                self.assert_same_motion(*benches, limits=((300, 1e-4),))


if __name__ == "__main__":
    unittest.main()
