"""Surfaces of runs in space: of bodies, of the domain, and the faces they are made of."""

from __future__ import annotations

import numpy as np

from alewife_post.bodies import poses
from alewife_post.domains import distances_to_sides, periods
from alewife_post.fields import nodal_values
from alewife_post.periodic import is_joined
from alewife_post.read import QUADRATIC_TRIANGLE, Field, Run

Array = np.ndarray

FACES = np.array([[0, 1, 2, 4, 5, 6], [0, 1, 3, 4, 8, 7], [0, 2, 3, 6, 9, 7], [1, 2, 3, 5, 9, 8]])
"""Nodes of each face of a tetrahedron: vertices, then those between them."""
OPPOSITE = np.array([3, 2, 1, 0])
"""The vertex that a face has not."""
ON_SIDE = 1e-3
"""Distance from a side over the size of a face below which the face is on it."""
SUBDIVISION = 3


def bodies_surface(  # noqa: ANN201  (loads VTK)
    run: Run, field: Field, quantity: str, subdivision: int = SUBDIVISION
):
    """The surface of the fluid without the sides of the domain, with nodal `values`.

    Sides of curved faces are halved `subdivision` times.
    """
    faces = boundary_faces(field)
    is_side = on_sides(run, field, faces)
    if is_side is not None:
        lengths = periods(run.case)
        if lengths.any():
            # Where the mesh is cut open
            is_side |= is_joined(field.nodes, lengths)[faces].all(axis=1)
        kept = _surface(field, quantity, faces[~is_side], subdivision)
    else:
        whole = _surface(field, quantity, faces, subdivision).connectivity("all")
        cells = whole.faces.reshape(-1, 4)[:, 1:]
        is_outer = _is_on_largest_part(whole)[cells[:, 0]]
        kept = whole.extract_cells(np.flatnonzero(~is_outer))
        kept = kept.extract_surface(algorithm="dataset_surface")
    if kept.n_cells == 0:
        raise ValueError("there is no body in this run: draw a slice")
    return kept


def sides_surface(run: Run, field: Field):  # noqa: ANN201  (loads VTK)
    """The sides of the domain, but for those where a periodic mesh is cut open."""
    faces = boundary_faces(field)
    is_side = on_sides(run, field, faces)
    if is_side is None:
        return outer_surface(field)
    lengths = periods(run.case)
    if lengths.any():
        is_side &= ~is_joined(field.nodes, lengths)[faces].all(axis=1)
    return _surface(field, "speed", faces[is_side])


def _surface(  # noqa: ANN202  (loads VTK)
    field: Field, quantity: str, faces: Array, subdivision: int = SUBDIVISION
):
    """Curved faces `(n, 6)` as flat triangles, with nodal `values`."""
    import pyvista

    if len(faces) == 0:
        return pyvista.PolyData()
    grid = pyvista.UnstructuredGrid({QUADRATIC_TRIANGLE: faces}, field.nodes)
    grid.point_data["values"] = nodal_values(field, quantity)
    return grid.extract_surface(nonlinear_subdivision=subdivision, algorithm="dataset_surface")


def _is_on_largest_part(surface) -> Array:  # noqa: ANN001  (VTK)
    """Whether each point of a surface is on its part of the largest extent, the outer one."""
    part = np.asarray(surface.point_data["RegionId"])
    points = np.asarray(surface.points)
    extents = [np.ptp(points[part == index], axis=0).max() for index in range(part.max() + 1)]
    return part == np.argmax(extents)


def outer_surface(field: Field):  # noqa: ANN201  (loads VTK)
    """The outer part of the surface of the fluid: the sides of its domain."""
    surface = _surface(field, "speed", boundary_faces(field)).connectivity("all")
    cells = surface.faces.reshape(-1, 4)[:, 1:]
    kept = np.flatnonzero(_is_on_largest_part(surface)[cells[:, 0]])
    return surface.extract_cells(kept).extract_surface(algorithm="dataset_surface")


def boundary_faces(field: Field) -> Array:
    """Nodes `(n, 6)` of the faces that only one cell has, counter-clockwise seen from outside."""
    cells, n = field.cells, len(field.nodes)
    ends = np.sort(cells[:, FACES[:, :3]].reshape(-1, 3), axis=1).astype(np.int64)
    keys = (ends[:, 0] * n + ends[:, 1]) * n + ends[:, 2]
    _, first, counts = np.unique(keys, return_index=True, return_counts=True)
    found = first[counts == 1]
    faces = cells[:, FACES].reshape(-1, 6)[found]
    inner = field.nodes[cells[:, OPPOSITE].ravel()[found]]
    a, b, c = (field.nodes[faces[:, k]] for k in range(3))
    is_inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), inner - a) > 0
    faces[is_inwards] = faces[is_inwards][:, [0, 2, 1, 5, 4, 3]]
    return faces


def on_sides(run: Run, field: Field, faces: Array) -> Array | None:
    """Which faces `(n, 6)` lie on a side of the domain; None where its sides are not known.

    One within a thousandth of its own size is: a body at a wall has faces as small as the gap,
    whatever the size of the domain.
    """
    nodes = field.nodes
    frame = run.members.frame
    if frame in run.bodies:
        # The domain travels with a body: its sides are where they were, seen from there
        start, now = (poses(run, time)[frame] for time in (0.0, field.time))
        nodes = (nodes - now[0]) @ now[1] @ start[1].T + start[0]
    distances = distances_to_sides(run.case, nodes)
    if distances.shape[1] == 0:
        return None
    size = np.ptp(field.nodes[faces], axis=1).max(axis=1)
    near = np.abs(distances[faces]) < ON_SIDE * size[:, None, None]
    return near.all(axis=1).any(axis=1)
