"""A crowd between flat walls moves alike whatever the walls are: fix wall/sdf or stock primitives.

Reference: stock fix wall/gran with our contact law in the stock loop on one rank. Grains touch, roll
and part while neighbour lists are built some forty times.
"""

import unittest

from engine_scenes import RADIUS, SCALE, SIDE, WALLS, crowd, files, scene
from liggghts_run import Bench, dump_command, largest_difference

PRIMITIVES = "".join(
    f"fix p{number} all wall/gran model cgm tangential history primitive type 2 {plane}\n"
    for number, plane in enumerate(("xplane 0.0", f"xplane {2 * SIDE}", "yplane 0.0",
                                    f"yplane {SIDE}", "zplane 0.0", f"zplane {2 * SIDE}")))


class CrowdBetweenWalls(unittest.TestCase):
    def frames(self, walls, engine, ranks=1):
        # smaller than the lattice, so that none begins at exactly its radius from a wall
        bench = Bench(files(crowd(radii=(0.97 * RADIUS,))))
        bench.run(f"gasgrain_engine {engine}\n" + scene(walls=walls) + dump_command("d", 100)
                  + "run 2000\n", ranks=ranks)
        return bench.frames("d.dump")

    def test_signed_distances_equal_stock_primitives(self):
        reference = self.frames(PRIMITIVES, "off")
        for walls, engine, ranks in ((WALLS, "off", 1), (WALLS, "off", 2), (WALLS, "fused", 1),
                                     (WALLS, "fused", 2), (PRIMITIVES, "fused", 2)):
            with self.subTest(walls="sdf" if walls is WALLS else "primitive", engine=engine,
                              ranks=ranks):
                frames = self.frames(walls, engine, ranks)
                self.assertLess(largest_difference(frames[:4], reference[:4], SCALE), 1e-11)
                self.assertLess(largest_difference(frames, reference, SCALE), 1e-8)


if __name__ == "__main__":
    unittest.main()
