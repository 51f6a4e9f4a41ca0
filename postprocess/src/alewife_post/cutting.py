"""Where a line or a plane cuts the cells of a mesh, for integrals over it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alewife_post import elements, tetrahedra
from alewife_post.cells import Cells, reference_nodes, weights

Array = np.ndarray

HALVINGS = 2
"""Of the edges of a cell: its straight pieces are exact for a straight one."""
CUT_EDGES = {
    (2, 1): [[(0, 1), (0, 2)]],
    (2, 2): [[(2, 0), (2, 1)]],
    (3, 1): [[(0, 1), (0, 2), (0, 3)]],
    (3, 3): [[(3, 0), (3, 1), (3, 2)]],
    (3, 2): [[(0, 2), (0, 3), (1, 3)], [(0, 2), (1, 3), (1, 2)]],
}
"""Ends of the edges that are cut, vertices sorted by height: by dimension and vertices below."""
GAUSS = np.array([[0.5 - np.sqrt(0.15), 5 / 18], [0.5, 4 / 9], [0.5 + np.sqrt(0.15), 5 / 18]])
"""Places and weights on a segment, exact up to degree five."""
_A, _B = 0.445948490915965, 0.091576213509771
_P, _Q = 0.223381589678011, 0.109951743655322
TRIANGLE = np.array(
    [
        [_A, _A, 1 - 2 * _A, _P], [_A, 1 - 2 * _A, _A, _P], [1 - 2 * _A, _A, _A, _P],
        [_B, _B, 1 - 2 * _B, _Q], [_B, 1 - 2 * _B, _B, _Q], [1 - 2 * _B, _B, _B, _Q],
    ]
)  # fmt: skip
"""Distances from the sides of a triangle, and weights, exact up to degree four (@dunavant1985)."""


@dataclass(frozen=True)
class Quadrature:
    """Points of a cut with their weights."""

    points: Array
    """`(n, d)`."""
    weight: Array
    """Length or area each stands for, `(n,)`."""
    cell: Array
    """Number of the cell of each, `(n,)`."""
    local: Array
    """Local coordinates in it, `(n, d)`."""

    def at(self, cells: Cells, values: Array) -> Array:
        """Nodal values `(n_nodes, ...)` at the points."""
        return np.einsum(
            "nk,nk...->n...", weights(self.local), values[cells.field.cells[self.cell]]
        )


def cut(cells: Cells, origin: Array, normal: Array) -> Quadrature:
    """Points and weights on all of a mesh that a line or a plane cuts; a face in it counts once."""
    d = len(normal)
    pieces, local = _pieces(d)
    height = (cells.field.nodes - origin) @ normal
    own = height[cells.field.cells]
    slack = np.ptp(own, axis=1)
    near = np.flatnonzero((own.min(axis=1) - slack <= 0) & (own.max(axis=1) + slack >= 0))
    shape = weights(local)
    points = np.einsum("pk,ckd->cpd", shape, cells.places[near])
    heights = (points - origin) @ normal
    found = []
    each = heights[:, pieces]
    below = (each < 0.0).sum(axis=2)
    order = np.argsort(each, axis=2)
    for (dimension, n_below), simplices in CUT_EDGES.items():
        if dimension != d:
            continue
        cell, piece = np.nonzero(below == n_below)
        sorted_ = np.take_along_axis(pieces[piece], order[cell, piece], axis=1)
        for edges in simplices:
            start, end = sorted_[:, [a for a, _ in edges]], sorted_[:, [b for _, b in edges]]
            h0, h1 = (heights[cell[:, None], ends] for ends in (start, end))
            share = (h0 / np.where(h0 == h1, 1.0, h0 - h1))[..., None]
            corners = _between(points[cell[:, None], start], points[cell[:, None], end], share)
            found.append((near[cell], corners, _between(local[start], local[end], share)))
    cell, corners, own_local = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return _quadrature(cell, corners, own_local)


def _between(start: Array, end: Array, share: Array) -> Array:
    return start + share * (end - start)


def _pieces(d: int) -> tuple[Array, Array]:
    """Corners of the straight pieces of a cell, and local coordinates of these."""
    if d == 2:
        cell = np.arange(6)[None]
        pieces, shape = elements.subdivide(cell, 2**HALVINGS)
    else:
        pieces, shape = tetrahedra.subdivide(HALVINGS)
    return pieces, shape @ reference_nodes(d)


def _quadrature(cell: Array, corners: Array, local: Array) -> Quadrature:
    """Gauss points of segments `(n, 2, 2)` or triangles `(n, 3, 3)`."""
    sides = corners[:, 1:] - corners[:, :1]
    if corners.shape[1] == 2:
        size = np.linalg.norm(sides[:, 0], axis=1)
        rule = np.column_stack([1.0 - GAUSS[:, 0], GAUSS])
    else:
        size = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
        rule = TRIANGLE
    share, weight = rule[:, :-1], rule[:, -1]
    d = corners.shape[2]
    return Quadrature(
        np.einsum("qk,nkd->nqd", share, corners).reshape(-1, d),
        (size[:, None] * weight).ravel(),
        np.repeat(cell, len(weight)),
        np.einsum("qk,nkd->nqd", share, local).reshape(-1, d),
    )
