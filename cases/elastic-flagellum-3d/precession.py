#!/usr/bin/env python3
"""References of `elastic-flagellum-3d`: method of fundamental solutions and a Kirchhoff rod.

A spheroid with a magnetic moment ahead and an elastic tail clamped behind it, in a field that turns
about x on a cone. Once they follow, head and tail keep their shape in axes that turn with the field,
while the material rolls about its own midline, at a rate that is the same all along it: what is
sought is steady, and no time is stepped. Stokeslets inside the bodies and outside of the container
make the velocity on the surfaces that of the bodies, in the mean of squares. Tractions on the surfaces
are the loads of the rod, whose two curvatures are Legendre polynomials in the length. Newton's method
finds curvatures and the direction of the head for which moments balance.

    python precession.py [BENDING [POLYNOMIALS [RESOLUTIONS]]]

Some minutes; needs numpy and scipy. Printed are the speed along x, the power of the field, its lag, the
sine of the cone of the head, radii of the circles of head and tip, elastic energy of bending and of
twist, the rate at which the head turns about x and rolls, the curvature in the middles of eight elements
where it is largest, and two errors: velocity on the surface, and tractions against Stokeslets.
"""

import sys

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import lstsq
from scipy.optimize import root

AHEAD, ASIDE = 0.3, 0.2  # semi-axes of the head
LENGTH = 1.04  # up to where the sides of the tail would meet
HALF, START, WIDTH, CORNER, TIP = LENGTH * np.array([0.08, 0.92, 0.0799, 0.06, 0.055])
MOMENT, ACROSS, RATE = 96.0, 0.5, 2.0 * np.pi
BENDING = 5.6
TWISTING = 2.0 / 3.0 * BENDING
CONTAINER = 4.0


def outline():
    """Where the pieces of the profile meet, and the middles of its arcs."""
    flank = np.array([START - HALF, WIDTH - HALF])
    wedge = np.array([LENGTH - START, -WIDTH])
    flank /= np.linalg.norm(flank)
    wedge /= np.linalg.norm(wedge)
    cut = CORNER * np.tan(0.5 * np.arccos(flank @ wedge))
    corner = np.array([START, WIDTH])
    outward = np.array([-wedge[1], wedge[0]])
    begin, end = corner - flank * cut, corner + wedge * cut
    middle = LENGTH - TIP / outward[0]
    return begin, end, end - outward * CORNER, middle, middle + outward[0] * TIP


BEGIN, END, CENTRE, MIDDLE, TOUCH = outline()
LAST = MIDDLE + TIP  # length of the midline
CENTRE_OF_TAIL = 0.9  # behind that of the head


def profile(piece, u, depth):
    """Distance from the head, radius, normal and speed on a piece at u from 0 to 1, below it."""
    if piece in (0, 2, 4):
        middle, radius, ends = [
            ((HALF, 0.0), HALF, (np.pi, 0.5 * np.pi)),
            None,
            (
                CENTRE,
                CORNER,
                (np.arctan2(*(BEGIN - CENTRE)[::-1]), np.arctan2(*(END - CENTRE)[::-1])),
            ),
            None,
            ((MIDDLE, 0.0), TIP, (np.arccos((TOUCH - MIDDLE) / TIP), 0.0)),
        ][piece]
        angle = ends[0] + u * (ends[1] - ends[0])
        along, across = np.cos(angle), np.sin(angle)
        speed = radius * abs(ends[1] - ends[0])
        inner = radius - depth
        return middle[0] + inner * along, middle[1] + inner * across, along, across, speed
    touch = np.array([TOUCH, TIP * np.sqrt(1.0 - ((TOUCH - MIDDLE) / TIP) ** 2)])
    first, last = [(np.array([HALF, HALF]), BEGIN), (END, touch)][piece // 2]
    way = last - first
    speed = np.linalg.norm(way)
    along, across = -way[1] / speed, way[0] / speed
    at = first[None] + np.outer(u, way)
    return at[:, 0] - depth * along, at[:, 1] - depth * across, 0 * u + along, 0 * u + across, speed


def tail(density, around, depth):
    """Points of a tail along x: distance, radius, normal and area; and their angles."""
    rows = []
    for piece in range(5):
        speed = profile(piece, np.array([0.5]), 0.0)[4]
        n = max(2, round(density * speed))
        x, w = np.polynomial.legendre.leggauss(n)
        s, radius, along, across, _ = profile(piece, 0.5 * (x + 1.0), depth)
        rows.append(
            np.stack([s, radius, along, across, 0.5 * w * speed * 2.0 * np.pi * radius / around], 1)
        )
    rings = np.concatenate(rows)
    shift = 0.5 * (np.arange(len(rings)) % 2)
    angle = 2.0 * np.pi * (np.arange(around)[None] + shift[:, None]) / around
    return np.repeat(rings, around, 0), angle.ravel()


def distance():
    """From the centre of the head to the tail, whose origin is in the centre of its volume."""
    rings, _ = tail(60.0, 1, 0.0)
    s, radius, along, _, weight = rings.T
    volume = (weight * (s * along + radius * rings[:, 3])).sum() / 3.0
    first = 0.5 * (weight * along * s**2).sum()
    return CENTRE_OF_TAIL - first / volume


def ball(n, radius):
    """Points spread evenly over a sphere about x."""
    i = np.arange(n) + 0.5
    z, angle = 1.0 - 2.0 * i / n, np.pi * (1.0 + 5**0.5) * i
    r = np.sqrt(1.0 - z * z)
    return radius * np.stack([z, r * np.cos(angle), r * np.sin(angle)], 1)


def spheroid(n, depth):
    """Points on a spheroid confocal to the head, this part below it; area and normal of each."""
    inner = ASIDE * (1.0 - depth)
    along = np.sqrt(AHEAD**2 - ASIDE**2 + inner**2)
    unit = ball(n, 1.0)
    scaled = unit / np.array([along, inner, inner])
    size = np.linalg.norm(scaled, axis=1)
    area = 4.0 * np.pi / n * along * inner**2 * size
    return unit * np.array([along, inner, inner]), area, scaled / size[:, None]


def ahead(direction):
    """The rotation that takes x to a direction."""
    axis = np.cross([1.0, 0.0, 0.0], direction)
    across = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + across + across @ across / (1.0 + direction[0])


def stokeslets(apart):
    """Velocities by unit forces, viscosity 1."""
    inverse = 1.0 / np.linalg.norm(apart, axis=2)
    tensor = apart[..., :, None] * apart[..., None, :] * (inverse**3)[..., None, None]
    for i in range(3):
        tensor[..., i, i] += inverse
    n, m = inverse.shape
    return (tensor / (8.0 * np.pi)).transpose(0, 2, 1, 3).reshape(3 * n, 3 * m)


def tractions(apart, normals):
    """Tractions by unit forces on surfaces with these normals into the fluid."""
    inverse = 1.0 / np.linalg.norm(apart, axis=2)
    factor = -0.75 / np.pi * np.einsum("nmi,ni->nm", apart, normals) * inverse**5
    tensor = apart[..., :, None] * apart[..., None, :] * factor[..., None, None]
    n, m = inverse.shape
    return tensor.transpose(0, 2, 1, 3).reshape(3 * n, 3 * m)


class Swimmer:
    """Head and tail by their points, and what moments leave for a shape."""

    def __init__(self, modes, density, around, on_head, outside, depth=0.6):
        self.modes = modes
        self.grid = np.linspace(0.0, LAST, 801)
        x = 2.0 * self.grid / LAST - 1.0
        self.basis = np.polynomial.legendre.legvander(x, modes - 1)
        mid = 0.5 * (x[1:] + x[:-1])
        self.mid = np.polynomial.legendre.legvander(mid, modes - 1)
        self.sources = (spheroid(on_head, depth)[0], *tail(density, around, depth * HALF))
        more = round(1.5 * around) | 1
        head, self.head_area, self.head_normal = spheroid(round(2.2 * on_head), 0.0)
        self.surface = (head, *tail(1.6 * density, more, 0.0))
        self.far = ball(outside, 1.6 * CONTAINER), ball(2 * outside, CONTAINER)

    def midline(self, direction, curvatures):
        """Places and frames on the grid, with the head in the origin."""
        k1, k2 = self.mid @ curvatures[0], self.mid @ curvatures[1]
        step = self.grid[1]
        t = -direction
        d1 = np.array([0.0, 1.0, 0.0]) - t[1] * t
        d1 /= np.linalg.norm(d1)
        frame = np.stack([t, d1, np.cross(t, d1)])  # rows
        frames, places = [frame], [-direction * distance()]
        for a, b in zip(k1, k2, strict=True):
            size = np.hypot(a, b) * step
            turn = np.array([[0, a, b], [-a, 0, 0], [-b, 0, 0]]) * step
            if size > 1e-12:
                s1, s2 = np.sin(size) / size, (1 - np.cos(size)) / size**2
                s3 = (1 - s1) / size**2
            else:
                s1, s2, s3 = 1.0, 0.5, 1 / 6
            square = turn @ turn
            mean = np.eye(3) + s2 * turn + s3 * square
            places.append(places[-1] + step * (mean @ frame)[0])
            frame = (np.eye(3) + s1 * turn + s2 * square) @ frame
            frames.append(frame)
        return np.array(places), np.array(frames)

    def points(self, of, direction, places, frames):
        """Places of points, normals, and velocities as the bodies roll."""
        on_head, rings, angle = of
        on_head = on_head @ ahead(direction).T
        s = rings[:, 0]
        r, f = CubicSpline(self.grid, places)(s), CubicSpline(self.grid, frames)(s)
        out = np.cos(angle)[:, None] * f[:, 1] + np.sin(angle)[:, None] * f[:, 2]
        x = np.concatenate([on_head, r + rings[:, 1:2] * out])
        normal = rings[:, 2:3] * f[:, 0] + rings[:, 3:4] * out
        spin = np.concatenate(
            [np.cross(-direction, on_head), np.cross(f[:, 0], rings[:, 1:2] * out)]
        )
        return x, normal, spin

    def solve(self, unknowns):
        """What is left of the moments, for the direction of the head and the curvatures."""
        direction = np.array([1.0, unknowns[0], unknowns[1]])
        direction /= np.linalg.norm(direction)
        curvatures = unknowns[2:].reshape(2, self.modes)
        places, frames = self.midline(direction, curvatures)
        sources, _, _ = self.points(self.sources, direction, places, frames)
        x, normal, spin = self.points(self.surface, direction, places, frames)
        n = len(x)
        on_head = len(self.surface[0])
        area = np.concatenate([self.head_area, self.surface[1][:, 4]])
        wall = np.full(len(self.far[1]), 4 * np.pi * CONTAINER**2 / len(self.far[1]) * 1e-2)
        all_sources = np.concatenate([sources, self.far[0]])
        all_points = np.concatenate([x, self.far[1]])
        weight = np.repeat(np.sqrt(np.concatenate([area, wall])), 3)
        matrix = stokeslets(all_points[:, None] - all_sources[None])
        rate = np.array([RATE, 0.0, 0.0])
        motions = [np.tile(e, (n, 1)) for e in np.eye(3)] + [spin, np.cross(rate, x)]
        wanted = np.zeros((len(matrix), 5))
        wanted[: 3 * n] = np.stack([m.ravel() for m in motions], 1)
        forces = lstsq(
            matrix * weight[:, None], wanted * weight[:, None], cond=1e-12, lapack_driver="gelsy"
        )[0]
        off = np.abs(matrix @ forces - wanted)[: 3 * n].max(0)
        normals = np.concatenate([self.head_normal @ ahead(direction).T, normal])
        load = (tractions(x[:, None] - all_sources[None], normals) @ forces).reshape(
            n, 3, 5
        ) * area[:, None, None]
        force = load.sum(0)
        torque = np.cross(x[:, :, None], load, axis=1).sum(0)
        bare = np.vstack([force, direction @ torque])
        answer = np.append(np.linalg.solve(bare[:, :4], -bare[:, 4]), 1.0)
        load = load @ answer
        torque = torque @ answer
        moment, field = MOMENT * direction, np.array([1.0, self.across, 0.0])
        magnetic = np.cross(moment, field)
        left = torque + magnetic
        pair = frames[0, 1:]
        residual = [left @ pair[0], left @ pair[1]]
        # Moments of the loads beyond: they bend about both axes, and twist
        tail_load, tail_x, s = load[on_head:], x[on_head:], self.surface[1][:, 0]
        moments = np.zeros((3, self.modes))
        for d, row in zip((frames[:, 2], -frames[:, 1], frames[:, 0]), moments, strict=True):
            for m, weights in enumerate(self.basis.T):
                integrand = weights[:, None] * np.hstack([d, np.cross(d, places)])
                sums = CubicSpline(self.grid, integrand).antiderivative()(s)
                rows = np.cross(sums[:, :3], tail_x) - sums[:, 3:]
                row[m] = (rows * tail_load).sum() * (2 * m + 1) / LAST
        residual = np.concatenate([residual, (curvatures - moments[:2] / BENDING).ravel()])
        squares = LAST / (2 * np.arange(self.modes) + 1)
        # The curvature is that in the middles of eight elements, the axis is about which all turns
        velocity, roll = answer[:3], answer[3]
        axis = np.array([-velocity[2], velocity[1]]) / RATE
        self.found = {
            "speed": velocity[0],
            "power": magnetic[0] * RATE,
            "lag": np.arccos(direction @ field / np.linalg.norm(field)),
            "cone": np.hypot(direction[1], direction[2]),
            "head": np.hypot(velocity[1], velocity[2]) / RATE,
            "tip": np.linalg.norm(places[-1][1:] - axis),
            "bending": 0.5 * BENDING * (curvatures**2 @ squares).sum(),
            "twist": 0.5 / TWISTING * moments[2] ** 2 @ squares,
            "spin": RATE + roll * -direction[0],
            "roll": roll,
            "curvature": np.linalg.norm(self.basis[50::100] @ curvatures.T, axis=1).max(),
            "residual": off @ np.abs(answer),
            "sum": np.abs(
                (forces[: 3 * len(sources)].reshape(-1, 3, 5).sum(0) + force) @ answer
            ).max(),
            "unknowns": 3 * len(all_sources),
        }
        return residual


def start(swimmer):
    """A solution on few points, and the derivative of what is left there."""
    n = 2 + 2 * swimmer.modes
    swimmer.across = 0.25 * ACROSS
    x = 4.0 * root(swimmer.solve, np.zeros(n), tol=1e-6).x
    swimmer.across = ACROSS
    x = root(swimmer.solve, x, tol=1e-8).x
    left = swimmer.solve(x)
    slopes = [(swimmer.solve(x + 1e-5 * e) - left) / 1e-5 for e in np.eye(n)]
    return x, np.array(slopes).T


def refine(swimmer, x, slopes):
    """The solution on more points, by Newton's method with the derivative found on few."""
    swimmer.across = ACROSS
    for _ in range(20):
        left = swimmer.solve(x)
        if np.abs(left).max() < 1e-6:
            break
        x = x - np.linalg.solve(slopes, left)
    print(f"{swimmer.modes} polynomials, {np.abs(left).max():.0e} left")
    for key, value in swimmer.found.items():
        print(f"    {key:10} {value:.7g}")
    sys.stdout.flush()
    return x


if __name__ == "__main__":
    BENDING = float(sys.argv[1]) if len(sys.argv) > 1 else BENDING
    TWISTING = 2.0 / 3.0 * BENDING
    modes = int(sys.argv[2]) if len(sys.argv) > 2 else 6
    x, slopes = start(Swimmer(modes, 25, 7, 60, 60))
    levels = [(28, 8, 80, 60), (32, 8, 100, 60), (44, 10, 140, 60), (60, 12, 180, 60)]
    for points in levels[: int(sys.argv[3]) if len(sys.argv) > 3 else 3]:
        x = refine(Swimmer(modes, *points), x, slopes)
