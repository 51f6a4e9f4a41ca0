"""Streamlines of a flow in space: from places all over a box, those that keep apart."""

from __future__ import annotations

import numpy as np

from alewife_post.read import Field
from alewife_post.sections import curves, pieces

Array = np.ndarray

SEEDS = 400
"""Places where a line may begin, evenly over the box."""
LINES = 36
"""Lines at most."""
APART = 0.055
"""Distance of lines over the longest side of the box."""
NEW = 0.6
"""Part of a line that is so far from others, at least."""
LENGTH = 1.5
"""Longest way of a line, each way, over the longest side of the box."""
SHORTEST = 0.25
"""Shortest, likewise."""
MOST_TURN = 1.2 * np.pi
"""Angle (rad) by which a line turns at most, from its middle each way."""
POINTS = 160
"""Points of a line at most."""


def streamlines(field: Field, box: Array) -> list[Array]:
    """Lines `(n, 3)` within a box `(2, 3)`.

    Long ones come first: short ones fill what they leave free.
    """
    import pyvista

    corners = field.nodes[field.cells]
    extent = float(np.ptp(box, axis=0).max())
    near = (corners.max(axis=1) >= box[0]).all(axis=1) & (corners.min(axis=1) <= box[1]).all(axis=1)
    if not near.any():
        return []
    speed = np.linalg.norm(field.velocity, axis=1)
    grid = pieces(field, near, speed)
    grid.point_data["velocity"] = field.velocity
    seeds = pyvista.PolyData(box[0] + halton(SEEDS) * (box[1] - box[0]))
    found = grid.streamlines_from_source(
        seeds,
        vectors="velocity",
        integration_direction="both",
        max_length=LENGTH * extent,
        initial_step_length=0.5,
        max_step_length=1.0,
        terminal_speed=1e-4 * float(speed.max() or 1.0),
        max_steps=1500,
        compute_vorticity=False,
    )
    lines = [_inside(_unwound(line), box) for line in curves(found)]
    lines = [line[:: max(1, len(line) // POINTS)] for line in lines if len(line) > 2]
    lengths = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines]
    order = [nth for nth in np.argsort(lengths)[::-1] if lengths[nth] > SHORTEST * extent]
    return _apart([lines[nth] for nth in order], APART * extent)


def halton(n: int, bases: tuple[int, ...] = (2, 3, 5)) -> Array:
    """Points evenly over the unit cube, `(n, d)`, by the sequence of Halton."""
    found = np.zeros((n, len(bases)))
    for axis, base in enumerate(bases):
        left, share = np.arange(1, n + 1), 1.0 / base
        while left.any():
            found[:, axis] += share * (left % base)
            left, share = left // base, share / base
    return found


def _unwound(line: Array) -> Array:
    """A line up to where it has turned so far that it winds: there errors of a closed one show."""
    steps = np.diff(line, axis=0)
    size = np.linalg.norm(steps, axis=1)
    steps = steps[size > 0.0] / size[size > 0.0, None]
    turn = np.arccos(np.clip((steps[:-1] * steps[1:]).sum(axis=1), -1.0, 1.0))
    # From the middle, both ways
    at = np.cumsum(np.append([0.0, 0.0], turn))
    kept = np.abs(at - at[len(at) // 2]) <= MOST_TURN
    return line[: len(at)][kept]


def _inside(line: Array, box: Array) -> Array:
    """The longest stretch of a line that is in a box."""
    is_in = ((line >= box[0]) & (line <= box[1])).all(axis=1)
    ends = np.flatnonzero(np.diff(np.concatenate([[0], is_in.astype(int), [0]])))
    if len(ends) == 0:
        return line[:0]
    starts, stops = ends[::2], ends[1::2]
    longest = int(np.argmax(stops - starts))
    return line[starts[longest] : stops[longest]]


def _apart(lines: list[Array], least: float) -> list[Array]:
    kept: list[Array] = []
    taken = np.zeros((0, 3))
    for line in lines:
        if len(taken):
            away = np.linalg.norm(line[::4, None] - taken[None], axis=2).min(axis=1)
            if (away > least).mean() < NEW:
                continue
        kept.append(line)
        taken = np.vstack([taken, line[::4]])
        if len(kept) == LINES:
            break
    return kept
