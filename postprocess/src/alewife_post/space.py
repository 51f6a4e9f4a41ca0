"""Runs in space: pictures of bodies with what acts on them, samples, and where planes cut them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from alewife_post import bodies, checked, drawing, scene, style, surfaces, tetrahedra
from alewife_post.figure import colour_bar
from alewife_post.periodic import domain_box, images, periods
from alewife_post.planes import Plane
from alewife_post.read import Field, Run

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray
Camera = tuple[float, float]

IMAGE_SIZE = (1600, 1200)
BELOW = 0.09
"""Room for the scale of lengths over the longer side of a picture of bodies."""


def surface_picture(
    run: Run,
    quantity: str = "pressure",
    *,
    time: float | None = None,
    camera: Camera = (-50.0, 20.0),
) -> Figure:
    """The bodies, coloured by a quantity on their surfaces.

    `camera` is where it is looked from: degrees about z, from x, and above the horizon.
    """
    checked.run(run, is_spatial=True, instead="figure.picture")
    if not scene.can_render():
        raise ValueError("VTK can have no window here: install libosmesa6")
    style.use()
    field = run.field(time)
    surface = surfaces.bodies_surface(run, field, quantity)
    sized = surface.compute_cell_sizes(length=False, volume=False)
    values = np.asarray(sized.point_data_to_cell_data().cell_data["values"])
    colour_map, limits = style.colours(quantity, values, np.asarray(sized.cell_data["Area"]))
    extent = float(np.ptp(np.asarray(surface.points), axis=0).max())
    image, pixel = scene.render_surface(
        (surface, motion(run, field.time, extent)), IMAGE_SIZE, camera, colour_map, limits
    )
    figure = Figure(figsize=(7.2, 5.0), layout="compressed")
    axes = figure.add_subplot()
    width, height = pixel * image.shape[1], pixel * image.shape[0]
    axes.imshow(image, extent=(0.0, width, 0.0, height))
    axes.set_axis_off()
    # The scale lies below, not on what is shown.
    below = BELOW * max(width, height)
    axes.set_ylim(-below, height)
    drawing.draw_scale_bar(axes, (0.0, width, -below, height), run.case.get("units", ""))
    axes.set_title(style.fitted(title(run, field), 6.0))
    bar = colour_bar(axes, values, colour_map, limits, is_beside=True)
    bar.set_label(style.label(quantity, run.case.get("units", "")))
    return figure


def title(run: Run, field: Field) -> str:
    """The title of a case, with the time of a flow that is not steady."""
    units = run.case.get("units", "")
    is_unsteady = "unsteady" in run.case["time"]
    return run.case["title"] + (f", {style.time_text(field.time, units)}" if is_unsteady else "")


def motion(run: Run, time: float, extent: float) -> list[tuple[Any, str]]:
    """What joins bodies and where they swim to, as surfaces with a colour, in a view so long."""
    import pyvista

    placed = bodies.poses(run, time)
    sizes = [bodies.radius(run, name) for name in placed]
    seen = [bodies.shape(run, name, time) for name in placed]
    # Thin beside the bodies, and no thicker than thin ones.
    thin = [solid.size.min() / 4 for one in seen if one for solid in one.solids]
    found = [
        (
            pyvista.lines_from_points(points).tube(
                radius=min([0.12 * min(sizes), *thin]), n_sides=12
            ),
            style.ROD,
        )
        for rod in bodies.rods(run, placed, time)
        for points in _inside(run, rod)
    ]
    for known in bodies.headings(run, placed):
        arrow = bodies.fitted(known, extent)
        length = float(np.linalg.norm(arrow.vector))
        for (start,) in _inside(run, arrow.start[None]):
            mesh = pyvista.Arrow(
                start=start,
                direction=arrow.vector / length,
                scale=length,
                tip_length=0.4,
                tip_radius=0.18,
                shaft_radius=0.07,
            )
            found.append((mesh, style.ARROW))
    return found


def shifts(run: Run, points: Array, region: tuple[Array, Array]) -> Array:
    """Shifts by which points `(n, 3)` have images in a region."""
    return images(run.case, points.min(axis=0), points.max(axis=0), region)


def _inside(run: Run, points: Array) -> list[Array]:
    """Points `(n, 3)` where a periodic domain shows them, of any other domain where they are."""
    return [points + shift for shift in shifts(run, points, domain_box(run.case))]


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

    With its case, a periodic domain goes on beyond its mesh.
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
        straight = pieces(field, near, surfaces.nodal_values(field, quantity))
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
