"""Streamlines of flows without a stream function: traced on a grid, evenly spaced."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alewife_post.streamlines import APART, HEAD, Streamlines, View, at_edge, with_heads, within

Array = np.ndarray

SPACING = 0.05
"""Least distance of a line from others where it begins, over a square as large as the fluid."""
CLOSEST = 0.4
"""Part of that up to which lines come near each other before they end."""
STEP = 0.2
"""Length of a step over the distance of lines."""
SHORTEST = 2.0
"""A line is as long as so many distances of lines, or left out."""
LONGEST = 6.0
"""A line is at most so many times as long as both sides of the view, each way."""
CANDIDATES = 90
"""Places where a line may begin, on the longer side of the view."""
ALIKE = 0.15
"""Root mean square of the difference of directions up to which a flow is its mirror image."""
STILL = 1e-6
"""Speed over the largest one at and below which nothing flows."""


@dataclass(frozen=True)
class Grid:
    """A velocity on a regular grid, masked outside the fluid."""

    x: Array
    """`(n,)`."""
    y: Array
    """`(m,)`."""
    velocity: Array
    """`(m, n, 2)`, not a number outside the fluid."""

    @classmethod
    def of(cls, x: Array, y: Array, velocity: Array) -> Grid:
        """The same of a masked velocity; fluid at rest is none."""
        own = np.ma.filled(velocity.astype(float), np.nan)
        size = np.linalg.norm(own, axis=2)
        own[~(size > STILL * np.nanmax(size, initial=0.0))] = np.nan
        return cls(x, y, own)

    @property
    def area(self) -> float:
        """That of the fluid."""
        cell = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
        return float(np.isfinite(self.velocity[..., 0]).sum() * cell)

    def widened(self) -> Grid:
        """With one more layer of points, as their neighbours are: lines reach walls."""
        padded = np.pad(self.velocity, ((1, 1), (1, 1), (0, 0)), constant_values=np.nan)
        m, n = self.velocity.shape[:2]
        shifts = [(1 + i, 1 + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        around = np.array([padded[i : i + m, j : j + n] for i, j in shifts])
        count = np.isfinite(around).sum(axis=0)
        mean = np.nansum(around, axis=0) / np.maximum(count, 1)
        filled = np.where(count > 0, mean, np.nan)
        return Grid(self.x, self.y, np.where(np.isfinite(self.velocity), self.velocity, filled))

    def at(self, points: Array) -> Array:
        """Velocity `(n, 2)` at points `(n, 2)`, by linear interpolation."""
        place = (points - [self.x[0], self.y[0]]) / [self.x[1] - self.x[0], self.y[1] - self.y[0]]
        last = np.array([len(self.x), len(self.y)]) - 1
        is_here = ((place >= 0.0) & (place <= last)).all(axis=1)
        place = np.where(is_here[:, None], place, 0.0)
        cell = np.clip(np.floor(place).astype(int), 0, last - 1)
        s, t = np.clip(place - cell, 0.0, 1.0).T[..., None]
        i, j = cell.T
        v = self.velocity
        found = (1 - t) * ((1 - s) * v[j, i] + s * v[j, i + 1])
        found = found + t * ((1 - s) * v[j + 1, i] + s * v[j + 1, i + 1])
        return np.where(is_here[:, None], found, np.nan)


@dataclass(frozen=True)
class Mirror:
    """A line across an axis, in which a flow is its own image."""

    axis: int
    at: float
    sign: float
    """Minus one where the image goes the other way: such a flow goes across the line."""

    def images(self, points: Array) -> Array:
        """Points `(n, 2)` on the other side."""
        found = points.copy()
        found[:, self.axis] = 2.0 * self.at - found[:, self.axis]
        return found

    def turned(self, vectors: Array) -> Array:
        """Vectors `(n, 2)` on the other side."""
        return self.sign * vectors * np.where(np.arange(2) == self.axis, -1.0, 1.0)


def traced(
    grid: Grid, view: View, middles: Sequence[Array], mirror: Mirror | None = None
) -> Streamlines:
    """Evenly spaced lines in a view, with arrow heads.

    A flow that is its own image in a line through the middle of the view, or one of `middles`
    `(2,)`, has lines that are images of each other; one that is known to be has a `mirror`.
    """
    middle = np.array([0.5 * (view[0] + view[1]), 0.5 * (view[2] + view[3])])
    mirrors = [] if mirror is None else [mirror]
    for axis in range(2):
        if not any(known.axis == axis for known in mirrors):
            places = [middle[axis], *(float(own[axis]) for own in middles)]
            found = (found_mirror(grid, axis, place) for place in places)
            mirrors += [one for one in found if one is not None][:1]
    part = np.array(view, dtype=float)
    for one in mirrors:
        low, high = part[2 * one.axis : 2 * one.axis + 2]
        if one.at - low > high - one.at:
            part[2 * one.axis + 1] = one.at
        else:
            part[2 * one.axis] = one.at
    lines = _Tracer(grid, tuple(part), SPACING * grid.area**0.5, mirrors).lines()
    found = with_heads(lines, view)
    return _mirrored(found, view, mirrors)


def found_mirror(grid: Grid, axis: int, place: float) -> Mirror | None:
    """The line across an axis at a place, if the flow is its own image in it."""
    x, y = np.meshgrid(grid.x, grid.y)
    points = np.column_stack([x.ravel(), y.ravel()])
    ends = (grid.x, grid.y)[axis][[0, -1]]
    if not ends[0] < place < ends[1]:
        return None
    own = _directions(grid.velocity.reshape(-1, 2))
    plain = Mirror(axis, place, 1.0)
    other = plain.turned(_directions(grid.at(plain.images(points))))
    both = np.isfinite(own).all(axis=1) & np.isfinite(other).all(axis=1)
    # Of a view that is mostly on one side nothing can be concluded
    if both.sum() < max(1.0, 0.5 * np.isfinite(own).all(axis=1).sum()):
        return None
    for sign in (1.0, -1.0):
        away = np.linalg.norm(own[both] - sign * other[both], axis=1)
        if np.sqrt(np.mean(away**2)) < ALIKE:
            return Mirror(axis, place, sign)
    return None


def _directions(velocity: Array) -> Array:
    return velocity / np.linalg.norm(velocity, axis=1, keepdims=True)


def _mirrored(found: Streamlines, view: View, mirrors: list[Mirror]) -> Streamlines:
    """Lines and heads with their images, as far as they are in a view."""
    lines, heads, ways = found.lines, found.heads, found.directions
    least = 0.5 * APART * HEAD * max(view[1] - view[0], view[3] - view[2])
    for one in mirrors:
        # An image of a head is not to lie beside it.
        kept = np.abs(heads[:, one.axis] - one.at) > least
        heads, ways = heads[kept], ways[kept]
        order = 1 if one.sign > 0 else -1
        lines = lines + [one.images(line)[::order] for line in lines]
        heads, ways = np.vstack([heads, one.images(heads)]), np.vstack([ways, one.turned(ways)])
    lines = [part for line in lines for part in within(line, view)]
    low, high = np.array(view[::2]), np.array(view[1::2])
    seen = ((heads >= low) & (heads <= high)).all(axis=1)
    return Streamlines(lines, heads[seen], ways[seen])


class _Tracer:
    """Lines in a part of a view, each begun as far from all others as can be."""

    def __init__(self, grid: Grid, part: View, spacing: float, mirrors: list[Mirror]) -> None:
        self.grid, self.spacing = grid.widened(), spacing
        x0, x1, y0, y1 = part
        self.low, self.high = np.array([x0, y0]), np.array([x1, y1])
        step = max(x1 - x0, y1 - y0) / CANDIDATES
        x, y = (
            start + (np.arange(n) + 0.5) * (end - start) / n
            for start, end, n in (
                (x0, x1, max(2, round((x1 - x0) / step))),
                (y0, y1, max(2, round((y1 - y0) / step))),
            )
        )
        places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        flow = grid.at(places)
        is_fluid = np.isfinite(flow).all(axis=1)
        self.places, self.flow = places[is_fluid], flow[is_fluid]
        self.away = np.full(len(self.places), np.inf)
        for one in mirrors:
            if one.sign > 0:
                # As if half a distance beyond the line there were one that goes along it
                gap = np.abs(self.places[:, one.axis] - one.at) + 0.5 * spacing
                self.away = np.minimum(self.away, gap)
        # Nor along walls: the layer of points next to the fluid.
        is_wall = np.isfinite(self.grid.velocity[..., 0]) & ~np.isfinite(grid.velocity[..., 0])
        rows, columns = np.nonzero(is_wall)
        self._keep_away(np.column_stack([grid.x[columns], grid.y[rows]]), 0.5 * spacing)
        # Nor does a line come near its own image.
        self.beside = [(one.axis, one.at) for one in mirrors if one.sign > 0]
        self.known = np.zeros((0, 2))

    def lines(self) -> list[Array]:
        """All lines, those that are begun first before the others."""
        found = []
        size = np.linalg.norm(self.flow, axis=1)
        while len(self.places):
            far = self.away.max()
            if far < self.spacing:
                break
            # Where it flows fastest, of places that are as far from all lines
            best = np.flatnonzero(self.away >= min(far * (1.0 - 1e-9), 1e300))
            first = int(best[np.argmax(size[best])])
            line = self._line(self.places[first])
            self.away[first] = 0.0
            if np.linalg.norm(np.diff(line, axis=0), axis=1).sum() < SHORTEST * self.spacing:
                continue
            found.append(line)
            self.known = np.vstack([self.known, line])
            self._keep_away(line, 0.0)
        return found

    def _keep_away(self, points: Array, room: float) -> None:
        """Measure how far places are from points `(n, 2)`, which some room is added to."""
        for piece in np.array_split(points, max(1, len(points) // 64)):
            if len(piece):
                gap = np.linalg.norm(self.places[:, None] - piece[None], axis=2).min(axis=1)
                self.away = np.minimum(self.away, gap + room)

    def _line(self, start: Array) -> Array:
        """The line through a place, the way the fluid goes."""
        forwards, is_closed = self._way(start, 1.0)
        if is_closed:
            return np.vstack([forwards, forwards[:1]])
        backwards, _ = self._way(start, -1.0)
        return np.vstack([backwards[:0:-1], forwards])

    def _way(self, start: Array, sign: float) -> tuple[Array, bool]:
        """One way from a place up to another line, a side or the place itself; whether the last."""
        step = STEP * self.spacing
        points, at = [start], start
        own = np.zeros((0, 2))
        n_most = int(LONGEST * (self.high - self.low).sum() / step)
        # So many steps behind, a line is another one
        n_behind = int(np.ceil(4.0 * CLOSEST / STEP))
        for k in range(n_most):
            after = self._stepped(at, sign * step)
            if after is None:
                break
            outside = (after < self.low) | (after > self.high)
            if outside.any():
                points.append(at_edge(at, after, self.low, self.high)[0])
                break
            least = CLOSEST * self.spacing
            if _is_near(after, self.known, least):
                break
            if any(2.0 * abs(after[axis] - place) < least for axis, place in self.beside):
                break
            away = np.linalg.norm(after - start)
            if k > n_behind and away < step:
                return np.array(points), True
            if k % n_behind == 0:
                own = np.array(points[:-n_behind]).reshape(-1, 2)
            # A spiral ends, but a ring may come home
            if away > least and _is_near(after, own, least):
                break
            points.append(after)
            at = after
        return np.array(points), False

    def _stepped(self, at: Array, step: float) -> Array | None:
        """A step of Runge and Kutta's of fourth order along the direction of the flow."""

        def way(point: Array) -> Array:
            velocity = self.grid.at(point[None])[0]
            return velocity / np.hypot(*velocity)

        a = way(at)
        b = way(at + 0.5 * step * a)
        c = way(at + 0.5 * step * b)
        d = way(at + step * c)
        found = at + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        return found if np.isfinite(found).all() else None


def _is_near(point: Array, others: Array, distance: float) -> bool:
    if len(others) == 0:
        return False
    away = others - point
    return bool(np.einsum("ij,ij->i", away, away).min() < distance**2)
