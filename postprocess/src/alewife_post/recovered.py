"""Fields recovered from those of the elements: a pressure without their scatter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alewife_post.cells import ENDS
from alewife_post.read import Field

Array = np.ndarray

REGULAR = 1e-9
"""Added to the diagonal of a fit over its mean: a vertex with few neighbours has a fit as well."""


def smooth_pressure(field: Field) -> Field:
    """The flow with the pressure of a vertex from a linear fit through its neighbours.

    Vertices of all its cells are neighbours. A linear pressure stays as it is, at boundaries, too:
    what goes is its scatter from vertex to vertex. Between vertices it is linear.
    """
    d = field.nodes.shape[1]
    vertices = field.cells[:, : d + 1]
    n = len(field.nodes)
    first, second = (
        vertices[:, pair].ravel()
        for pair in np.array([(i, j) for i in range(d + 1) for j in range(d + 1)]).T
    )
    # Each neighbour once, however many cells they share
    first, second = np.divmod(np.unique(first.astype(np.int64) * n + second), n)
    away = field.nodes[second] - field.nodes[first]
    count = np.maximum(np.bincount(first, minlength=n), 1)
    size = np.sqrt(_sums(first, (away**2).sum(axis=1), n) / count)
    terms = np.column_stack([np.ones(len(first)), away / np.maximum(size, 1e-300)[first, None]])
    matrix = np.empty((n, d + 1, d + 1))
    right = np.empty((n, d + 1))
    for i in range(d + 1):
        right[:, i] = _sums(first, terms[:, i] * field.pressure[second], n)
        for j in range(d + 1):
            matrix[:, i, j] = _sums(first, terms[:, i] * terms[:, j], n)
    own = np.unique(vertices)
    scale = np.trace(matrix[own], axis1=1, axis2=2) / (d + 1)
    matrix = matrix[own] + (REGULAR * scale)[:, None, None] * np.eye(d + 1)
    pressure = field.pressure.copy()
    pressure[own] = np.linalg.solve(matrix, right[own][..., None])[:, 0, 0]
    ends = vertices[:, ENDS[d]]
    pressure[field.cells[:, d + 1 :]] = pressure[ends].mean(axis=2)
    return replace(field, pressure=pressure)


def _sums(place: Array, values: Array, n: int) -> Array:
    return np.bincount(place, weights=values, minlength=n)
