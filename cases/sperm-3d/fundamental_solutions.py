#!/usr/bin/env python3
"""References of `sperm-3d/alone` by the method of fundamental solutions.

Stokes flow around a flagellate in an unbounded fluid at time zero of a beat. Stokeslets lie on a thinner body inside;
their strengths make the velocity on the surface that of the beat and of a rigid motion without force and
torque, in the mean of squares. Shape and rates come from the formulas of the gait, by differences in time, not from
the program. The residual on points the fit has not seen bounds the error.

    python fundamental_solutions.py            three resolutions, some minutes; needs numpy and scipy
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import lstsq
from scipy.optimize import brentq

A, B = 2.0, 1.0  # semi-axes of the head
TAIL, HALF = 20.0, 0.4  # length of the tail, half of its thickness
FILLET = 0.8  # radius of the fillet between both: the thickness
AMPLITUDE, WAVELENGTH, PERIOD, JOINT = 2.0, 20.0, 1.0, TAIL / 20.0
LENGTH = 2.0 * A + TAIL
STEP = 1e-4  # of differences in time


def _fillet():
    """Where the fillet touches the head, and its centre: distance from the tip, height above the axis."""

    def excess(angle):
        speed = np.hypot(A * np.sin(angle), B * np.cos(angle))
        return B * np.sin(angle) + FILLET * A * np.sin(angle) / speed - HALF - FILLET

    angle = brentq(excess, 0.0, np.pi / 2)
    speed = np.hypot(A * np.sin(angle), B * np.cos(angle))
    touch = np.array([A + A * np.cos(angle), B * np.sin(angle)])
    return touch, touch + FILLET / speed * np.array([B * np.cos(angle), A * np.sin(angle)])


TOUCH, CENTRE = _fillet()


def radius(s):
    """Radius of the section at a distance from the tip of the head, and its derivative."""
    if s <= TOUCH[0]:
        r = B * np.sqrt(max(1.0 - ((s - A) / A) ** 2, 0.0))
        return r, -(B**2) * (s - A) / A**2 / r if r > 0.0 else np.inf
    if s <= CENTRE[0]:
        h = np.sqrt(FILLET**2 - (s - CENTRE[0]) ** 2)
        return CENTRE[1] - h, (s - CENTRE[0]) / h
    tip = LENGTH - HALF
    if s <= tip:
        return HALF, 0.0
    r = np.sqrt(max(HALF**2 - (s - tip) ** 2, 0.0))
    return r, -(s - tip) / r if r > 0.0 else -np.inf


def midline(s, time):
    """Positions and unit tangents (head to tail) of the midline at increasing distances from the tip."""
    def wave(x):
        phase = 2.0 * np.pi * (x / WAVELENGTH - time / PERIOD)
        decay = np.exp(-((x / JOINT) ** 3))
        envelope = AMPLITUDE / TAIL * x * (1.0 - decay)
        rate = AMPLITUDE / TAIL * (1.0 - decay + 3.0 * (x / JOINT) ** 3 * decay)
        y = envelope * np.sin(phase)
        return y, rate * np.sin(phase) + envelope * np.cos(phase) * 2.0 * np.pi / WAVELENGTH

    def advance(_, x):
        return 1.0 / np.sqrt(1.0 + wave(x)[1] ** 2)

    behind = np.maximum(s - 2.0 * A, 0.0)
    solved = solve_ivp(advance, (0.0, TAIL), [0.0], rtol=1e-12, atol=1e-13, dense_output=True)
    x = solved.sol(behind)[0]
    x[behind == 0.0] = 0.0
    y, slope = wave(x)
    secant = np.sqrt(1.0 + slope**2)
    position = np.stack([-np.minimum(s, 2.0 * A) - x, y], 1)
    return position, np.stack([-1.0 / secant, slope / secant], 1)


def surface_at(rings, time):
    """Points of rings (distance, radius, number, first angle) about the midline at a time."""
    s = np.array([ring[0] for ring in rings])
    position, tangent = midline(s, time)
    points = []
    for (_, r, n, first), at, along in zip(rings, position, tangent, strict=True):
        angle = first + 2.0 * np.pi * np.arange(n) / n
        normal = np.array([along[1], -along[0]])
        plane = at + r * np.cos(angle)[:, None] * normal
        points.append(np.column_stack([plane, r * np.sin(angle)]))
    return np.concatenate(points)


def rate_of(of_time):
    """Derivative at time zero by differences of fourth order."""
    d = STEP
    return (8.0 * (of_time(d) - of_time(-d)) - (of_time(2.0 * d) - of_time(-2.0 * d))) / (12.0 * d)


def stations(spacing):
    """Distances from the tip, spaced along the outline in proportion to the radius and that of the tail."""
    t = np.linspace(0.0, np.pi, 40001)
    s = 0.5 * LENGTH * (1.0 - np.cos(t))
    r = np.array([radius(one)[0] for one in s])
    outline = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(s), np.diff(r)))])
    # Nearer to each other where the body is thin
    density = np.concatenate([[0.0], np.cumsum(np.diff(outline) / (HALF + 0.5 * (r[1:] + r[:-1])))])
    n = max(8, round(density[-1] / spacing))
    return np.interp((np.arange(n) + 0.5) / n * density[-1], density, s), density[-1] / n


def outer(spacing, n_around):
    """Rings on the surface and the area of their points."""
    at, width = stations(spacing)
    rings, areas = [], []
    for k, s in enumerate(at):
        r, n = radius(s)[0], n_around
        rings.append((s, r, n, np.pi * (k % 2) / n))
        areas.append(np.full(n, 2.0 * np.pi * r / n * width * (HALF + r)))
    return rings, np.concatenate(areas)


def inner(spacing, n_around, depth):
    """Rings of sources: on a spheroid confocal to the head, and a part of the radius below tail and fillet."""
    at, _ = stations(spacing)
    rings = []
    for k, s in enumerate(at):
        r, slope = radius(s)
        if s < A:
            inside = np.sqrt(A**2 - B**2 + (B * (1.0 - depth)) ** 2)
            eta = np.arccos(np.clip((A - s) / A, -1.0, 1.0))
            rings.append((A - inside * np.cos(eta), B * (1.0 - depth) * np.sin(eta), n_around, 0.0))
        else:
            length = np.hypot(1.0, slope) if np.isfinite(slope) else np.inf
            down = depth * r if np.isfinite(slope) and s < LENGTH - HALF else depth * HALF
            along = slope / length if np.isfinite(slope) else -1.0
            rings.append((s + down * along, r - down / length, n_around, 0.0))
        rings[-1] = (*rings[-1][:3], np.pi * ((k + 1) % 2) / n_around)
    return rings


def stokeslets(points, sources):
    """Velocities at points by unit forces in sources, viscosity 1: (3 points, 3 sources)."""
    apart = points[:, None, :] - sources[None, :, :]
    inverse = 1.0 / np.linalg.norm(apart, axis=2)
    tensor = apart[..., :, None] * apart[..., None, :] * (inverse**3)[..., None, None]
    for i in range(3):
        tensor[..., i, i] += inverse
    tensor /= 8.0 * np.pi
    return tensor.transpose(0, 2, 1, 3).reshape(3 * len(points), 3 * len(sources))


def power_of(points, areas, normals, velocity, sources, forces):
    """Power that the surface gives to the fluid: velocity times the traction of the Stokeslets."""
    total = 0.0
    for x, area, n, u in zip(points, areas, normals, velocity, strict=True):
        apart = x - sources
        r = np.linalg.norm(apart, axis=1)
        scale = -3.0 / (4.0 * np.pi) * (apart * forces).sum(1) * (apart @ n) / r**5
        total -= area * (apart * scale[:, None]).sum(0) @ u
    return total


def motions(points):
    """Six rigid motions about the origin: (3 points, 6)."""
    columns = [np.tile(axis, (len(points), 1)) for axis in np.eye(3)]
    columns += [np.cross(axis, points) for axis in np.eye(3)]
    return np.stack([column.ravel() for column in columns], 1)


def interior(time_rate_of):
    """Centre of the volume, its velocity, inertia and angular momentum about it, in the frame of the head.

    The interior is mapped from the straight body: a point at y along the normal of the midline at rest is at the offset
    o with o + k o^2 / 2 = y + k (r^2 - z^2) / 2, k the curvature, which keeps volumes.
    """
    n, m = 1600, 12
    edges = np.linspace(0.0, LENGTH, n + 1)
    s = 0.5 * (edges[1:] + edges[:-1])
    r = np.array([radius(one)[0] for one in s])
    x, wx = np.polynomial.legendre.leggauss(m)
    angle = np.pi * (np.arange(m) + 0.5) / m
    chord = r[:, None] * np.sin(angle)[None, :]  # half chord along the normal at a height
    y = chord[:, :, None] * x
    weight = (LENGTH / n * np.pi / m) * (r[:, None] * np.sin(angle))[:, :, None] * chord[:, :, None] * wx

    def places(time):
        at, tangent = midline(s, time)
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], 1)
        turn = np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0]))
        k = np.gradient(turn, s, edge_order=2)[:, None, None]
        reach = y + 0.5 * k * chord[:, :, None] ** 2
        offset = 2.0 * reach / (1.0 + np.sqrt(1.0 + 2.0 * k * reach))
        return at[:, None, None, :] + offset[..., None] * normal[:, None, None, :]

    at, rate = places(0.0), time_rate_of(places)
    volume = weight.sum()
    centre = (weight[..., None] * at).sum((0, 1, 2)) / volume
    velocity = (weight[..., None] * rate).sum((0, 1, 2)) / volume
    from_centre, relative = at - centre, rate - velocity
    inertia = (weight * (from_centre**2).sum(-1)).sum()
    cross = from_centre[..., 0] * relative[..., 1] - from_centre[..., 1] * relative[..., 0]
    return centre, velocity, (weight * cross).sum() / inertia


def swim(spacing, n_around, depth=0.5, more=1.4):
    """Velocity of the centre, angular velocity less the recoil, power, residual and number of unknowns."""
    sources = surface_at(inner(spacing, n_around, depth), 0.0)
    rings, area = outer(spacing / more, round(more * n_around))
    points = surface_at(rings, 0.0)
    slip = rate_of(lambda time: surface_at(rings, time))
    weight = np.repeat(np.sqrt(area), 3)[:, None]
    wanted = np.column_stack([motions(points), slip.ravel()])
    forces = lstsq(
        stokeslets(points, sources) * weight, wanted * weight, cond=1e-13, lapack_driver="gelsy"
    )[0]
    loads = motions(sources).T @ forces
    rigid = np.linalg.solve(loads[:, :6], -loads[:, 6])
    answer = np.append(rigid, 1.0)

    other, area = outer(spacing / more / 1.13, round(more * n_around) + 3)
    at = surface_at(other, 0.0)
    moved = np.column_stack([motions(at), rate_of(lambda time: surface_at(other, time)).ravel()]) @ answer
    of_all = forces @ answer
    residual = np.linalg.norm((stokeslets(at, sources) @ of_all - moved).reshape(-1, 3), axis=1).max()
    normals, stretched = outward(other)
    power = power_of(at, area * stretched, normals, moved.reshape(-1, 3), sources, of_all.reshape(-1, 3))

    centre, velocity, recoil = interior(rate_of)
    omega = rigid[5]
    moving = rigid[:2] + velocity + omega * np.array([-centre[1], centre[0]])
    return moving, omega + recoil, recoil, power, residual, 3 * len(sources)


def outward(rings):
    """Outward normals of the points of rings, and how much bending has stretched the surface there."""
    s = np.array([ring[0] for ring in rings])
    _, tangent = midline(s, 0.0)
    step = 1e-5
    _, ahead = midline(s + step, 0.0)
    _, behind = midline(s - step, 0.0)
    turn = (ahead - behind) / (2.0 * step)
    normals, stretched = [], []
    for (at, r, n, first), along, bend in zip(rings, tangent, turn, strict=True):
        angle = first + 2.0 * np.pi * np.arange(n) / n
        normal = np.array([along[1], -along[0]])
        stretch = 1.0 - (bend @ normal) * r * np.cos(angle)
        slope = radius(at)[1]
        out = np.column_stack([np.outer(np.cos(angle), normal), np.sin(angle)])
        out = out * stretch[:, None] - slope * np.append(along, 0.0)
        size = np.linalg.norm(out, axis=1)
        normals.append(out / size[:, None])
        stretched.append(size / np.hypot(1.0, slope))
    return np.concatenate(normals), np.concatenate(stretched)


if __name__ == "__main__":
    levels = [(0.30, 8), (0.22, 10), (0.17, 12)]
    for level in levels[: int(sys.argv[1]) if len(sys.argv) > 1 else None]:
        moving, omega, recoil, power, residual, n = swim(*level)
        print(
            f"{n} unknowns: velocity {moving[0]:.6f} {moving[1]:.6f}, angular velocity {omega:.6f} "
            f"(recoil {recoil:.6f}), power {power:.4f}, residual {residual:.1e}",
            flush=True,
        )
