#!/usr/bin/env python3
"""References of `flagellated-3d/instant` by the method of fundamental solutions.

Stokes flow around the head and the helical tail in an unbounded fluid. Stokeslets lie inside both bodies, on
a surface confocal to the head and on a thinner tube with round ends within the tail; their strengths make
the velocity on the surfaces that of the bodies in the mean of squares. The residual on the surface at points
that the fit has not seen is printed: it bounds the error. Forces and torques are sums over Stokeslets.

    python fundamental_solutions.py            three resolutions, some minutes; needs numpy and scipy
"""

import sys

import numpy as np
from scipy.linalg import lstsq

HEAD = (1.0, 0.5)  # semi-axes along x and across it, centre in the origin
RADIUS, PITCH, TURNS, TUBE = 0.3, 1.5, 2.0, 0.1
START = np.array([1.2, 0.0, 0.0])
CLUSTER = 0.75  # stations at the ends are nearer to each other by this part
RATE = -1.0  # of the tail against the head about +x, right-handed


def stokeslets(points, sources):
    """Velocities at points by unit forces in sources, viscosity 1: (3 points, 3 sources)."""
    apart = points[:, None, :] - sources[None, :, :]
    inverse = 1.0 / np.linalg.norm(apart, axis=2)
    tensor = apart[..., :, None] * apart[..., None, :] * (inverse**3)[..., None, None]
    for i in range(3):
        tensor[..., i, i] += inverse
    tensor /= 8.0 * np.pi
    return tensor.transpose(0, 2, 1, 3).reshape(3 * len(points), 3 * len(sources))


def spheroid(along, across, n):
    """About n points spread evenly over a spheroid about x, and the area of each."""
    i = np.arange(n) + 0.5
    cosine, angle = 1.0 - 2.0 * i / n, np.pi * (1.0 + 5**0.5) * i
    sine = np.sqrt(1.0 - cosine**2)
    points = np.stack([along * cosine, across * sine * np.cos(angle), across * sine * np.sin(angle)], 1)
    area = 4.0 * np.pi / n * across * np.sqrt((across * cosine) ** 2 + (along * sine) ** 2)
    return points, area


def tube(radius, n_along, n_around):
    """Points on a tube about the helix with round ends, and the area of each.

    n_along stations of n_around points each, each ring turned against the one before.
    """
    turn = 2.0 * np.pi * TURNS
    speed = np.hypot(PITCH * TURNS, RADIUS * turn)
    curvature = RADIUS * turn**2 / speed**2

    def frame(s):
        sin, cos = np.sin(turn * s), np.cos(turn * s)
        at = np.array([PITCH * TURNS * s, RADIUS * cos, RADIUS * sin]) + START
        tangent = np.array([PITCH * TURNS, -RADIUS * turn * sin, RADIUS * turn * cos]) / speed
        normal = np.array([0.0, -cos, -sin])  # towards the axis
        return at, tangent, normal, np.cross(tangent, normal)

    points, areas = [], []
    for k in range(n_along):
        t = 2.0 * np.pi * (k + 0.5) / n_along
        at, _, normal, binormal = frame((t - CLUSTER * np.sin(t)) / (2.0 * np.pi))
        angle = 2.0 * np.pi * (np.arange(n_around) + 0.5 * (k % 2)) / n_around
        ring = np.outer(np.cos(angle), normal) + np.outer(np.sin(angle), binormal)
        points.append(at + radius * ring)
        share = 2.0 * np.pi * radius / n_around * speed / n_along * (1.0 - CLUSTER * np.cos(t))
        areas.append(share * (1.0 - curvature * radius * np.cos(angle)))
    spacing = speed / n_along * (1.0 - CLUSTER)
    n_cap = round(radius * n_around / spacing)  # as dense as the last rings
    for s, out in [(0.0, -1.0), (1.0, 1.0)]:
        at, tangent, normal, binormal = frame(s)
        i = np.arange(n_cap) + 0.5
        cosine, angle = i / n_cap, np.pi * (1.0 + 5**0.5) * i
        sine = np.sqrt(1.0 - cosine**2)
        cap = np.outer(out * cosine, tangent) + np.outer(sine * np.cos(angle), normal)
        points.append(at + radius * (cap + np.outer(sine * np.sin(angle), binormal)))
        areas.append(np.full(n_cap, 2.0 * np.pi * radius**2 / n_cap))
    return np.concatenate(points), np.concatenate(areas)


def surface(n_head, n_along, n_around, depth):
    """Points on head and tail, depth 0, or on sources within them; areas; how many are the head's."""
    along, across = HEAD
    inner = across * (1.0 - depth)
    confocal = np.sqrt(along**2 - across**2 + inner**2)
    head, head_area = spheroid(confocal, inner, n_head)
    tail, tail_area = tube(TUBE * (1.0 - depth), n_along, n_around)
    return np.concatenate([head, tail]), np.concatenate([head_area, tail_area]), n_head


def motions(points, n_head):
    """Six rigid motions of the whole and the turning of the tail alone: (3 points, 7)."""
    columns = []
    for axis in np.eye(3):
        columns.append(np.tile(axis, (len(points), 1)))
    for axis in np.eye(3):
        columns.append(np.cross(axis, points))
    tail = np.cross(np.eye(3)[0], points - START)
    tail[:n_head] = 0.0
    columns.append(tail)
    return np.stack([column.ravel() for column in columns], 1)


def swim(n_head, n_along, n_around, depth, more=1.35):
    """Velocity, angular velocity of the head, torque of the motor, largest residual on the surface."""
    sources, _, n_sources = surface(n_head, n_along, n_around, depth)
    finer = [round(more * n) for n in (more * n_head, n_along, n_around)]
    points, area, n_points = surface(*finer, 0.0)
    weight = np.repeat(np.sqrt(area), 3)
    matrix = stokeslets(points, sources) * weight[:, None]
    wanted = motions(points, n_points) * weight[:, None]
    forces = lstsq(matrix, wanted, cond=1e-13, lapack_driver="gelsy", overwrite_a=True)[0]
    # Loads of the bodies on the fluid; rows: force and torque about the origin, and the tail's about x
    loads = motions(sources, n_sources).T @ forces
    rigid = np.linalg.solve(loads[:6, :6], -RATE * loads[:6, 6])
    answer = np.append(rigid, RATE)
    torque = loads[6] @ answer
    # Elsewhere on the surface
    other, _, n_other = surface(*[n + 1 + n // 7 for n in finer], 0.0)
    residual = stokeslets(other, sources) @ (forces @ answer) - motions(other, n_other) @ answer
    residual = np.linalg.norm(residual.reshape(-1, 3), axis=1).max()
    return rigid, torque, residual, 3 * len(sources)


if __name__ == "__main__":
    levels = [(150, 100, 8, 0.4), (150, 120, 10, 0.4), (150, 160, 12, 0.35)]
    for level in levels[: int(sys.argv[1]) if len(sys.argv) > 1 else None]:
        rigid, torque, residual, n = swim(*level)
        print(
            f"{n} unknowns: velocity {rigid[0]:.6f} {rigid[1]:.6f} {rigid[2]:.6f}, angular velocity "
            f"{rigid[3]:.6f} {rigid[4]:.6f} {rigid[5]:.6f}, torque {torque:.6f}, residual {residual:.1e}",
            flush=True,
        )
