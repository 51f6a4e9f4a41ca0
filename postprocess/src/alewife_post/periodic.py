"""Periodic domains: points and fields at whole periods from where they are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from alewife_post.domains import domain_low, periods
from alewife_post.read import Field

Array = np.ndarray


def wrapped(case: dict[str, Any], points: Array) -> Array:
    """Points `(..., 3)` by whole periods away, where they are in the domain as the case has it."""
    lengths = periods(case)
    if not lengths.any():
        return points
    low = domain_low(case)
    is_periodic = lengths > 0
    away = np.where(is_periodic, np.floor((points - low) / np.where(is_periodic, lengths, 1.0)), 0)
    return points - away * lengths


def images(case: dict[str, Any], low: Array, high: Array, region: tuple[Array, Array]) -> Array:
    """Shifts `(n, 3)` by which what lies between two corners has an image in a region."""
    lengths = periods(case)
    steps = []
    for axis in range(3):
        if lengths[axis] == 0.0:
            steps.append([0.0])
            continue
        first = np.ceil((region[0][axis] - high[axis]) / lengths[axis] - 1e-9)
        last = np.floor((region[1][axis] - low[axis]) / lengths[axis] + 1e-9)
        steps.append([k * lengths[axis] for k in np.arange(first, last + 1)])
    return np.array([[x, y, z] for z in steps[2] for y in steps[1] for x in steps[0]])


def shifts(case: dict[str, Any], points: Array, region: tuple[Array, Array]) -> Array:
    """Shifts by which points `(n, 3)` have images in a region."""
    return images(case, points.min(axis=0), points.max(axis=0), region)


def is_joined(points: Array, periods: Array) -> Array:
    """Whether each of some points `(n, d)` has another one whole periods `(d,)` away."""
    is_periodic = periods > 0
    extent = np.where(is_periodic, periods, np.ptp(points, axis=0).max() + 1.0)
    part = np.where(is_periodic, (points / extent) % 1.0, points / extent)
    # Parts of a period just below one are those just above zero.
    keys = np.round(part * 1e6).astype(int) % np.where(is_periodic, 10**6, 2**62)
    _, index, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    return counts[index.ravel()] > 1


def trail(case: dict[str, Any], centers: Array) -> list[Array]:
    """The way of a centre `(n, 3)` in pieces, parted where it crosses a periodic side."""
    if len(centers) == 0:
        return []
    inside = wrapped(case, centers)
    jumps = np.abs(np.diff(inside, axis=0)) > 0.5 * np.where(
        periods(case) > 0, periods(case), np.inf
    )
    return np.split(inside, np.flatnonzero(jumps.any(axis=1)) + 1)


def tiles(case: dict[str, Any], field: Field, region: tuple[Array, Array]) -> list[Field]:
    """A field in the plane and its images, which fill a region of a periodic domain."""
    if not periods(case)[:2].any():
        return [field]
    low, high = (np.append(end, 0.0) for end in (field.nodes.min(axis=0), field.nodes.max(axis=0)))
    shifts = images(case, low, high, region)[:, :2]
    return [replace(field, nodes=field.nodes + shift) for shift in shifts]


def joined(fields: list[Field]) -> Field:
    """Several fields as one."""
    if len(fields) == 1:
        return fields[0]
    starts = np.cumsum([0, *(len(field.nodes) for field in fields)])
    return Field(
        time=fields[0].time,
        nodes=np.concatenate([field.nodes for field in fields]),
        cells=np.concatenate(
            [field.cells + start for field, start in zip(fields, starts, strict=False)]
        ),
        velocity=np.concatenate([field.velocity for field in fields]),
        pressure=np.concatenate([field.pressure for field in fields]),
        vorticity=np.concatenate([field.vorticity for field in fields]),
        derived=(
            None
            if fields[0].derived is None
            else np.concatenate([field.derived for field in fields])
        ),
        scalars={
            name: np.concatenate([field.scalars[name] for field in fields])
            for name in fields[0].scalars
        },
    )
