"""Quadratic triangles: finer triangles, curved edges, mirror image."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alewife_post.read import Field

Array = np.ndarray

EDGES = np.array([[0, 1, 3], [1, 2, 4], [2, 0, 5]])
"""Start, end and middle node of each edge of a cell."""


def shape_functions(points: Array) -> Array:
    """Six shape functions at reference points, `(n_points, 2)` to `(n_points, 6)`."""
    x, y = points.T
    z = 1.0 - x - y
    vertices = [z * (2 * z - 1), x * (2 * x - 1), y * (2 * y - 1)]
    return np.stack([*vertices, 4 * z * x, 4 * x * y, 4 * y * z], axis=1)


def subdivide(cells: Array, level: int) -> tuple[Array, Array]:
    """Split every cell into `level**2` flat triangles.

    Returns `(triangles, weights)`: triangles `(n_cells * level**2, 3)` index points, of which each
    cell has its own k; `weights` `(k, 6)` give them to `refine`.
    """
    steps = [(i, j) for j in range(level + 1) for i in range(level + 1 - j)]
    number = {step: index for index, step in enumerate(steps)}
    upward = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in steps if i + j < level]
    downward = [
        (number[i + 1, j], number[i + 1, j + 1], number[i, j + 1])
        for i, j in steps
        if i + j < level - 1
    ]
    pattern = np.array(upward + downward)
    first = np.arange(len(cells))[:, None, None] * len(steps)
    triangles = (first + pattern).reshape(-1, 3)
    return triangles, shape_functions(np.array(steps) / level)


def shared_points(cells: Array, level: int) -> Array:
    """A number for each point of `subdivide`, `(n_points,)`, that all its cells agree on."""
    steps = np.array([(i, j) for j in range(level + 1) for i in range(level + 1 - j)])
    n_nodes = int(cells.max()) + 1
    # Points inside of cells are those of nobody else.
    own = n_nodes * (level + 1) + np.arange(len(cells) * len(steps)).reshape(-1, len(steps))
    along = np.stack([steps[:, 0], steps[:, 1], level - steps[:, 1]])
    on_edge = np.stack([steps[:, 1] == 0, steps.sum(axis=1) == level, steps[:, 0] == 0])
    for (start, end, middle), place, here in zip(EDGES, along, on_edge, strict=True):
        is_forward = (cells[:, start] < cells[:, end])[:, None]
        # Counted from the end with the smaller number, whichever cell looks
        counted = np.where(is_forward, place[here], level - place[here])
        own[:, here] = cells[:, middle][:, None] * (level + 1) + counted
    for vertex, step in enumerate([(0, 0), (level, 0), (0, level)]):
        own[:, (steps == step).all(axis=1)] = cells[:, vertex][:, None] * (level + 1)
    return own.ravel()


def refine(values: Array, cells: Array, weights: Array) -> Array:
    """Nodal values, `(n_nodes, ...)`, at the points of `subdivide`, `(n_points, ...)`."""
    fine = np.einsum("pi,ci...->cp...", weights, values[cells])
    return fine.reshape(-1, *values.shape[1:])


def edges(cells: Array) -> tuple[Array, Array]:
    """All edges of a mesh once, as start, end, middle node.

    Returns `(edges, is_boundary)`, `(n_edges, 3)` and `(n_edges,)`.
    """
    every = cells[:, EDGES].reshape(-1, 3)
    # The middle node names an edge, from whichever side it is seen.
    _, first, count = np.unique(every[:, 2], return_index=True, return_counts=True)
    return every[first], count == 1


def edge_curves(nodes: Array, edges: Array, n_points: int = 9) -> Array:
    """Points along edges, `(n_edges, n_points, 2)`, on the parabola through their three nodes."""
    s = np.linspace(0.0, 1.0, n_points)
    weights = np.stack([(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)], axis=1)
    return np.einsum("pi,eid->epd", weights, nodes[edges])


def edge_values(values: Array, n_points: int = 9) -> Array:
    """Values `(n_edges, n_points)` along edges of those at start, end and middle."""
    return edge_curves(values.reshape(-1, 1), np.arange(values.size).reshape(-1, 3), n_points)[
        ..., 0
    ]


def quarters(cells: Array) -> Array:
    """Four flat triangles a cell between its own nodes, `(4 * n_cells, 3)`."""
    pattern = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
    return cells[:, pattern].reshape(-1, 3)


def mirrored(field: Field) -> Field:
    """The field with its image below the axis y = 0, as a cut along the axis shows it.

    Nodes on the axis belong to both halves.
    """
    extent = np.ptp(field.nodes, axis=0).max()
    off_axis = field.nodes[:, 1] > 1e-12 * extent
    image_of = np.arange(len(field.nodes))
    image_of[off_axis] = len(field.nodes) + np.arange(off_axis.sum())
    flip = np.array([1.0, -1.0])

    def joined(values: Array, sign: Array | float) -> Array:
        return np.concatenate([values, values[off_axis] * sign])

    return replace(
        field,
        nodes=joined(field.nodes, flip),
        # Seen in a mirror, counter-clockwise is clockwise.
        cells=np.concatenate([field.cells, image_of[field.cells[:, [0, 2, 1, 5, 4, 3]]]]),
        velocity=joined(field.velocity, flip),
        pressure=joined(field.pressure, 1.0),
        vorticity=joined(field.vorticity, -1.0),
        derived=None if field.derived is None else joined(field.derived, 1.0),
        scalars={name: joined(values, 1.0) for name, values in field.scalars.items()},
    )


def inside(field: Field, view: tuple[float, float, float, float]) -> Field:
    """The field without the cells that lie wholly outside a view `(x0, x1, y0, y1)`."""
    corners = field.nodes[field.cells]
    low, high = corners.min(axis=1), corners.max(axis=1)
    x0, x1, y0, y1 = view
    seen = (high >= [x0, y0]).all(axis=1) & (low <= [x1, y1]).all(axis=1)
    return replace(field, cells=field.cells[seen])


def centroid(outline: Array) -> Array:
    """Centre of the area `(2,)` within a closed polygon `(n_points, 2)`."""
    after = np.roll(outline, -1, axis=0)
    crossed = outline[:, 0] * after[:, 1] - after[:, 0] * outline[:, 1]
    return ((outline + after) * crossed[:, None]).sum(axis=0) / (3 * crossed.sum())


def smooth_outline(points: Array, n: int = 16) -> Array:
    """A smooth closed curve through points `(n_points, 2)`, as `(n_points * n, 2)`."""
    before, after, beyond = (np.roll(points, shift, axis=0) for shift in (1, -1, -2))
    s = (np.arange(n) / n)[:, None, None]
    # Cubic of Catmull and Rom: its slope at a point is that of the chord between its neighbours.
    curve = points + 0.5 * s * (
        after
        - before
        + s * (2 * before - 5 * points + 4 * after - beyond)
        + s**2 * (3 * (points - after) + beyond - before)
    )
    return curve.transpose(1, 0, 2).reshape(-1, 2)


def shares(field: Field, values: Array, view: tuple[float, float, float, float]) -> tuple:
    """Values `(n_cells,)` at the middles of cells in a view, and the areas they hold."""
    corners = field.nodes[field.cells[:, :3]]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    middle = corners.mean(axis=1)
    x0, x1, y0, y1 = view
    seen = ((middle >= [x0, y0]) & (middle <= [x1, y1])).all(axis=1)
    if not seen.any():
        seen[:] = True
    # The three middles of edges integrate a quadratic exactly.
    return values[field.cells[:, 3:]][seen].ravel(), np.repeat(area[seen] / 3, 3)
