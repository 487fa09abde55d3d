"""The fused engine moves grains as the stock loop does while others are inserted.

Reference: the same executable on the same ranks with `gasgrain_engine off`.
"""

import unittest

from engine_scenes import FORCES, RADIUS, SIDE, EngineTest, crowd, files, plate, scene
from liggghts_run import dump_command


INSERTION = """
region factory block {lo} {hi} {lo} {hy} {mid} {hi} units box
fix template all particletemplate/sphere 15485863 atom_type 1 density constant 2500 &
    radius constant {radius}
fix mixture all particledistribution/discrete 32452843 1 template 1.0
fix insert all insert/pack seed 86028121 distributiontemplate mixture vel constant 0. 0. -0.5 &
    insert_every 200 overlapcheck yes all_in yes particles_in_region 40 region factory
""".format(lo=1e-4, hi=2 * SIDE - 1e-4, hy=SIDE - 1e-4, mid=1.4 * SIDE, radius=RADIUS)


STREAM = f"""
fix template all particletemplate/sphere 15485863 atom_type 1 density constant 2500 &
    radius constant {RADIUS}
fix mixture all particledistribution/discrete 32452843 1 template 1.0
fix face all mesh/surface/planar file face.stl type 1
fix insert all insert/stream seed 86028121 distributiontemplate mixture nparticles 60 &
    particlerate 2e4 insert_every 300 vel constant 0.1 0. -1. omega constant 30. 0. 20. &
    overlapcheck yes all_in no insertion_face face
"""
FACE = plate(1.5 * SIDE, (1.5e-3, 1.5e-3), (2 * SIDE - 1.5e-3, SIDE - 1.5e-3))


class Insertion(EngineTest):
    def test_grains_come_while_the_engine_runs(self):
        grains = [grain for grain in crowd() if grain.position[2] < SIDE]
        reference, fused, run = self.off_and_fused(
            scene(), INSERTION + dump_command("d", 100) + "run 700\n", files(grains))
        frames = self.assert_same_motion(reference, fused, ((300, 1e-10), (700, 1e-8)))
        self.assertGreater(len(frames[-1]), len(grains) + 30)
        self.assertIn("Engine: fused", run.text)

    def test_from_an_empty_box(self):
        reference, fused, _ = self.off_and_fused(
            scene().replace("read_data grains.data",
                            f"region r block 0 {2 * SIDE} 0 {SIDE} 0 {2 * SIDE} units box\n"
                            "create_box 2 r"),
            INSERTION + dump_command("d", 100) + "run 700\n", files([]))
        frames = self.assert_same_motion(reference, fused, ((300, 1e-10), (700, 1e-8)))
        self.assertGreater(len(frames[-1]), 30)

    def test_stream(self):
        """Grains of a stream move on straight lines until their release and are felt by others;
        the runs end in the middle of that."""
        grains = [grain for grain in crowd() if grain.position[2] < SIDE]
        rest = STREAM + dump_command("d", 50, FORCES) + "run 450\nrun 550\n"
        scene_files = {**files(grains), "face.stl": FACE}
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                reference, fused, run = self.off_and_fused(scene(), rest, scene_files, ranks,
                                                           reference_ranks=ranks)
                self.assertIn("insert/stream x 1", run.text)
                frames = self.assert_same_motion(reference, fused, ((300, 1e-10), (1000, 1e-8)),
                                                 every=50)
                self.assertGreater(len(frames[-1]), len(grains) + 30)


if __name__ == "__main__":
    unittest.main()
