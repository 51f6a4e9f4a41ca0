"""Fields recovered from those of the elements: a pressure without their scatter."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from alewife_post.cells import ENDS
from alewife_post.read import Field

Array = np.ndarray

REGULAR = 1e-9
"""Added to the diagonal of a fit over its mean: a vertex with few neighbours has a fit as well."""


def smooth_pressure(field: Field) -> Field:
    """The flow with the pressure of a vertex from linear fits through its neighbours.

    Vertices of all its cells are neighbours. What the first fit leaves out is fitted once more, and
    added, so that peaks are kept; a linear pressure stays as it is, at boundaries, too. What goes
    is the scatter from vertex to vertex. Between vertices the pressure is linear.
    """
    d = field.nodes.shape[1]
    vertices = field.cells[:, : d + 1]
    fit = _Fit.of(field, vertices)
    own = field.pressure[fit.own]
    once = fit.at(own)
    pressure = field.pressure.copy()
    pressure[fit.own] = once + fit.at(own - once)
    ends = vertices[:, ENDS[d]]
    pressure[field.cells[:, d + 1 :]] = pressure[ends].mean(axis=2)
    return replace(field, pressure=pressure)


@dataclass(frozen=True)
class _Fit:
    """Linear fits by least squares about each vertex."""

    own: Array
    """Numbers of the vertices, `(n,)`."""
    first: Array
    """A vertex of each pair of neighbours, itself included, by its place in `own`."""
    second: Array
    terms: Array
    """One, and the way from the first to the second over the usual one, `(m, d + 1)`."""
    matrix: Array
    """Inverse of the normal equations, `(n, d + 1, d + 1)`."""

    @classmethod
    def of(cls, field: Field, vertices: Array) -> _Fit:
        k = vertices.shape[1]
        own, number = np.unique(vertices, return_inverse=True)
        number = number.reshape(vertices.shape)
        n = len(own)
        pairs = np.array([(i, j) for i in range(k) for j in range(k)]).T
        first, second = (number[:, one].ravel().astype(np.int64) for one in pairs)
        # Each neighbour once, however many cells they share
        first, second = np.divmod(np.unique(first * n + second), n)
        away = field.nodes[own[second]] - field.nodes[own[first]]
        count = np.maximum(np.bincount(first, minlength=n), 1)
        size = np.sqrt(_sums(first, (away**2).sum(axis=1), n) / count)
        terms = np.column_stack([np.ones(len(first)), away / np.maximum(size, 1e-300)[first, None]])
        matrix = np.empty((n, k, k))
        for i in range(k):
            for j in range(k):
                matrix[:, i, j] = _sums(first, terms[:, i] * terms[:, j], n)
        scale = np.trace(matrix, axis1=1, axis2=2) / k
        matrix += (REGULAR * scale)[:, None, None] * np.eye(k)
        return cls(own, first, second, terms, np.linalg.inv(matrix))

    def at(self, values: Array) -> Array:
        """Fitted values at the vertices, `(n,)`."""
        n, k = len(self.own), self.terms.shape[1]
        parts = [_sums(self.first, self.terms[:, i] * values[self.second], n) for i in range(k)]
        return np.einsum("ni,ni->n", self.matrix[:, 0], np.stack(parts, axis=1))


def _sums(place: Array, values: Array, n: int) -> Array:
    return np.bincount(place, weights=values, minlength=n)
