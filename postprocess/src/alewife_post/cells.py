"""Quadratic cells of up to three dimensions: values and slopes within them, points found in them.

Local coordinates of a point are its distances from the sides of the straight cell but the first
one's, `(d,)`: those of vertices 1, 2 and, in space, 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from alewife_post.periodic import images
from alewife_post.read import Field

Array = np.ndarray

ENDS = {
    1: np.array([[0, 1]]),
    2: np.array([[0, 1], [1, 2], [2, 0]]),
    3: np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]),
}
"""Vertices at the ends of each edge, in the order of the nodes in their middles."""
OUTSIDE = 1e-7
"""A point so far outside of a cell, over its size, is in it: walls are met up to rounding."""
STRAIGHT = 1e-10
"""Distance of a node from the middle of its edge, over the size of its cell."""
BULGE = 1.0
"""A curved side is no further than this from its straight one, in local coordinates."""
ITERATIONS = 12
"""Of Newton's method, for a point in a curved cell: it converges in about four."""
FARTHEST = 3.0
"""Local coordinates are kept within that while it converges."""
CHUNK = 20_000
"""Points looked for at one time."""


def weights(local: Array) -> Array:
    """Shape functions at local coordinates, `(n, d)` to `(n, k)`."""
    corners = _corners(local)
    ends = ENDS[local.shape[1]]
    middles = 4.0 * corners[:, ends[:, 0]] * corners[:, ends[:, 1]]
    return np.hstack([corners * (2.0 * corners - 1.0), middles])


def slopes(local: Array) -> Array:
    """Derivatives of the shape functions by local coordinates, `(n, d)` to `(n, k, d)`."""
    corners = _corners(local)
    d = local.shape[1]
    # Of the distances from all sides by local coordinates
    by = np.vstack([-np.ones(d), np.eye(d)])
    first, second = ENDS[d].T
    middles = corners[:, first, None] * by[second] + corners[:, second, None] * by[first]
    return np.concatenate([(4.0 * corners - 1.0)[..., None] * by, 4.0 * middles], axis=1)


def _corners(local: Array) -> Array:
    return np.column_stack([1.0 - local.sum(axis=1), local])


def reference_nodes(d: int) -> Array:
    """Local coordinates of the nodes of a cell, `(k, d)`."""
    corners = np.vstack([np.zeros(d), np.eye(d)])
    return np.vstack([corners, 0.5 * (corners[ENDS[d][:, 0]] + corners[ENDS[d][:, 1]])])


def slopes_in_space(places: Array, local: Array) -> tuple[Array, Array]:
    """Derivatives of the shape functions by place `(n, k, d)`, and the Jacobian's determinant.

    `places` `(n, k, d)` are the nodes of each cell.
    """
    own = slopes(local)
    jacobian = np.einsum("nki,nkj->nij", places, own)
    return np.einsum("nkj,nji->nki", own, np.linalg.inv(jacobian)), np.linalg.det(jacobian)


@dataclass(frozen=True)
class Found:
    """Where points are in a mesh."""

    cell: Array
    """Number of the cell of each, `(n,)`; -1 of those outside."""
    local: Array
    """`(n, d)`."""

    @property
    def is_inside(self) -> Array:
        """`(n,)`."""
        return self.cell >= 0


@dataclass(frozen=True)
class Cells:
    """A mesh in which points are looked for, by a tree of boxes around its cells."""

    field: Field
    case: dict[str, Any] | None = None
    """That of a run, whose domain may continue periodically."""

    @cached_property
    def places(self) -> Array:
        """Nodes of each cell, `(m, k, d)`."""
        return self.field.nodes[self.field.cells]

    @cached_property
    def _boxes(self) -> tuple[Array, Array]:
        d = self.places.shape[2]
        ends = ENDS[d]
        vertices, middles = self.places[:, : d + 1], self.places[:, d + 1 :]
        # The middle points of Bezier: a curved cell stays within the hull of its control points.
        control = 2.0 * middles - 0.5 * (vertices[:, ends[:, 0]] + vertices[:, ends[:, 1]])
        every = np.concatenate([vertices, control], axis=1)
        low, high = every.min(axis=1), every.max(axis=1)
        slack = 10 * OUTSIDE * (high - low).max(axis=1, keepdims=True)
        return low - slack, high + slack

    @cached_property
    def _is_straight(self) -> Array:
        d = self.places.shape[2]
        ends = ENDS[d]
        middles = 0.5 * (self.places[:, ends[:, 0]] + self.places[:, ends[:, 1]])
        away = np.abs(self.places[:, d + 1 :] - middles).max(axis=(1, 2))
        return away < STRAIGHT * np.ptp(self.places, axis=1).max(axis=1)

    @cached_property
    def _order(self) -> Array:
        """Cells in the order of a tree of halves, `(2**n,)`, with -1 where there is none.

        Each half of a box is that of the cells' middles along its longest side.
        """
        d = self.places.shape[2]
        middles = np.vstack([self.places[:, : d + 1].mean(axis=1), np.full(d, np.inf)])
        n = 1 << max(0, int(np.ceil(np.log2(len(self.places)))))
        order = np.full(n, -1)
        order[: len(self.places)] = np.arange(len(self.places))
        parts = 1
        while parts < n:
            own = middles[order.reshape(parts, -1)]
            is_one = np.isfinite(own)
            high = np.where(is_one, own, -np.inf).max(axis=1)
            axis = (high - own.min(axis=1, initial=np.inf)).argmax(axis=1)
            key = np.take_along_axis(own, axis[:, None, None], axis=2)[..., 0]
            rank = np.argsort(key, axis=1, kind="stable")
            order = np.take_along_axis(order.reshape(parts, -1), rank, axis=1).ravel()
            parts *= 2
        return order

    @cached_property
    def _tree(self) -> list[Array]:
        """Boxes of each level, the whole mesh first, the cells last: highest, less lowest corner.

        A point is in one where it and its opposite are not above these, `(n, 2 d)`.
        """
        low, high = self._boxes
        every = np.vstack([np.hstack([high, -low]), np.full(2 * low.shape[1], -np.inf)])
        levels = [every[self._order]]
        while len(levels[0]) > 1:
            levels.insert(0, levels[0].reshape(len(levels[0]) // 2, 2, -1).max(axis=1))
        return levels

    def find(self, points: Array, before: Array | None = None) -> Found:
        """Cells that hold points `(n, d)`, with images of a periodic domain.

        Points are looked for where they were `before`, numbers `(n,)` of cells, first.
        """
        cell, local = np.full(len(points), -1), np.zeros(points.shape)
        if before is not None and len(before):
            known = np.flatnonzero((before >= 0) & (before < len(self.places)))
            own, cells, at = self._near(points[known], np.arange(len(known)), before[known])
            at = self._refined(points[known][own], cells, at)
            is_in = _corners(at).min(axis=1) >= -OUTSIDE
            cell[known[own[is_in]]], local[known[own[is_in]]] = cells[is_in], at[is_in]
        for shift in self._shifts(points):
            left = np.flatnonzero(cell < 0)
            for start in range(0, len(left), CHUNK):
                own = left[start : start + CHUNK]
                cell[own], local[own] = self._found(points[own] - shift)
        return Found(cell, local)

    def _shifts(self, points: Array) -> Array:
        d = points.shape[1]
        if self.case is None or len(points) == 0:
            return np.zeros((1, d))
        nodes = self.field.nodes
        ends = (nodes.min(axis=0), nodes.max(axis=0), points.min(axis=0), points.max(axis=0))
        low, high, first, last = (np.append(end, np.zeros(3 - d)) for end in ends)
        return images(self.case, low, high, (first, last))[:, :d]

    def _found(self, points: Array) -> tuple[Array, Array]:
        own, cells, local = self._near(points, *self._candidates(points))
        local = self._refined(points[own], cells, local)
        depth = _corners(local).min(axis=1)
        # Of the candidates of each point the one it is deepest in
        order = np.lexsort((-depth, own))
        own, cells, local, depth = (one[order] for one in (own, cells, local, depth))
        best = np.append(True, own[1:] != own[:-1]) if len(own) else np.zeros(0, dtype=bool)
        best &= depth >= -OUTSIDE
        cell, at = np.full(len(points), -1), np.zeros(points.shape)
        cell[own[best]], at[own[best]] = cells[best], local[best]
        return cell, at

    def _candidates(self, points: Array) -> tuple[Array, Array]:
        """Numbers of points, and of a cell whose box each is in."""
        both = np.hstack([points, -points])
        own, node = np.arange(len(points)), np.zeros(len(points), dtype=int)
        for depth, box in enumerate(self._tree):
            if depth:
                own, node = np.repeat(own, 2), np.column_stack([2 * node, 2 * node + 1]).ravel()
            is_in = (both[own] <= box[node]).all(axis=1)
            own, node = own[is_in], node[is_in]
        return own, self._order[node]

    @cached_property
    def _affine(self) -> tuple[Array, Array]:
        """First vertex of each cell, and the matrix from places to local coordinates."""
        d = self.places.shape[2]
        edges = (self.places[:, 1 : d + 1] - self.places[:, :1]).transpose(0, 2, 1)
        return np.ascontiguousarray(self.places[:, 0]), np.linalg.inv(edges)

    def _near(self, points: Array, own: Array, cells: Array) -> tuple[Array, Array, Array]:
        """The candidates that may hold their points, and local coordinates in straight cells."""
        origin, inverse = self._affine
        away = points[own] - origin[cells]
        local = np.einsum("nij,nj->ni", inverse[cells], away)
        depth = np.minimum(local.min(axis=1), 1.0 - local.sum(axis=1))
        kept = depth >= np.where(self._is_straight[cells], -OUTSIDE, -BULGE)
        return own[kept], cells[kept], local[kept]

    def _refined(self, points: Array, cells: Array, local: Array) -> Array:
        """Local coordinates in curved cells by Newton's method."""
        curved = np.flatnonzero(~self._is_straight[cells])
        for _ in range(ITERATIONS):
            if len(curved) == 0:
                break
            at, own = local[curved], self.places[cells[curved]]
            miss = points[curved] - np.einsum("nk,nki->ni", weights(at), own)
            jacobian = np.einsum("nki,nkj->nij", own, slopes(at))
            jacobian[np.linalg.det(jacobian) == 0.0] = np.eye(points.shape[1])
            step = np.linalg.solve(jacobian, miss[..., None])[..., 0]
            local[curved] = np.clip(at + step, -FARTHEST, FARTHEST)
            curved = curved[np.abs(step).max(axis=1) > 1e-13]
        return local

    def at(self, found: Found, values: Array) -> Array:
        """Nodal values `(n_nodes, ...)` at points; not a number outside."""
        own = values[self.field.cells[found.cell]]
        result = np.einsum("nk,nk...->n...", weights(found.local), own)
        result[~found.is_inside] = np.nan
        return result

    def gradient(self, found: Found, values: Array) -> Array:
        """Derivatives `(n, ..., d)` of nodal values at points; not a number outside."""
        by, _ = slopes_in_space(self.places[found.cell], found.local)
        own = values[self.field.cells[found.cell]]
        result = np.einsum("nk...,nki->n...i", own, by)
        result[~found.is_inside] = np.nan
        return result
