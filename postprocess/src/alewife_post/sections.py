"""Values at points in space, and the curves in which planes cut bodies and sides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post import surfaces, tetrahedra
from alewife_post.domains import domain_box, periods
from alewife_post.fields import nodal_values
from alewife_post.periodic import images
from alewife_post.planes import Plane
from alewife_post.read import Field, Run

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray


def pieces(field: Field, near: Array, values: Array) -> pyvista.UnstructuredGrid:
    """Cells that are `near`, as straight pieces with nodal `values`."""
    import pyvista

    cells = field.cells[near][:, tetrahedra.PIECES].reshape(-1, 4)
    grid = pyvista.UnstructuredGrid({tetrahedra.STRAIGHT: cells}, field.nodes)
    grid.point_data["values"] = values
    return grid


def sample(
    field: Field, points: Array, quantity: str, case: dict[str, Any] | None = None
) -> dict[str, Array]:
    """Values and velocity at points `(n, 3)`, masked outside the fluid.

    With its case, a periodic domain continues beyond its mesh.
    """
    import pyvista

    # VTK looks for points in curved cells by iterations that end early: eight straight pieces of
    # each cell, with its nodes, are as good in a picture
    places = field.nodes[field.cells]
    low, high = points.min(axis=0), points.max(axis=0)
    extent = np.linalg.norm(high - low) or np.ptp(field.nodes, axis=0).max()
    values = np.ma.masked_all(len(points))
    velocity = np.ma.masked_all((len(points), 3))
    mesh = (field.nodes.min(axis=0), field.nodes.max(axis=0))
    for shift in images({} if case is None else case, *mesh, (low, high)):
        near = (places.max(axis=1) >= low - shift).all(axis=1)
        near &= (places.min(axis=1) <= high - shift).all(axis=1)
        if not near.any():
            continue
        straight = pieces(field, near, nodal_values(field, quantity))
        straight.point_data["velocity"] = field.velocity
        # Left to itself, VTK takes points for inside that are a part of the whole domain away
        found = pyvista.PolyData(points - shift).sample(straight, tolerance=1e-6 * extent)
        is_inside = np.asarray(found.point_data["vtkValidPointMask"]) == 1
        values[is_inside] = np.asarray(found.point_data["values"])[is_inside]
        velocity[is_inside] = np.asarray(found.point_data["velocity"])[is_inside]
    return {"values": values, "velocity": velocity}


def sections(
    run: Run, field: Field, plane: Plane, region: tuple[Array, Array] | None = None
) -> list[Array]:
    """Curves `(n, 3)` in which a plane cuts the bodies, and their images in a region.

    Of a periodic domain the region is all of the domain if it is absent.
    """
    try:
        surface = surfaces.bodies_surface(run, field, "pressure")
    except ValueError:
        return []
    return _sections(run, surface, plane, region or shown_box(run.case, field))


def side_sections(run: Run, field: Field, plane: Plane, region: tuple[Array, Array]) -> list[Array]:
    """Those in which it cuts the sides of the domain."""
    return _sections(run, surfaces.sides_surface(run, field), plane, region)


def _sections(
    run: Run, surface: pyvista.PolyData, plane: Plane, region: tuple[Array, Array]
) -> list[Array]:
    if surface.n_cells == 0:
        return []
    points = np.asarray(surface.points)
    mesh = (points.min(axis=0), points.max(axis=0))
    return [
        curve + shift
        for shift in images(run.case, *mesh, region)
        for curve in curves(surface.slice(normal=plane.normal, origin=plane.origin - shift))
    ]


def curves(cut) -> list[Array]:  # noqa: ANN001  (VTK)
    """The lines of a cut, each `(n, 3)` from end to end."""
    if cut.n_cells == 0:
        return []
    strips = cut.strip(join=True)
    points, lines = np.asarray(strips.points), strips.lines
    found, start = [], 0
    while start < len(lines):
        n = lines[start]
        found.append(points[lines[start + 1 : start + 1 + n]])
        start += n + 1
    return found


def shown_box(case: dict[str, Any], field: Field) -> tuple[Array, Array]:
    """Corners of what a periodic domain shows of itself, and of any other domain's mesh."""
    if periods(case).any():
        return domain_box(case)
    return field.nodes.min(axis=0), field.nodes.max(axis=0)
