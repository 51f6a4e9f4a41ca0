"""Quadratic tetrahedra: straight pieces of them, as fine as wanted, and the box each lies in."""

from __future__ import annotations

import numpy as np

from alewife_post.read import Field

Array = np.ndarray

STRAIGHT = 10
"""VTK's number of a cell with straight sides."""
ENDS = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
"""Vertices at the ends of each edge, in the order of the nodes in their middles."""
PIECES = np.array(
    [
        [0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3],
        [4, 5, 6, 8], [4, 6, 7, 8], [6, 9, 7, 8], [5, 9, 6, 8],
    ]
)  # fmt: skip
"""Nodes of the pieces of a quadratic tetrahedron: its corners, and what is left about edge 6-8."""


def shape_functions(points: Array) -> Array:
    """Ten shape functions at reference points, `(n_points, 3)` to `(n_points, 10)`."""
    corners = np.column_stack([1.0 - points.sum(axis=1), points])
    middles = 4.0 * corners[:, ENDS[:, 0]] * corners[:, ENDS[:, 1]]
    return np.hstack([corners * (2.0 * corners - 1.0), middles])


def subdivide(halvings: int) -> tuple[Array, Array]:
    """The reference tetrahedron in `8**halvings` pieces.

    Returns `(pieces, weights)`: pieces `(n, 4)` index k points; `weights` `(k, 10)` give those.
    """
    own = np.vstack([np.zeros(3), np.eye(3)])[None]
    for _ in range(halvings):
        middles = 0.5 * (own[:, ENDS[:, 0]] + own[:, ENDS[:, 1]])
        own = np.concatenate([own, middles], axis=1)[:, PIECES].reshape(-1, 4, 3)
    points, index = np.unique(own.reshape(-1, 3), axis=0, return_inverse=True)
    return index.reshape(-1, 4), shape_functions(points)


def bounds(values: Array, cells: Array) -> tuple[Array, Array]:
    """Values `(n_cells, ...)` that quadratic ones of nodes `(n_nodes, ...)` never go beyond."""
    own = values[cells]
    # The middle points of Bezier: a quadratic stays within the hull of its control points.
    control = 2.0 * own[:, 4:] - 0.5 * (own[:, ENDS[:, 0]] + own[:, ENDS[:, 1]])
    every = np.concatenate([own[:, :4], control], axis=1)
    return every.min(axis=1), every.max(axis=1)


def pieces(field: Field, near: Array, values: Array, halvings: int) -> tuple[Array, Array, Array]:
    """Cells that are `near` as straight pieces: points `(n, 3)`, their values, nodes `(m, 4)`."""
    pattern, weights = subdivide(halvings)
    cells = field.cells[near]
    first = np.arange(len(cells))[:, None, None] * len(weights)
    points = np.einsum("pi,cid->cpd", weights, field.nodes[cells]).reshape(-1, 3)
    fine = np.einsum("pi,ci->cp", weights, values[cells]).ravel()
    return points, fine, (first + pattern).reshape(-1, 4)
