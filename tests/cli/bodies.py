"""Meshes for the command-line tests, sound and broken ones, as lists of triangles (three points each) and as STL files. Lengths in mm."""

import math
import struct


def box(lower=(0.0, 0.0, 0.0), upper=(3.0, 2.0, 1.0)):
    """Closed box, outward normals."""
    p = [[(lower, upper)[(i >> axis) & 1][axis] for axis in range(3)] for i in range(8)]  # bit k of i: upper along axis k
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return [[p[a], p[b], p[c]] for q in quads for a, b, c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]


def cylinder(diameter=3.12, height=2.96, facets=24):
    """Closed cylinder about z, centre in the origin, outward normals."""
    ring = [(0.5 * diameter * math.cos(2 * math.pi * i / facets), 0.5 * diameter * math.sin(2 * math.pi * i / facets)) for i in range(facets)]
    low, high = -0.5 * height, 0.5 * height
    faces = []
    for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1]):
        a, b, c, d = (x0, y0, low), (x1, y1, low), (x1, y1, high), (x0, y0, high)
        faces += [[a, b, c], [a, c, d], [(0, 0, low), b, a], [(0, 0, high), d, c]]
    return faces


def inside_out(faces):
    return [[a, c, b] for a, b, c in faces]


def without_a_triangle(faces):
    return faces[:-1]


def crossing():
    """Two boxes that cut through each other: closed, oriented, self-intersecting."""
    return box() + box((1.0, 0.5, 0.25), (4.0, 1.5, 0.75))


def flat():
    """A square sheet with a front and a back: closed, but without any volume."""
    a, b, c, d = (0, 0, 0), (3, 0, 0), (3, 3, 0), (0, 3, 0)
    return [[a, b, c], [a, c, d], [a, c, b], [a, d, c]]


def with_a_nan(faces):
    broken = [[list(corner) for corner in face] for face in faces]
    broken[3][1][2] = float("nan")
    return broken


def write_binary_stl(file, faces):
    with open(file, "wb") as stream:
        stream.write(b"pelletlab test".ljust(80, b" ") + struct.pack("<I", len(faces)))
        for face in faces:
            stream.write(struct.pack("<12fH", 0, 0, 0, *(x for corner in face for x in corner), 0))


def write_text_stl(file, faces):
    with open(file, "w", encoding="ascii") as stream:
        stream.write("solid test\n")
        for face in faces:
            stream.write("facet normal 0 0 0\nouter loop\n")
            for corner in face:
                stream.write("vertex " + " ".join(repr(float(x)) for x in corner) + "\n")
            stream.write("endloop\nendfacet\n")
        stream.write("endsolid test\n")
