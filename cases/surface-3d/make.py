"""Makes the surfaces of this case: python make.py

Vertices are on the exact surfaces. Files of all three kinds that are read.
"""

import struct

import numpy as np


def sphere(n):
    """Icosahedron, each triangle cut into four n times, on the unit sphere."""
    long = (1 + 5**0.5) / 2
    points = [(a, b * long, 0) for b in (1, -1) for a in (-1, 1)]
    points += [(0, a, b * long) for b in (1, -1) for a in (-1, 1)]
    points += [(a * long, 0, b) for a in (1, -1) for b in (-1, 1)]
    points = [np.array(point) / np.linalg.norm(point) for point in points]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4)]
    triangles += [(11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8)]
    triangles += [(3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(n):
        middles = {}

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                middles[key] = len(points)
                point = points[a] + points[b]
                points.append(point / np.linalg.norm(point))
            return middles[key]

        finer = []
        for a, b, c in triangles:
            k, l, m = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, k, m), (k, b, l), (m, l, c), (k, l, m)]
        triangles = finer
    return np.array(points), triangles


def torus(n, m, ring, tube):
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    far = ring + tube * np.cos(v)
    points = np.stack([far * np.cos(u), far * np.sin(u), tube * np.sin(v)], axis=-1)
    triangles = []
    for i in range(n):
        for j in range(m):
            a, b = i * m + j, (i + 1) % n * m + j
            c, d = (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m
            triangles += [(a, b, c), (a, c, d)]
    return points.reshape(-1, 3), triangles


def write_stl(name, points, triangles):
    with open(name, "wb") as file:
        file.write(b"unit sphere".ljust(80) + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *np.concatenate(points[list(triangle)]), 0))


def write_obj(name, points, triangles):
    with open(name, "w") as file:
        file.writelines(f"v {x:.7g} {y:.7g} {z:.7g}\n" for x, y, z in points)
        file.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)


def write_ply(name, points, triangles):
    header = f"""ply
format binary_little_endian 1.0
element vertex {len(points)}
property float x
property float y
property float z
element face {len(triangles)}
property list uchar int vertex_indices
end_header
"""
    with open(name, "wb") as file:
        file.write(header.encode())
        file.writelines(struct.pack("<3f", *point) for point in points)
        file.writelines(struct.pack("<B3i", 3, *triangle) for triangle in triangles)


if __name__ == "__main__":
    write_stl("sphere-320.stl", *sphere(2))
    write_stl("sphere-1280.stl", *sphere(3))
    points, triangles = sphere(3)
    write_obj("ellipsoid.obj", points * [2, 1, 0.5], triangles)
    write_ply("torus.ply", *torus(48, 20, 1, 0.4))
