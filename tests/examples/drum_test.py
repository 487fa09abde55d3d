"""The drum's mesh is closed and has the volume of its section; mixing of known arrangements."""

import collections
import pathlib
import struct
import sys
import tempfile
import unittest

import numpy

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
sys.path[:0] = [str(EXAMPLES), str(EXAMPLES / "rotating_drum")]

import drum_stl  # noqa: E402
import mixing  # noqa: E402
import text_dump  # noqa: E402


class Mesh(unittest.TestCase):
    def test_each_edge_is_used_once_in_each_direction(self):
        edges = collections.Counter()
        for triangle in drum_stl.triangles():
            for n in range(3):
                edges[(triangle[n], triangle[(n + 1) % 3])] += 1
        for (a, b), count in edges.items():
            self.assertEqual((count, edges[(b, a)]), (1, 1))

    def test_volume_is_section_times_length(self):
        x, z = numpy.array(drum_stl.outline()).T
        section = 0.5 * abs(numpy.sum(x * numpy.roll(z, -1) - z * numpy.roll(x, -1)))
        mesh = numpy.array(list(drum_stl.triangles()))
        volume = numpy.einsum("ni,ni->n", mesh[:, 0], numpy.cross(mesh[:, 1], mesh[:, 2])).sum() / 6
        length = drum_stl.LENGTH + 2 * drum_stl.OVERHANG
        self.assertAlmostEqual(volume / (section * length), 1, places=12)  # normals outwards

    def test_file_says_how_many_triangles_it_holds(self):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "drum.stl"
            count = drum_stl.write(path)
            data = path.read_bytes()
        self.assertEqual(struct.unpack("<I", data[80:84])[0], count)
        self.assertEqual(len(data), 84 + 50 * count)


class Mixing(unittest.TestCase):
    FRAME = {"x": numpy.tile(numpy.linspace(0.0005, 0.9995, 1000), 40),
             "z": numpy.repeat(numpy.linspace(0.0125, 0.9875, 40), 1000)}

    def test_two_halves_are_unmixed(self):
        left = (self.FRAME["x"] < 0.5).astype(float)
        self.assertAlmostEqual(mixing.index(self.FRAME, left, 0.1), 0, places=9)

    def test_random_kinds_are_mixed_as_by_chance(self):
        kinds = numpy.random.default_rng(5).integers(0, 2, 40_000).astype(float)
        self.assertAlmostEqual(mixing.index(self.FRAME, kinds, 0.1), 1, delta=1e-3)


class Dump(unittest.TestCase):
    def test_frames_are_read_with_their_columns(self):
        frame = ("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n"
                 "0 1\nITEM: ATOMS id x \n1 0.25\n2 {}\n")
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "grains.dump"
            path.write_text(frame.format(0, 0.5) + frame.format(10, 0.75))
            frames = list(text_dump.read_dump(path))
        self.assertEqual([step for step, _ in frames], [0, 10])
        self.assertEqual(list(frames[1][1]["x"]), [0.25, 0.75])


if __name__ == "__main__":
    unittest.main()
