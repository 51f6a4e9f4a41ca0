"""Streamlines of flows in the plane and around an axis: contours of the stream function."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.tri import LinearTriInterpolator, Triangulation

from alewife_post.domains import periods
from alewife_post.elements import edges, inside, refine, shared_points, subdivide
from alewife_post.periodic import images
from alewife_post.read import Field, Run
from alewife_post.streamfunction import stream_function

Array = np.ndarray
View = tuple[float, float, float, float]

LARGEST_MISFIT = 0.1
"""Flows that no stream function fits so well have sources: their streamlines have other means."""
MANY_CELLS = 10_000
"""From so many cells on they are divided less: they are smaller than what is seen."""
SAMPLES = 160
"""Points at which levels are chosen on the longer side of a view."""
MOST_LINES = 26
FEWEST_LINES = 10
ALIKE = 0.02
"""Levels that differ from symmetric ones by less than this part of their range are symmetric."""
CLOSEST = 1e-3
"""Two levels are so far apart at least, over the range of them all."""
NEAR_AXIS = 0.01
"""Levels as near to that of the axis, over the range of them all, are left out."""
ARROW_SPACING = 0.45
"""Way along a line between arrow heads, over the shorter side of the view."""
SHORTEST = 0.06
"""A line that is shorter than this part of the shorter side has no arrow head."""
HEAD = 0.014
"""Length of an arrow head over the longer side of the view."""
APART = 3.5
"""Lengths of arrow heads between one and the next."""
SAME = 0.3
"""Images of each other are so near when folded, over the least distance of heads."""


@dataclass(frozen=True)
class Streamlines:
    """Lines `(n, 2)` the way the fluid goes, and the places of arrow heads on them."""

    lines: list[Array]
    heads: Array
    """Tips, `(n, 2)`."""
    directions: Array
    """Unit vectors, `(n, 2)`."""


def streamlines(run: Run, field: Field, view: View, *, mirror: bool) -> Streamlines | None:
    """Streamlines in a view, about equally far apart; none if no stream function fits the flow.

    `field` is the flow as it was read. Levels are percentiles by area, symmetric where those of the
    flow are: symmetric flows have symmetric lines.
    """
    is_axisymmetric = run.is_axisymmetric
    found = stream_function(field, is_axisymmetric=is_axisymmetric)
    if found is None or found.misfit > LARGEST_MISFIT:
        return None
    x0, x1, y0, y1 = view
    is_mirrored = is_axisymmetric and mirror and y0 < 0.0
    half = (x0, x1, max(y0, 0.0), max(-y0, y1)) if is_mirrored else view
    shown = [Piece.of(tile, psi) for tile, psi in _tiles(run.case, field, found.values, half)]
    levels = chosen_levels(shown, half, _number(view))
    if is_axisymmetric and len(levels):
        # Psi grows as the square of the distance from the axis: its lines there shake
        levels = levels[np.abs(levels) > NEAR_AXIS * np.ptp(levels)]
    lines = [line for piece in shown for line in piece.contours(levels)]
    if is_mirrored:
        lines += [line * [1.0, -1.0] for line in lines]
    lines = [part for line in lines for part in within(line, view)]
    return with_heads(lines, view)


def _number(view: View) -> int:
    """How many levels: those of a long strip lie along it, side by side.

    An even number: one in the middle would be the line of symmetry, which parts where it meets a
    body, or does not, by rounding.
    """
    width, height = view[1] - view[0], view[3] - view[2]
    wanted = MOST_LINES * np.sqrt(min(width, height) / max(width, height))
    return int(np.clip(2 * round(wanted / 2), FEWEST_LINES, MOST_LINES))


# ---- Periodic domains ----------------------------------------------------------------------------


def _tiles(case: dict[str, Any], field: Field, psi: Array, view: View) -> list[tuple[Field, Array]]:
    """Parts of the flow within a view, with psi going on from each image to the next."""
    found = []
    low, high = (np.append(end, 0.0) for end in (field.nodes.min(axis=0), field.nodes.max(axis=0)))
    region = (np.array([view[0], view[2], 0.0]), np.array([view[1], view[3], 0.0]))
    lengths = periods(case)[:2]
    jumps = _jumps(field, psi, lengths)
    for shift in images(case, low, high, region)[:, :2]:
        tile = inside(replace(field, nodes=field.nodes + shift), view)
        turns = np.divide(shift, lengths, out=np.zeros(2), where=lengths > 0)
        if len(tile.cells):
            found.append((tile, psi + turns @ jumps))
    return found


def _jumps(field: Field, psi: Array, lengths: Array) -> Array:
    """By how much psi grows over each period: what flows through it, `(2,)`."""
    jumps = np.zeros(2)
    every, is_boundary = edges(field.cells)
    own = np.unique(every[is_boundary])
    points = field.nodes[own]
    for axis in np.flatnonzero(lengths > 0):
        shift = np.where(np.arange(2) == axis, lengths[axis], 0.0)
        here, there = (
            [tuple(key) for key in np.round(1e6 * at / lengths[axis]).astype(int).tolist()]
            for at in (points, points + shift)
        )
        number = {key: nth for nth, key in enumerate(here)}
        pairs = [(nth, number[key]) for nth, key in enumerate(there) if key in number]
        if pairs:
            first, second = np.array(pairs).T
            jumps[axis] = np.median(psi[own[second]] - psi[own[first]])
    return jumps


# ---- Levels and lines ----------------------------------------------------------------------------


@dataclass(frozen=True)
class Piece:
    """Cells divided into flat triangles, with values of psi at the corners."""

    mesh: Triangulation
    psi: Array

    @classmethod
    def of(cls, field: Field, psi: Array) -> Piece:
        """The cells of a field, with nodal values of psi."""
        level = 4 if len(field.cells) < MANY_CELLS else 2
        triangles, weights = subdivide(field.cells, level)
        # Lines continue from cell to cell where these share their points.
        numbers = shared_points(field.cells, level)
        _, first, index = np.unique(numbers, return_index=True, return_inverse=True)
        x, y = refine(field.nodes, field.cells, weights)[first].T
        mesh = Triangulation(x, y, index.ravel()[triangles])
        return cls(mesh, refine(psi, field.cells, weights)[first])

    def contours(self, levels: Array) -> list[Array]:
        """Lines of equal psi, each the way the fluid goes: larger values lie on its left."""
        if len(levels) == 0:
            return []
        found = Figure().add_subplot().tricontour(self.mesh, self.psi, levels)
        return [line for lines in found.allsegs for line in lines if len(line) > 1]

    def sampled(self, x: Array, y: Array) -> Array:
        """Values at those of some points that are in the fluid."""
        return LinearTriInterpolator(self.mesh, self.psi)(x, y).compressed()


def chosen_levels(shown: list[Piece], view: View, n: int) -> Array:
    """Values of psi between which equal parts of the area lie."""
    x0, x1, y0, y1 = view
    # Points are as symmetric in the view as a symmetric flow is, whatever the mesh.
    step = max(x1 - x0, y1 - y0) / SAMPLES
    sides = ((x0, x1), (y0, y1))
    counts = [max(4, round((end - start) / step)) for start, end in sides]
    x, y = np.meshgrid(
        *(
            start + (np.arange(k) + 0.5) * (end - start) / k
            for (start, end), k in zip(sides, counts, strict=True)
        )
    )
    values = np.concatenate([np.zeros(0), *(piece.sampled(x, y) for piece in shown)])
    if len(values) == 0:
        return values
    levels = np.quantile(values, (np.arange(n) + 0.5) / n)
    span = np.ptp(levels)
    if not span > 0.0:
        return levels[:0]
    opposite = 2.0 * np.median(values) - levels[::-1]
    if np.abs(opposite - levels).max() < ALIKE * span:
        levels = 0.5 * (levels + opposite)
    kept = [levels[0]]
    for level in levels[1:]:
        if level - kept[-1] > CLOSEST * span:
            kept.append(level)
    return np.array(kept)


def within(line: Array, view: View) -> list[Array]:
    """The pieces of a line that are in a view, up to its edge."""
    low, high = np.array(view[::2]), np.array(view[1::2])
    seen = ((line >= low) & (line <= high)).all(axis=1)
    if seen.all():
        return [line]
    if np.array_equal(line[0], line[-1]):
        # A closed line begins where it is out of view.
        line = np.roll(line[:-1], -int(np.argmin(seen)), axis=0)
        line = np.concatenate([line, line[:1]])
        seen = ((line >= low) & (line <= high)).all(axis=1)
    starts = np.flatnonzero(seen & ~np.append(False, seen[:-1]))
    ends = np.flatnonzero(seen & ~np.append(seen[1:], False))
    pieces = []
    for start, end in zip(starts, ends, strict=True):
        piece = [line[start : end + 1]]
        if start > 0:
            piece.insert(0, at_edge(line[start], line[start - 1], low, high))
        if end + 1 < len(line):
            piece.append(at_edge(line[end], line[end + 1], low, high))
        pieces.append(np.concatenate(piece))
    return [piece for piece in pieces if len(piece) > 1]


def at_edge(inner: Array, outer: Array, low: Array, high: Array) -> Array:
    """Where the way from a point in view to one beyond it meets the edge, `(1, 2)`."""
    step = outer - inner
    room = np.where(step > 0, high - inner, low - inner)
    share = np.min(np.divide(room, step, out=np.ones(2), where=step != 0))
    return (inner + np.clip(share, 0.0, 1.0) * step)[None]


# ---- Arrow heads ---------------------------------------------------------------------------------


def with_heads(lines: list[Array], view: View) -> Streamlines:
    """Lines with arrow heads, at places that are symmetric where the lines are."""
    extent = np.array([view[1] - view[0], view[3] - view[2]])
    middle = np.array([0.5 * (view[0] + view[1]), 0.5 * (view[2] + view[3])])
    tips, ways = [], []
    for line in lines:
        steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
        at = np.concatenate([[0.0], np.cumsum(steps)])
        length = at[-1]
        if length < SHORTEST * extent.min():
            continue
        for place in _places(line, at, middle, ARROW_SPACING * extent.min()):
            ends = np.clip([place - 0.5e-2 * length, place + 0.5e-2 * length], 0.0, length)
            (x0, x1), (y0, y1) = (np.interp(ends, at, line[:, k]) for k in range(2))
            way = np.array([x1 - x0, y1 - y0])
            size = np.linalg.norm(way)
            if size > 0.0:
                tips.append([np.interp(place, at, line[:, k]) for k in range(2)])
                ways.append(way / size)
    heads, directions = (np.array(found).reshape(-1, 2) for found in (tips, ways))
    kept = _apart(heads, middle, APART * HEAD * extent.max())
    return Streamlines(lines, heads[kept], directions[kept])


def _apart(heads: Array, middle: Array, least: float) -> Array:
    """Numbers of heads that are not near one another, those in the middle first.

    Images of each other in the lines through the middle stay or go together.
    """
    folded = np.abs(heads - middle)
    kept = np.zeros(0, dtype=int)
    left = np.argsort(np.linalg.norm(folded, axis=1))
    while len(left):
        is_image = np.linalg.norm(folded[left] - folded[left[0]], axis=1) < SAME * least
        own, left = left[is_image], left[~is_image]
        # Those of lines side by side are no images: one of them stays.
        own = _thinned(own, heads, SAME * least)
        away = np.linalg.norm(heads[own][:, None] - heads[kept][None], axis=2)
        if (away > least).all():
            kept = np.append(kept, own)
    return kept


def _thinned(numbers: Array, heads: Array, least: float) -> Array:
    """Numbers of heads, less those that are near one before them."""
    kept: list[int] = []
    for number in numbers:
        if all(np.linalg.norm(heads[number] - heads[one]) > least for one in kept):
            kept.append(number)
    return np.array(kept, dtype=int)


def _places(line: Array, at: Array, middle: Array, spacing: float) -> Array:
    """Ways along a line `(n,)` at which it has a head."""
    length = at[-1]
    n = max(1, round(length / spacing))
    if not np.array_equal(line[0], line[-1]):
        # An odd number: one is half way, from whichever end
        n += 1 - n % 2
        return (np.arange(n) + 0.5) / n * length
    # A closed line begins anywhere: from where it is farthest from the middle of the view
    start = at[np.argmax(np.linalg.norm(line - middle, axis=1))]
    return (start + np.arange(n) / n * length) % length
