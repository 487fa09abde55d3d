"""The fused engine with stock mesh walls moves grains as the stock loop does.

Reference: the same executable with `gasgrain_engine off`, as in engine_test.py.
"""

import re
import unittest

from engine_scenes import (FORCES, RADIUS, SCALE, SIDE, EngineTest, crowd, plate, reference_log,
                           scene, stl, thermo_of)
from engine_insertion_test import FACE, STREAM
from engine_stock_models_test import MATERIALS, STIFFNESSES
from liggghts_run import (Bench, cgm_properties, data_file, dump_command, largest_difference,
                          preamble, thermo)

LENGTHS = (2 * SIDE, SIDE, 2 * SIDE)
MARGIN = 2 * RADIUS


def side(axis, place, pieces):
    """Triangles of the side of the box at right angles to `axis`, pieces x pieces rectangles."""
    u, v = (axis + 1) % 3, (axis + 2) % 3

    def corner(i, j):
        point = [0.0, 0.0, 0.0]
        point[axis] = place
        point[u], point[v] = i * LENGTHS[u] / pieces, j * LENGTHS[v] / pieces
        return tuple(point)

    triangles = []
    for i in range(pieces):
        for j in range(pieces):
            a, b = corner(i, j), corner(i + 1, j)
            c, d = corner(i + 1, j + 1), corner(i, j + 1)
            triangles += [(a, b, c), (a, c, d)]
    return triangles


def box(pieces, axes=(0, 1, 2)):
    return stl([triangle for axis in axes for place in (0, LENGTHS[axis])
                for triangle in side(axis, place, pieces)])


def roof(width, height, place):
    """A pyramid upon which grains fall: edges and a corner that stick out."""
    x, y, z = place
    top = (x, y, z + height)
    foot = [(x - width, y - width, z), (x + width, y - width, z), (x + width, y + width, z),
            (x - width, y + width, z)]
    return stl([(foot[n], foot[(n + 1) % 4], top) for n in range(4)])


STEEL = "type 2"
BOX_FILES = {"box.stl": box(1), "tiles.stl": box(9), "pillars.stl": box(2, axes=(0, 2)),
             "roof.stl": roof(3.1 * RADIUS, 4.3 * RADIUS, (SIDE, SIDE / 2, SIDE / 2))}


def mesh_files(grains):
    """Grains in a box somewhat larger than the mesh."""
    lower, upper = [-MARGIN] * 3, [length + MARGIN for length in LENGTHS]
    return {"grains.data": data_file(grains, lower, upper, 2), **BOX_FILES}


def meshes(model, files_of_meshes, after=""):
    names = " ".join(name for name, _ in files_of_meshes)
    return ("".join(f"fix {name} all {style}\n" for name, style in files_of_meshes) +
            f"fix walls all wall/gran model {model} mesh n_meshes {len(files_of_meshes)} "
            f"meshes {names} {after}\n")


def surface(name, options="", file="", style="mesh/surface"):
    return name, f"{style} file {file or name}.stl {STEEL} {options}"


def stock_scene(model, properties, walls, boundary="f f f"):
    head = preamble("grains.data", skin=0.2 * RADIUS, boundary=boundary)
    return (head.replace("delay 0", "delay 0 contact_distance_factor 1.01") + properties +
            f"pair_style gran model {model}\npair_coeff * *\ntimestep 4e-6\n"
            "fix gravity all gravity 9.81 vector 0 0 -1\nfix integrate all nve/sphere\n" + walls)


def cell_fields(path):
    """Rows of a VTK file's cell data: the values of each triangle."""
    fields = re.findall(r"^\w+ 1 \d+ double\n([^a-z]*)", path.read_text(), re.MULTILINE)
    return list(zip(*([float(word) for word in field.split()] for field in fields), strict=True))


class MeshWalls(EngineTest):
    HERTZ = "hertz tangential history"

    def check(self, text, scene_files=None, ranks=1, rest="run 600\nrun 400\n",
              limits=((300, 1e-10), (1000, 1e-8)), columns="x y z vx vy vz omegax omegay omegaz"):
        reference, fused, run = self.off_and_fused(
            text, dump_command("d", 100, columns) + rest,
            scene_files or mesh_files(crowd()), ranks)
        self.assertRegex(run.text, "Engine: fused: .*wall/gran mesh x")
        return self.assert_same_motion(reference, fused, limits)

    def assert_kept_in_box(self, frames):
        for place in frames[-1].values():
            for value, length in zip(place, LENGTHS):
                self.assertGreater(value, 0.5 * RADIUS)
                self.assertLess(value, length - 0.5 * RADIUS)

    def test_models(self):
        for model, properties in ((self.HERTZ, MATERIALS),
                                  ("hertz tangential no_history", MATERIALS),
                                  ("hooke tangential off", MATERIALS),
                                  ("hooke/stiffness tangential history", STIFFNESSES)):
            with self.subTest(model=model):
                grains = crowd(types=2, radii=(RADIUS, 0.8 * RADIUS))
                text = stock_scene(model, properties, meshes(model, [surface("box")]))
                self.assert_kept_in_box(self.check(text, mesh_files(grains),
                                                   limits=((300, 1e-10), (1000, 1e-7))))

    def test_our_law_on_a_box_of_tiles_smaller_than_three_grains(self):
        model = "cgm tangential history"
        text = scene(walls=meshes(model, [surface("tiles")]),
                     properties=cgm_properties(2, k=50.0, e=0.8, mu=0.4))
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                self.assert_kept_in_box(self.check(text, ranks=ranks))

    def test_several_meshes_with_edges_and_a_belt(self):
        """Also beside primitive walls, and a surface that moves within itself."""
        walls = ("fix west all wall/gran model hertz tangential history primitive type 2 "
                 "xplane 1e-5\n" +
                 meshes(self.HERTZ, [surface("box"), surface("roof"),
                                     surface("belt", "surface_vel 0.3 0.1 0", "plate")]))
        scene_files = mesh_files(crowd())
        scene_files["plate.stl"] = plate(0.5 * RADIUS, (0, 0), (2 * SIDE, SIDE))
        still = stock_scene(self.HERTZ, MATERIALS, walls.replace("surface_vel 0.3 0.1 0", ""))
        text = stock_scene(self.HERTZ, MATERIALS, walls)
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                frames = self.check(text, scene_files, ranks)
        others = self.check(still, scene_files)
        self.assertGreater(largest_difference(others, frames, SCALE), 1e-2)

    def test_periodic_and_shrink_wrapped_boxes(self):
        grains = crowd()
        lower, upper = [-MARGIN, 0, -MARGIN], [2 * SIDE + MARGIN, SIDE, 2 * SIDE + MARGIN]
        scene_files = {"grains.data": data_file(grains, lower, upper, 2), **BOX_FILES}
        walls = meshes(self.HERTZ, [surface("pillars"), surface("roof")])
        for boundary in ("f p f", "m p m"):
            for ranks in (1, 2):
                with self.subTest(boundary=boundary, ranks=ranks):
                    self.check(stock_scene(self.HERTZ, MATERIALS, walls, boundary), scene_files,
                               ranks, columns="xu yu zu vx vy vz omegax omegay omegaz")

    def test_moving_meshes(self):
        """A paddle turns, a pyramid swings and a floor rises in a box at rest."""
        meshes_used = [surface("box"), surface("paddle"), surface("roof"),
                       surface("floor", file="plate")]
        scene_files = mesh_files(crowd())
        scene_files["plate.stl"] = plate(0.1 * RADIUS, (0, 0), (2 * SIDE, SIDE))
        scene_files["paddle.stl"] = stl([[(x, SIDE / 2, z) for x, z in corners] for corners in (
            ((8e-3, 8e-3), (11e-3, 8e-3), (11e-3, 10e-3)),
            ((8e-3, 8e-3), (11e-3, 10e-3), (8e-3, 10e-3)))])
        motion = ("fix turn all move/mesh mesh paddle rotate origin 0.0095 0.003 0 axis 0 0 1 "
                  "period 0.04\n"
                  "fix swing all move/mesh mesh roof wiggle amplitude 2e-4 0 3e-4 period 3e-3\n"
                  "fix rise all move/mesh mesh floor linear 0 0 0.05\n")
        text = stock_scene(self.HERTZ, MATERIALS, meshes(self.HERTZ, meshes_used) + motion)
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                frames = self.check(text, scene_files, ranks)
        still = self.check(text.replace(motion, ""), scene_files)
        self.assertGreater(largest_difference(still, frames, SCALE), 1e-2)

    def test_grains_poured_through_a_face(self):
        """A third mesh, that of the insertion, is no wall. On one rank: stock's insertion depends on
        the ranks, and so do its contacts with coplanar triangles."""
        walls = meshes("cgm tangential history", [surface("tiles"), surface("roof")])
        grains = [grain for grain in crowd() if grain.position[2] < SIDE]
        frames = self.check(
            scene(walls=walls, properties=cgm_properties(2, k=50.0, e=0.8, mu=0.4)) + STREAM,
            {**mesh_files(grains), "face.stl": FACE}, rest="run 450\nrun 550\n")
        self.assert_kept_in_box(frames)
        self.assertGreater(len(frames[-1]), len(grains) + 30)

    def test_forces_and_wear_of_meshes(self):
        head = "fix k_finnie all property/global k_finnie peratomtypepair 2 1 1 1 1\n"
        text = stock_scene(self.HERTZ, MATERIALS + head, meshes(self.HERTZ, [
            surface("box", "wear finnie", style="mesh/surface/stress"),
            surface("roof", "reference_point 0.006 0.003 0", style="mesh/surface/stress")]))
        rest = (thermo_of(" ".join(f"f_{mesh}[{n}]" for mesh in ("box", "roof")
                                   for n in range(1, 7))) +
                dump_command("d", 100) +
                "dump m all mesh/gran/VTK 500 mesh.*.vtk stress wear box\nrun 1000\n")
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                reference, fused, _ = self.off_and_fused(text, rest, mesh_files(crowd()), ranks)
                self.assert_same_motion(reference, fused)
                self.assert_same_numbers(*(thermo(reference_log(bench))
                                           for bench in (reference, fused)))
                if ranks == 1:  # triangles of several ranks are written in the order of the ranks
                    triangles = [cell_fields(bench.directory / "mesh.1000.vtk")
                                 for bench in (reference, fused)]
                    self.assertEqual(len(triangles[0][0]), 3)  # two stresses and the wear
                    self.assert_same_numbers(*triangles)

    def assert_same_numbers(self, rows, others):
        """Each column relative to its largest value."""
        self.assertGreater(len(rows), 3)
        for column, values in enumerate(zip(*rows, strict=True)):
            largest = max(abs(value) for value in values)
            for row, other in zip(rows, others, strict=True):
                self.assertLessEqual(abs(row[column] - other[column]), 1e-6 * largest)

    def test_steps_of_the_stock_loop_in_between(self):
        pressure = ("compute p all pressure thermo_temp\nthermo_style custom step ke c_p\n"
                    "thermo 70\n")
        text = stock_scene(self.HERTZ, MATERIALS, meshes(self.HERTZ, [surface("tiles")]))
        self.check(text, rest=pressure + "run 1000\n")


class SameBits(EngineTest):
    TEXT = stock_scene(MeshWalls.HERTZ, MATERIALS,
                       meshes(MeshWalls.HERTZ, [surface("tiles"), surface("roof")]))

    def test_repeated_runs_are_identical(self):
        dumps = []
        for _ in range(2):
            bench = Bench(mesh_files(crowd()))
            bench.run("gasgrain_engine fused\n" + self.TEXT + dump_command("d", 100, FORCES) +
                      "run 500\n", ranks=2)
            dumps.append((bench.directory / "d.dump").read_text())
        self.assertEqual(*dumps)

    def test_continued_run(self):
        """On several ranks a mesh from a restart file has its triangles in another order; the stock
        loop, which sets every run up, adds loads of grains that touch two walls in that order."""
        moving = self.TEXT.replace(
            "fix walls", "fix turn all move/mesh mesh roof rotate origin 0.006 0.003 0 "
            "axis 0 0 1 period 0.02\nfix walls")
        for text, ranks in ((self.TEXT, 1), (self.TEXT, 2), (moving, 1)):
            with self.subTest(ranks=ranks, moving=text is moving):
                start = "gasgrain_engine fused\n" + text + "gasgrain_checkpoint 300 points\n"
                rest = dump_command("d", 900, FORCES) + "run 900 upto\n"
                bench = Bench(mesh_files(crowd()))
                bench.run(start + rest, ranks=ranks)
                expected = bench.frames("d.dump")[-1]
                bench.run(start.replace("read_data grains.data",
                                        "read_restart points/grains.600.restart") + rest,
                          ranks=ranks)
                again = bench.frames("d.dump")[-1]
                if ranks == 1:
                    self.assertEqual(again, expected)
                else:
                    self.assertLess(largest_difference([again], [expected], SCALE + [1] * 6), 1e-11)


class Plan(EngineTest):
    def test_what_is_not_understood_is_named(self):
        model = MeshWalls.HERTZ
        servo = "com 0 0 0.01 ctrlPV force axis 0 0 1 target_val 1 vel_max 0.1 kp 5"
        box = meshes(model, [surface("box")])
        turn = ("variable w equal 1+step\n"
                "fix turn all move/mesh mesh box rotate/variable origin 0 0 0 axis 0 0 1 "
                "omega v_w\n")
        for walls, name in (
                (meshes(model, [surface("box", servo, style="mesh/surface/stress/servo")]),
                 "fix box mesh/surface/stress/servo"),
                (box.replace(" mesh n_meshes", " store_force yes mesh n_meshes"),
                 "fix walls wall/gran"),
                ("variable w equal 1e-3*step\n" +
                 meshes(model, [surface("box", "surface_vel v_w 0 0")]),
                 "fix box mesh/surface with variables"),
                (box + turn, "fix turn move/mesh with variables")):
            with self.subTest(name):
                run = Bench(mesh_files(crowd())).run(
                    "gasgrain_engine auto\n" + stock_scene(model, MATERIALS, walls) + "run 10\n")
                self.assertRegex(run.text, "Engine: stock time integration.*" + name)


if __name__ == "__main__":
    unittest.main()
