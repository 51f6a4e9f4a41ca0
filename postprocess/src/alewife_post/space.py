"""Pictures of runs in space: a slice with streamlines, and bodies with what acts on them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from alewife_post import bodies, drawing, scene, style, surfaces
from alewife_post.figure import body_velocity, colour_bar
from alewife_post.periodic import domain_box, images, periods
from alewife_post.planes import Plane, parsed, through_bodies
from alewife_post.read import Field, Run

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray
View = tuple[float, float, float, float]
Camera = tuple[float, float]

POINTS = 400
"""Points on the longer side of a slice."""
TETRAHEDRON = 10
"""VTK's number of a cell with straight sides."""
PIECES = np.array(
    [
        [0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3],
        [4, 5, 6, 8], [4, 6, 7, 8], [6, 9, 7, 8], [5, 9, 6, 8],
    ]
)  # fmt: skip
"""Nodes of the pieces of a quadratic tetrahedron: its corners, and what is left about edge 6-8."""
IMAGE_SIZE = (1600, 1200)
NEAR = 1.0
"""Space shown around bodies over the diameter of the largest one."""


def slice_picture(
    run: Run,
    quantity: str = "speed",
    *,
    time: float | None = None,
    plane: str | None = None,
    view: View | None = None,
    frame: str | None = None,
    lines: str = "streamlines",
) -> Figure:
    """A quantity on a plane such as `z=0.5`, with the streamlines of the velocity in the plane.

    Without `plane` it goes through the bodies: across an axis if that is possible, z before the
    others. `view` is in the two coordinates of the plane; without it, what is around the bodies.
    `frame` names a body whose velocity is subtracted.
    """
    style.use()
    field = run.field(time)
    if frame is not None:
        moved = field.velocity - body_velocity(run, frame, field.time)
        field = replace(field, velocity=moved)
    cut = _plane(run, plane, field)
    axis = int(np.argmax(np.abs(cut.normal)))
    low, high = _box(run.case, field)
    if plane is not None and not low[axis] < cut.origin[axis] < high[axis]:
        reach = f"{low[axis]:.6g} to {high[axis]:.6g}"
        raise ValueError(f"{cut.text} is outside the domain: {reach}")
    view = view or _surroundings(run, field, cut)
    x, y = _grid_lines(view)
    at = cut.points(np.stack(np.meshgrid(x, y), axis=-1))
    found = sample(field, at.reshape(-1, 3), quantity, run.case)
    shape = (len(y), len(x))
    values = found["values"].reshape(shape)
    if quantity != "pressure":
        # A magnitude is not negative, up to rounding at the edges of cells
        values = np.ma.maximum(values, 0.0)
    if values.count() == 0:
        raise ValueError(f"there is no fluid in the view on {cut.text}")
    mask = np.ma.getmaskarray(values)[..., None]
    velocity = np.ma.masked_array(
        found["velocity"].data.reshape(*shape, 3) @ cut.across.T, np.repeat(mask, 2, axis=-1)
    )

    width = min(style.LARGEST[0], style.LARGEST[1] * (view[1] - view[0]) / (view[3] - view[2]))
    size = (width + 1.2, width * (view[3] - view[2]) / (view[1] - view[0]) + 0.9)
    figure = Figure(figsize=size, layout="compressed")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    colour_map, limits = style.colours(quantity, values.compressed())
    axes.imshow(
        values, extent=view, origin="lower", cmap=colour_map, vmin=limits[0], vmax=limits[1]
    )
    if lines == "streamlines" and np.abs(velocity).max() > 0:
        colour = style.STREAMLINE if quantity == "speed" else style.STREAMLINE_ON_LIGHT
        axes.streamplot(
            x, y, velocity[..., 0], velocity[..., 1], color=colour, linewidth=0.6, arrowsize=0.6
        )
    elif lines == "arrows":
        _draw_arrows(axes, x, y, velocity, quantity)
    region = _region(cut, view)
    for section in sections(run, field, cut, region):
        axes.fill(*cut.coordinates(section).T, color=style.BODY, zorder=3)
    _draw_motion(axes, run, cut, field.time, region)
    units = run.case.get("units", "")
    axes.set_xlim(view[0], view[1])
    axes.set_ylim(view[2], view[3])
    drawing.draw_scale_bar(axes, view, units, cut.coordinates(bodies.landmarks(run, field.time)))
    axes.set_xlabel(style.length_label(cut.names[0], units))
    axes.set_ylabel(style.length_label(cut.names[1], units))
    axes.set_title(style.fitted(f"{_title(run, field)}, {cut.text}", size[0]))
    bar = colour_bar(axes, values.compressed(), colour_map, limits)
    bar.set_label(style.label(quantity, units) + (f" relative to {frame}" if frame else ""))
    return figure


def _title(run: Run, field: Field) -> str:
    units = run.case.get("units", "")
    is_unsteady = "unsteady" in run.case["time"]
    return run.case["title"] + (f", {style.time_text(field.time, units)}" if is_unsteady else "")


def _draw_arrows(axes: Axes, x: Array, y: Array, velocity: Array, quantity: str) -> None:
    step = max(1, max(len(x), len(y)) // 28)
    colour = style.STREAMLINE if quantity == "speed" else style.STREAMLINE_ON_LIGHT
    thinned = velocity[::step, ::step]
    axes.quiver(
        x[::step],
        y[::step],
        thinned[..., 0],
        thinned[..., 1],
        color=colour,
        width=0.0018,
        pivot="mid",
    )


def _region(plane: Plane, view: View) -> tuple[Array, Array]:
    """Lowest and highest corner in space of what a view of a plane shows."""
    x0, x1, y0, y1 = view
    corners = plane.points(np.array([[x0, y0], [x1, y0], [x0, y1], [x1, y1]]))
    return corners.min(axis=0), corners.max(axis=0)


def _draw_motion(
    axes: Axes, run: Run, plane: Plane, time: float, region: tuple[Array, Array]
) -> None:
    """Rods and headings that lie in a plane, or near it over the size of bodies."""
    placed = bodies.poses(run, time)
    size = max([0.0, *(bodies.radius(run, name) for name in placed)])

    def is_near(points: Array) -> bool:
        return bool(np.abs((points - plane.origin) @ plane.normal).max() < 0.5 * size)

    for points in bodies.rods(run, placed, time):
        for shift in _shifts(run, points, region):
            if is_near(points + shift):
                drawing.draw_rod(axes, plane.coordinates(points + shift), zorder=2.5)
    for arrow in bodies.headings(run, placed):
        ends = np.array([arrow.start, arrow.start + arrow.vector])
        for shift in _shifts(run, ends, region):
            if is_near(ends + shift):
                start = plane.coordinates(ends[:1] + shift)[0]
                vector = plane.across @ arrow.vector
                drawing.draw_heading(axes, bodies.Heading(start, vector, arrow.is_inside))


def _shifts(run: Run, points: Array, region: tuple[Array, Array]) -> Array:
    return images(run.case, points.min(axis=0), points.max(axis=0), region)


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
    if not scene.can_render():
        raise ValueError("VTK can have no window here: install libosmesa6")
    style.use()
    field = run.field(time)
    surface = surfaces.bodies_surface(run, field, quantity)
    sized = surface.compute_cell_sizes(length=False, volume=False)
    values = np.asarray(sized.point_data_to_cell_data().cell_data["values"])
    colour_map, limits = style.colours(quantity, values, np.asarray(sized.cell_data["Area"]))
    image, pixel = scene.render_surface(
        (surface, motion(run, field.time)), IMAGE_SIZE, camera, colour_map, limits
    )
    figure = Figure(figsize=(7.2, 5.0), layout="compressed")
    axes = figure.add_subplot()
    extent = (0.0, pixel * image.shape[1], 0.0, pixel * image.shape[0])
    axes.imshow(image, extent=extent)
    axes.set_axis_off()
    drawing.draw_scale_bar(axes, extent, run.case.get("units", ""))
    axes.set_title(style.fitted(_title(run, field), 6.0))
    bar = colour_bar(axes, values, colour_map, limits, is_beside=True)
    bar.set_label(style.label(quantity, run.case.get("units", "")))
    return figure


def motion(run: Run, time: float) -> list[tuple[Any, str]]:
    """What joins bodies and where they swim to, as surfaces with a colour."""
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
    for arrow in bodies.headings(run, placed):
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


def _inside(run: Run, points: Array) -> list[Array]:
    """Points `(n, 3)` where a periodic domain shows them, of any other domain where they are."""
    return [points + shift for shift in _shifts(run, points, domain_box(run.case))]


def pieces(field: Field, near: Array, values: Array) -> pyvista.UnstructuredGrid:
    """Cells that are `near`, as straight pieces with nodal `values`."""
    import pyvista

    tetrahedra = field.cells[near][:, PIECES].reshape(-1, 4)
    grid = pyvista.UnstructuredGrid({TETRAHEDRON: tetrahedra}, field.nodes)
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
    points = np.asarray(surface.points)
    mesh = (points.min(axis=0), points.max(axis=0))
    region = region or _box(run.case, field)
    return [
        curve + shift
        for shift in images(run.case, *mesh, region)
        for curve in _curves(surface.slice(normal=plane.normal, origin=plane.origin - shift))
    ]


def _curves(cut) -> list[Array]:  # noqa: ANN001  (VTK)
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


def _box(case: dict[str, Any], field: Field) -> tuple[Array, Array]:
    """Corners of what a periodic domain shows of itself, and of any other domain's mesh."""
    if periods(case).any():
        return domain_box(case)
    return field.nodes.min(axis=0), field.nodes.max(axis=0)


def _plane(run: Run, plane: str | None, field: Field) -> Plane:
    if plane is not None:
        return parsed(plane)
    middle = 0.5 * (field.nodes.min(axis=0) + field.nodes.max(axis=0))
    return through_bodies(run, np.array([field.time]), middle)


def _surroundings(run: Run, field: Field, plane: Plane) -> View:
    """The part of the domain around the bodies, in the coordinates of a slice."""
    places = plane.coordinates(field.nodes)
    if periods(run.case).any():
        ends = np.array(domain_box(run.case))
        box = [[ends[i, 0], ends[j, 1], ends[k, 2]] for i, j, k in np.ndindex(2, 2, 2)]
        places = plane.coordinates(np.array(box))
        (x0, y0), (x1, y1) = places.min(axis=0), places.max(axis=0)
        return (x0, x1, y0, y1)
    low, high = places.min(axis=0), places.max(axis=0)
    faces = surfaces.boundary_faces(field)
    is_side = surfaces.on_sides(run, field, faces)
    if is_side is not None:
        faces = faces[~is_side]
    on_bodies = places[np.unique(faces[:, :3])]
    if len(on_bodies):
        own_low, own_high = on_bodies.min(axis=0), on_bodies.max(axis=0)
        largest = max([0.0, *(2 * bodies.radius(run, name) for name in run.bodies)])
        reach = NEAR * min(largest, np.ptp(on_bodies, axis=0).max())
        reach = max(reach, 0.5 * np.ptp(on_bodies, axis=0).max())
        low, high = np.maximum(low, own_low - reach), np.minimum(high, own_high + reach)
    return (low[0], high[0], low[1], high[1])


def _grid_lines(view: View) -> tuple[Array, Array]:
    """Coordinates of a regular grid over a view."""
    width, height = view[1] - view[0], view[3] - view[2]
    n = [max(2, round(POINTS * side / max(width, height))) for side in (width, height)]
    return np.linspace(view[0], view[1], n[0]), np.linspace(view[2], view[3], n[1])
