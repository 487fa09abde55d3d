"""The engine's search for pairs gives LIGGGHTS's own list: same pairs, order and histories.

Reference: the same script with `neigh_modify exclude` of two types that no pair of grains has; for
it LIGGGHTS builds the list itself. A pair that is missing or elsewhere in the list changes sums in
their last digit, which the collisions of a crowd amplify: the dumps would differ. Pairs that never
touch show in the number of pairs that LIGGGHTS prints after a run.
"""

import dataclasses
import re
import unittest

from engine_scenes import RADIUS, SIDE, UNWRAPPED, crowd, files, scene
from liggghts_run import Bench, data_file, dump_command

REST = dump_command("d", 200, UNWRAPPED) + "thermo 1000\n" + "run 200\n" * 5
EXCLUDE = "neigh_modify exclude type 2 2\n"  # walls only are of type 2
FAR = 100.0  # m


def far_away():
    """The crowd at the far end of a long box, where single precision resolves ten micrometres."""
    moved = [dataclasses.replace(grain, position=(FAR + grain.position[0], *grain.position[1:]))
             for grain in crowd()]
    return {"grains.data": data_file(moved, [0, 0, 0], [FAR + 2 * SIDE, SIDE, 2 * SIDE], 2)}


class PairSearch(unittest.TestCase):
    def check(self, text, scene_files, ranks=1, options=""):
        dumps, counts = [], []
        for addition in (EXCLUDE, ""):
            bench = Bench(scene_files)
            run = bench.run(f"gasgrain_engine fused {options}\n" + text + addition + REST, ranks)
            self.assertIn("Engine: fused", run.text)
            dumps.append((bench.directory / "d.dump").read_text())
            counts.append(re.findall(r"Total # of neighbors = (\d+)", run.log))
            builds = re.findall(r"Neighbor list builds = (\d+)", run.log)
            self.assertEqual(len(builds), 5)
            self.assertNotIn("0", builds)
        self.assertEqual(*counts)
        self.assertGreater(min(map(int, counts[0])), 200)
        self.assertGreater(dumps[0].count("ITEM: ATOMS"), 5)
        self.assertEqual(*dumps)

    def test_many_sizes_between_walls(self):
        radii = tuple(RADIUS * (0.3 + 0.7 * n / 9) for n in range(10))
        self.check(scene(), files(crowd(radii=radii)))

    def test_code_for_any_processor(self):
        self.check(scene(), files(crowd()), options="kernel generic")

    def test_without_histories(self):
        self.check(scene(tangential="off"), files(crowd()))

    def test_periodic_and_shrink_wrapped_boxes_on_two_ranks(self):
        for boundary in ("p p p", "m p m"):
            with self.subTest(boundary=boundary):
                self.check(scene(boundary=boundary, walls=""), files(crowd()), ranks=2)

    def test_contacts_that_begin_beyond_the_radii(self):
        self.check(scene() + "neigh_modify contact_distance_factor 1.2\n", files(crowd()))

    def test_far_from_the_corner_of_the_box(self):
        self.check(scene(walls=""), far_away())


if __name__ == "__main__":
    unittest.main()
