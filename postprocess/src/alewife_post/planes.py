"""Planes that cut through space: as asked for, or the one that goes through the bodies."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from alewife_post import bodies
from alewife_post.read import Run

Array = np.ndarray

AXES = "xyz"
THROUGH = 0.25
"""Distance from a plane, over the radius of a body, up to which it goes through its centre."""


@dataclass(frozen=True)
class Plane:
    """A plane with two coordinates in it."""

    origin: Array
    """`(3,)`."""
    across: Array
    """Unit vectors along the coordinates, `(2, 3)`."""
    names: tuple[str, str]
    """Of the coordinates."""
    text: str
    """As a title says it."""

    @property
    def normal(self) -> Array:
        """`(3,)`; seen against it, the second coordinate is left of the first one."""
        return np.cross(*self.across)

    def coordinates(self, points: Array) -> Array:
        """Points `(n, 3)` in the plane, as `(n, 2)`."""
        return (points - self.origin) @ self.across.T

    def points(self, coordinates: Array) -> Array:
        """Coordinates `(..., 2)` in space, as `(..., 3)`."""
        return self.origin + coordinates @ self.across


def straight(axis: int, height: float) -> Plane:
    """The plane across an axis, whose coordinates are the two others."""
    across = np.eye(3)[[other for other in range(3) if other != axis]]
    names = tuple(AXES[other] for other in range(3) if other != axis)
    return Plane(height * np.eye(3)[axis], across, names, f"{AXES[axis]} = {round(height, 12):.4g}")


def parsed(text: str) -> Plane:
    """A plane written as `z=0.5`."""
    return straight(*parsed_axis(text))


def parsed_axis(text: str) -> tuple[int, float]:
    """The axis a plane lies across, and where, written as `z=0.5`."""
    found = re.fullmatch(r"\s*([xyz])\s*=\s*([-+0-9.eE]+)\s*", text)
    if found:
        try:
            return AXES.index(found[1]), float(found[2])
        except ValueError:
            pass
    raise ValueError(f"{text} is not a plane: write one such as z=0.5")


def through_bodies(run: Run, times: Array, box: Array) -> Plane:
    """Across z, y or x where that goes through all bodies at some times, else the nearest plane.

    A run without bodies is cut across z through the middle of its `box` `(2, 3)`.
    """
    points, size = [], 0.0
    for time in times[:: max(1, len(times) // 50)]:
        placed = bodies.poses(run, float(time))
        points += [center for center, _ in placed.values()]
        for arrow in bodies.headings(run, placed):
            # Its tip, so that a swimmer swims within the plane.
            points.append(arrow.start + arrow.vector)
        size = max([size, *(bodies.radius(run, name) for name in placed)])
    if not points:
        return straight(2, float(box[:, 2].mean()))
    found = np.array(points)
    # Of bodies that only the mesh knows no radius is at hand
    rounded = size or 0.05 * float(np.ptp(box, axis=0).min())
    for axis in (2, 1, 0):
        if np.ptp(found[:, axis]) <= 2 * THROUGH * size:
            middle = 0.5 * (found[:, axis].min() + found[:, axis].max())
            return straight(axis, _plain(middle, rounded))
    return _nearest(found)


def _plain(height: float, size: float) -> float:
    """A height of four digits at most, up to a hundredth of some size: centres are near it only."""
    is_plain = abs(height) >= 0.01 * size and float(f"{height:.4g}") == height
    if is_plain or not size > 0.0:
        return float(height)
    step = 10.0 ** np.floor(np.log10(0.01 * size))
    # Not by a factor of the step, which has rounding of its own; and no minus zero
    return float(np.round(height, int(-np.log10(step)))) + 0.0


def _nearest(points: Array) -> Plane:
    origin = points.mean(axis=0)
    _, extents, directions = np.linalg.svd(points - origin, full_matrices=False)
    first = directions[0] * np.sign(directions[0][np.argmax(np.abs(directions[0]))])
    if extents[1] > 1e-3 * extents[0]:
        second = directions[1]
    else:
        # All on a line: of all planes through it, the most upright one.
        second = np.eye(3)[2] if abs(first[2]) < 0.9 else np.eye(3)[0]
        second = second - (second @ first) * first
    second = second / np.linalg.norm(second)
    second = second * np.sign(second[np.argmax(np.abs(second))])
    names = tuple(f"along ({', '.join(f'{part:.2f}' for part in own)})" for own in (first, second))
    return Plane(origin, np.array([first, second]), names, "plane through the bodies")
