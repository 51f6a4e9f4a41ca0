"""Slices of runs in space: a quantity on a plane, with streamlines of the velocity in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from alewife_post import (
    bodies,
    checked,
    drawing,
    scene,
    sections,
    style,
    surfaces,
    tracing,
    traction,
)
from alewife_post.cuts import Cut, samples, whole_slice, within
from alewife_post.derived import with_quantity
from alewife_post.domains import corners_of, domain_box, periods
from alewife_post.drawing import colour_bar
from alewife_post.fields import flow_at
from alewife_post.periodic import shifts
from alewife_post.planes import Plane, parsed, through_bodies
from alewife_post.read import Field, Run, check_run
from alewife_post.snapshot import ARROWS, LINES, Painter, chosen_painter, title

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray
View = tuple[float, float, float, float]
Region = tuple[Array, Array]

QUANTITIES = ("speed", "pressure", "vorticity", "shear-rate", "q")
IMAGE_WIDTH = 1600
"""Pixels of a slice from left to right."""
POINTS = 300
"""Points on the longer side of a slice at which lines know the velocity."""
BESIDE = 0.01
"""Space beyond curved sides over the size of the domain."""
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
    painter: Painter = "auto",
    scale: style.Scale = style.FREE,
) -> Figure:
    """A quantity on a plane such as `z=0.5`, with the streamlines of the velocity in the plane.

    Without `plane` it goes through the bodies: across an axis if that is possible, z before the
    others. `view` is in the two coordinates of the plane; without it, what is around the bodies.
    `frame` names a body whose velocity is subtracted.
    """
    check_run(run, is_spatial=True, instead="figure.picture")
    if quantity in traction.QUANTITIES:
        raise ValueError(
            f"{quantity} is on surfaces, not on a slice: --surface draws it on bodies or sides, "
            "and alewife-post surface along the curve of a slice; on slices there are "
            f"{', '.join(QUANTITIES)}"
        )
    checked.choice("quantity", quantity, [*QUANTITIES, *run.scalars])
    checked.choice("lines", lines, LINES)
    view = None if view is None else checked.view(view)
    painter = chosen_painter(painter)
    style.use()
    field = with_quantity(run, flow_at(run, time, frame), quantity)
    plane_of = within(_plane(run, plane, field), field)
    view = view or _surroundings(run, field, plane_of)
    region = _region(plane_of, view)
    cut = Cut(plane_of, np.array(view[::2]), np.array(view[1::2]))
    part = whole_slice(run.case, field, cut, quantity, region)
    if part.n_cells == 0:
        raise ValueError(f"there is no fluid in the view on {plane_of.text}")
    values, share = samples(part)
    colour_map, limits = scale.colours(quantity, values, share)

    width = min(style.LARGEST[0], style.LARGEST[1] * (view[1] - view[0]) / (view[3] - view[2]))
    size = (width + 1.2, width * (view[3] - view[2]) / (view[1] - view[0]) + 0.9)
    figure = Figure(figsize=size, layout="compressed")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    _paint(axes, part, cut, (colour_map, limits, scale.contours), painter)
    _draw_lines(axes, run, field, cut, (quantity, lines, colour_map))
    for section in sections.sections(run, field, plane_of, region):
        axes.fill(*plane_of.coordinates(section).T, color=style.BODY, zorder=3.5)
    sides = [
        plane_of.coordinates(side) for side in sections.side_sections(run, field, plane_of, region)
    ]
    axes.add_collection(LineCollection(sides, colors=style.BOUNDARY, linewidths=0.7, zorder=4))
    _draw_motion(axes, run, plane_of, field.time, region)
    units = run.units
    axes.set_xlim(view[0], view[1])
    axes.set_ylim(view[2], view[3])
    places = plane_of.coordinates(bodies.landmarks(run, field.time))
    drawing.draw_scale_bar(axes, view, units, places)
    axes.set_xlabel(style.length_label(plane_of.names[0], units))
    axes.set_ylabel(style.length_label(plane_of.names[1], units))
    axes.set_title(style.fitted(f"{title(run, field.time)}, {plane_of.text}", size[0]))
    bar = colour_bar(axes, values, colour_map, limits, contours=scale.contours)
    bar.set_label(style.label(quantity, units) + (f" relative to {frame}" if frame else ""))
    return figure


def _paint(
    axes: Axes,
    part: pyvista.PolyData,
    cut: Cut,
    colours: tuple[str, style.Limits, int],
    painter: Painter,
) -> None:
    """The triangles of a slice, seen against its normal."""
    flat = cut.plane.coordinates(np.asarray(part.points, dtype=float))
    colour_map, limits, contours = colours
    view = (cut.low[0], cut.high[0], cut.low[1], cut.high[1])
    if painter == "vtk" and not contours:
        seen = part.copy()
        seen.points = np.column_stack([flat, np.zeros(len(flat))])
        look = {"scalars": "values", "cmap": colour_map, "clim": limits}
        image = scene.render_flat([(seen, look)], view, (IMAGE_WIDTH, True))
        axes.imshow(image, extent=view, zorder=1, interpolation="antialiased", aspect="equal")
        return
    triangles = Triangulation(*flat.T, part.regular_faces)
    values = np.asarray(part.point_data["values"])
    if contours:
        drawing.fill(axes, triangles, values, (colour_map, limits), contours)
    else:
        drawing.shade(axes, triangles, values, colour_map, limits)


def _draw_lines(axes: Axes, run: Run, field: Field, cut: Cut, what: tuple[str, str, str]) -> None:
    """Streamlines or arrows of the velocity in a plane, over a quantity."""
    quantity, lines, colour_map = what
    if lines == "none":
        return
    colour = style.line_colour(quantity, colour_map)
    view = (cut.low[0], cut.high[0], cut.low[1], cut.high[1])
    x, y = _grid_lines(view)
    at = cut.plane.points(np.stack(np.meshgrid(x, y), axis=-1))
    found = sections.sample(field, at.reshape(-1, 3), "speed", run.case)["velocity"]
    flat = np.ma.masked_array(found.data @ cut.plane.across.T, found.mask[:, :2])
    velocity = flat.reshape(len(y), len(x), 2)
    if lines == "arrows":
        step = max(1, max(len(x), len(y)) // ARROWS)
        drawing.draw_arrows(axes, x[::step], y[::step], velocity[::step, ::step], colour)
        return
    placed = bodies.poses(run, field.time)
    centers = np.array([center for center, _ in placed.values()]).reshape(-1, 3)
    middles = [cut.plane.coordinates(centers).mean(axis=0)] if len(centers) else []
    traced = tracing.traced(tracing.Grid.of(x, y, velocity), view, middles)
    drawing.draw_streamlines(axes, traced, view, colour)


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
        for shift in shifts(run.case, points, region):
            if is_near(points + shift):
                drawing.draw_rod(axes, plane.coordinates(points + shift), zorder=2.5)
    extent = float(np.ptp(plane.coordinates(np.array(region)), axis=0).max())
    for known in bodies.headings(run, placed):
        arrow = bodies.fitted(known, extent)
        ends = np.array([arrow.start, arrow.start + arrow.vector])
        for shift in shifts(run.case, ends, region):
            if is_near(ends + shift):
                start = plane.coordinates(ends[:1] + shift)[0]
                vector = plane.across @ arrow.vector
                drawing.draw_heading(axes, bodies.Heading(start, vector, arrow.is_inside))


def _plane(run: Run, text: str | None, field: Field) -> Plane:
    """The plane that is asked for, which is to be in the domain, or one through the bodies."""
    if text is None:
        box = np.array([field.nodes.min(axis=0), field.nodes.max(axis=0)])
        return through_bodies(run, np.array([field.time]), box)
    plane = parsed(text)
    axis = int(np.argmax(np.abs(plane.normal)))
    low, high = sections.shown_box(run.case, field)
    if not low[axis] <= plane.origin[axis] <= high[axis]:
        reach = f"{low[axis]:.6g} to {high[axis]:.6g}"
        raise ValueError(f"{plane.text} is outside the domain: {reach}")
    return plane


def _surroundings(run: Run, field: Field, plane: Plane) -> View:
    """The part of the domain around the bodies, in the coordinates of a slice."""
    places = plane.coordinates(field.nodes)
    if periods(run.case).any():
        places = plane.coordinates(corners_of(np.array(domain_box(run.case))))
        (x0, y0), (x1, y1) = places.min(axis=0), places.max(axis=0)
        return (x0, x1, y0, y1)
    low, high = places.min(axis=0), places.max(axis=0)
    if "box" not in run.case["domain"]:
        # Sides that are not along the edges of the picture have room before these.
        room = BESIDE * np.ptp(places, axis=0).max()
        low, high = low - room, high + room
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
