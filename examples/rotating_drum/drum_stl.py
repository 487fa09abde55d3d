"""The inside of a drum with lifters as a triangle mesh, written as a binary STL file."""

import math
import struct

RADIUS = 0.05  # m
LENGTH = 0.02  # m, between the end walls
LIFTERS = 6
LIFTER_HEIGHT = 0.008  # m
LIFTER_BASE, LIFTER_TIP = 0.006, 0.003  # m, width at the wall and inwards
OVERHANG = 0.006  # m, that the mesh is longer than the drum at either end
SEGMENTS = 8  # between two lifters


def outline():
    """Corners of the cross-section (x, z), counter-clockwise."""
    corners = []
    for lifter in range(LIFTERS):
        middle = 2 * math.pi * lifter / LIFTERS
        tip = RADIUS - LIFTER_HEIGHT
        half_base, half_tip = 0.5 * LIFTER_BASE / RADIUS, 0.5 * LIFTER_TIP / tip
        corners += [(RADIUS, middle - half_base), (tip, middle - half_tip), (tip, middle + half_tip)]
        span = 2 * math.pi / LIFTERS - 2 * half_base
        corners += [(RADIUS, middle + half_base + span * n / SEGMENTS) for n in range(SEGMENTS)]
    return [(r * math.cos(angle), r * math.sin(angle)) for r, angle in corners]


def triangles():
    """Mantle and two lids, normals outwards."""
    corners = outline()
    front, back = -OVERHANG, LENGTH + OVERHANG
    for (x, z), (next_x, next_z) in zip(corners, corners[1:] + corners[:1]):
        a, b = (x, front, z), (next_x, front, next_z)
        c, d = (x, back, z), (next_x, back, next_z)
        yield from ((a, c, b), (b, c, d), ((0, front, 0), a, b), ((0, back, 0), d, c))


def write(path):
    """Returns the number of triangles."""
    mesh = list(triangles())
    with open(path, "wb") as file:
        file.write(b"drum with lifters".ljust(80) + struct.pack("<I", len(mesh)))
        for corners in mesh:
            # readers find the normal from the corners
            file.write(struct.pack("<12fH", 0, 0, 0, *(v for corner in corners for v in corner), 0))
    return len(mesh)
