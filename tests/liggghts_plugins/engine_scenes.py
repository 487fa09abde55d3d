"""Scenes and comparisons for the tests of the fused engine."""

import random
import unittest

import bed_of_grains as bed
from liggghts_run import Bench, Grain, cgm_properties, data_file, largest_difference, preamble

SPEED = 0.5  # m/s
RADIUS = bed.RADIUS
SCALE = [2 * RADIUS] * 3 + [SPEED] * 3 + [SPEED / RADIUS] * 3
UNWRAPPED = "xu yu zu vx vy vz omegax omegay omegaz"
FORCES = "x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz"
SIDE = 12.0 * RADIUS

BOX = "".join(f'[[body]]\nname = "{name}"\nplane = {{point = {point}, normal = {normal}}}\n'
              for name, point, normal in (
                  ("west", [0, 0, 0], [1, 0, 0]), ("east", [2 * SIDE, 0, 0], [-1, 0, 0]),
                  ("south", [0, 0, 0], [0, 1, 0]), ("north", [0, SIDE, 0], [0, -1, 0]),
                  ("floor", [0, 0, 0], [0, 0, 1]), ("lid", [0, 0, 2 * SIDE], [0, 0, -1])))
WALLS = "".join(f"fix {body} all wall/sdf case box.toml body {body} type 2\n"
                for body in ("west", "east", "south", "north", "floor", "lid"))


def crowd(types=1, radii=(RADIUS,), seed=1, pitch=2.02):
    """About 1000 grains in 12 x 6 x 12 cells of a lattice, agitated and spinning."""
    numbers = random.Random(seed)
    made = []
    spacing = [2 * SIDE / 12, SIDE / 6, 2 * SIDE / 12]
    assert min(spacing) > 0.99 * pitch * max(radii)
    for k in range(12):
        for j in range(6):
            for i in range(12):
                place = tuple((n + 0.5) * h for n, h in zip((i, j, k), spacing))
                kind = numbers.randrange(len(radii))
                made.append(Grain(place, radii[kind],
                                  tuple(numbers.gauss(0, SPEED) for _ in range(3)),
                                  tuple(numbers.gauss(0, SPEED / RADIUS) for _ in range(3)),
                                  type=1 + kind % types))
    return made


def files(grains, types=2):
    return {"grains.data": data_file(grains, [0, 0, 0], [2 * SIDE, SIDE, 2 * SIDE], types),
            "box.toml": BOX}


def scene(boundary="f f f", tangential="history", walls=WALLS, properties=None, head="", l=1.0):
    """Grains of k = 50 N/m at a tenth of their contact time per step."""
    return (head + preamble("grains.data", skin=0.2 * RADIUS, l=l, boundary=boundary) +
            (properties or cgm_properties(2, k=50.0, e=0.8, mu=0.4)) +
            f"pair_style gran model cgm tangential {tangential}\npair_coeff * *\ntimestep 4e-6\n"
            "fix gravity all gravity 9.81 vector 0 0 -1\nfix integrate all nve/sphere\n" + walls)


def thermo_of(columns):
    return (f"thermo_style custom step atoms ke {columns}\nthermo 100\n"
            "thermo_modify format float %.17g norm no lost error\n")


class EngineTest(unittest.TestCase):
    def off_and_fused(self, scene_text, rest, scene_files, ranks=1, mode="fused",
                      reference_ranks=1):
        reference, fused = Bench(scene_files), Bench(scene_files)
        reference.run("gasgrain_engine off\n" + scene_text + rest, ranks=reference_ranks)
        run = fused.run(f"gasgrain_engine {mode}\n" + scene_text + rest, ranks=ranks)
        self.assertIn("Engine: fused", run.text)
        return reference, fused, run

    def assert_same_motion(self, reference, fused, limits=((300, 1e-10), (1000, 1e-8)), every=100):
        frames, others = reference.frames("d.dump"), fused.frames("d.dump")
        self.assertEqual(len(frames), len(others))
        for step, limit in limits:
            until = step // every + 1
            self.assertLessEqual(until, len(frames))
            self.assertLess(largest_difference(others[:until], frames[:until], SCALE), limit)
        return frames


def reference_log(bench):
    return (bench.directory / "log.txt").read_text()


def stl(triangles):
    """An ASCII STL file of triangles, each of three corners."""
    text = "solid surface\n"
    for corners in triangles:
        text += "facet normal 0 0 1\n outer loop\n"  # normals are not read
        text += "".join("  vertex " + " ".join(f"{value:.9g}" for value in corner) + "\n"
                        for corner in corners)
        text += " endloop\nendfacet\n"
    return text + "endsolid surface\n"


def plate(height, lower, upper):
    """An STL file of a square plate."""
    (a, b), (c, d) = lower, upper
    return stl([[(x, y, height) for x, y in corners]
                for corners in (((a, b), (c, b), (c, d)), ((a, b), (c, d), (a, d)))])
