#!/usr/bin/env python3
"""References of `periodic-spheres-3d`: the drag of simple, body- and face-centred cubic arrays of spheres.

The method of fundamental solutions with Stokeslets that are periodic on the lattice (Hasimoto 1959, summed as by
Ewald) inside the one sphere of a primitive cell. A constant velocity U is added; as the velocity vanishes on the
sphere and the flow of the Stokeslets inside has no divergence, U is the mean velocity of the cell without spheres,
and K is the sum of the forces over 6 pi mu a U.

    python lattices.py                         three resolutions each, some minutes; needs numpy and scipy
"""

import itertools
import sys

import numpy as np
from scipy.linalg import lstsq
from scipy.special import erfc

# Primitive vectors, in sides of the cubic cell
LATTICES = {
    "sc": np.eye(3),
    "bcc": 0.5 * np.array([[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]]),
    "fcc": 0.5 * np.array([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]]),
}


def periodic_stokeslets(points, sources, vectors, cut=4.2):
    """Velocities at points by unit forces in sources and their images, viscosity 1, mean velocity 0."""
    volume = abs(np.linalg.det(vectors))
    split = np.sqrt(np.pi) / volume ** (1.0 / 3.0)
    apart = points[:, None, :] - sources[None, :, :]
    tensor = np.zeros(apart.shape + (3,))
    n = range(-5, 6)
    for counts in itertools.product(n, n, n):
        shift = counts @ vectors
        if np.linalg.norm(shift) > cut / split + 1.0:
            continue
        r = apart + shift
        length = np.linalg.norm(r, axis=2)
        scaled = split * length
        near, bell = erfc(scaled) / length, 2.0 * split / np.sqrt(np.pi) * np.exp(-(scaled**2))
        tensor += ((near + bell) / length**2)[..., None, None] * r[..., :, None] * r[..., None, :]
        for i in range(3):
            tensor[..., i, i] += near - bell
    tensor /= 8.0 * np.pi
    reciprocal = 2.0 * np.pi * np.linalg.inv(vectors).T
    for counts in itertools.product(range(-8, 9), repeat=3):
        k = counts @ reciprocal
        square = k @ k
        # One of each pair k, -k
        if counts <= (0, 0, 0) or square > (2.0 * split * cut) ** 2:
            continue
        size = 2.0 / volume / square * (1.0 + square / (4.0 * split**2)) * np.exp(-square / (4.0 * split**2))
        wave = size * np.cos(apart @ k)
        tensor += wave[..., None, None] * (np.eye(3) - np.outer(k, k) / square)
    return tensor.transpose(0, 2, 1, 3).reshape(3 * len(points), 3 * len(sources))


def sphere(radius, n):
    """About n points spread evenly over a sphere."""
    i = np.arange(n) + 0.5
    cosine, angle = 1.0 - 2.0 * i / n, np.pi * (1.0 + 5**0.5) * i
    sine = np.sqrt(1.0 - cosine**2)
    return radius * np.stack([sine * np.cos(angle), sine * np.sin(angle), cosine], 1)


def drag(lattice, fraction, n, depth):
    """K, and the largest velocity left on the sphere, over U."""
    vectors = LATTICES[lattice]
    radius = (3.0 * fraction * abs(np.linalg.det(vectors)) / (4.0 * np.pi)) ** (1.0 / 3.0)
    sources, points = sphere((1.0 - depth) * radius, n), sphere(radius, 2 * n)
    wanted = np.tile([-1.0, 0.0, 0.0], len(points))
    matrix = periodic_stokeslets(points, sources, vectors)
    forces = lstsq(matrix, wanted, cond=1e-13, lapack_driver="gelsy")[0]
    other = sphere(radius, 2 * n + n // 3)
    left = periodic_stokeslets(other, sources, vectors) @ forces - np.tile([-1.0, 0.0, 0.0], len(other))
    return -forces[::3].sum() / (6.0 * np.pi * radius), np.abs(left).max()


if __name__ == "__main__":
    asked = [("bcc", 0.3), ("fcc", 0.3)] + [("sc", c) for c in (0.125, 0.027, 0.064, 0.216, 0.343)]
    for lattice, fraction in asked:
        for n, depth in [(180, 0.35), (300, 0.33), (420, 0.3)][: int(sys.argv[1]) if len(sys.argv) > 1 else None]:
            k, left = drag(lattice, fraction, n, depth)
            print(f"{lattice} {fraction}: {n} Stokeslets, K = {k:.6f}, residual {left:.1e}", flush=True)
