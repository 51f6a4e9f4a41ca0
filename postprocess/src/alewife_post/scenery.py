"""A frame as parts in space: fluid, bodies, what joins them, sides, streamlines, headings."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post import camera, space, streams, style, surfaces
from alewife_post.cells import Cells
from alewife_post.cuts import samples, whole_slice
from alewife_post.domains import domain_box, periods
from alewife_post.elements import edge_curves, edges, mirrored, quarters, shares
from alewife_post.fields import nodal_values, settled
from alewife_post.read import Field, Run, read_field
from alewife_post.recovered import smooth_pressure
from alewife_post.request import Moment, Request
from alewife_post.snapshot import default_view, whole_view
from alewife_post.walls import walls

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

QUANTITIES = ("speed", "pressure", "vorticity")
"""Of all runs; those with scalars have these as well."""
FLUID, BODIES, LINES = "fluid", "bodies", "streamlines"
"""Parts that are coloured by a quantity."""
HEAD = 0.03
"""Length of an arrow head on a streamline, likewise."""
NEAR_SIDES = 1.3
"""A side that is not further from what is in view than that part of it is in view, too."""
AROUND = 0.45
"""Space shown around bodies over what they take."""
TUBE = 0.003
"""Radius of a streamline over the longest side of what is in view."""


MOST_TRIANGLES = 120_000
"""Of surfaces in a scene: more are not seen, and slow to turn."""


@dataclass(frozen=True)
class Part:
    """Triangles or lines that are shown together."""

    name: str
    points: Array
    """`(n, 3)`."""
    cells: Array
    """`(m, 3)` of triangles, `(m, 2)` of lines."""
    colour: str
    opacity: float = 1.0
    values: dict[str, Array] = field(default_factory=dict)
    """Nodal values `(n,)` of quantities it can be coloured by."""


@dataclass(frozen=True)
class Scale:
    """Colours of a quantity on one part."""

    colour_map: str
    limits: style.Limits
    ends: tuple[float, float]
    """Least and largest value that is there."""
    tail: float | None = None
    """Per cent of the area beyond each limit, if it is not the usual one."""
    is_asked: bool = False
    """Whether the limits were asked for, and do not follow the values."""


@dataclass(frozen=True)
class Scenery:
    """All parts of a frame."""

    time: float
    parts: list[Part]
    scales: dict[tuple[str, str], Scale]
    """Of each part and quantity."""
    box: Array
    """Corners `(2, 3)` of what is in view."""
    towards: Array
    """From what is seen to the camera, `(3,)`."""
    up: Array
    text: str
    """What the fluid is shown on, such as `z = 0`."""


def quantities_of(run: Run) -> list[str]:
    """Quantities that parts of a frame can be coloured by."""
    return [*QUANTITIES, *run.scalars]


def scenery(run: Run, time: float | None = None) -> Scenery:
    """The frame nearest to a time, or the last one."""
    frame = run.frame(time)
    return _in_space(run, frame.time) if run.is_spatial else _in_the_plane(run, frame.time)


# ---- In the plane --------------------------------------------------------------------------------


def _in_the_plane(run: Run, time: float) -> Scenery:
    flow = settled(run, run.field(time))
    whole = whole_view(run, flow)
    if run.is_axisymmetric:
        flow = mirrored(flow)
    view = default_view(run, whole, np.array([time]))
    values = {name: nodal_values(flow, name) for name in quantities_of(run)}
    scales = {}
    for name, own in values.items():
        at, share = shares(flow, own, view)
        ends = (float(own.min()), float(own.max()))
        scales[FLUID, name] = Scale(*style.colours(name, at, share), ends)
    parts = [Part(FLUID, _raised(flow.nodes), quarters(flow.cells), style.FLUID, 1.0, values)]
    every, is_boundary = edges(flow.cells)
    rims = edge_curves(flow.nodes, every[is_boundary], 9)
    parts.append(_lines("outlines", [_raised(rim) for rim in rims], style.BOUNDARY))
    box = np.array([[view[0], view[2], 0.0], [view[1], view[3], 0.0]])
    up = np.array([0.0, 1.0, 0.0])
    return Scenery(time, parts, scales, box, np.array([0.0, 0.0, 1.0]), up, "")


def _raised(points: Array) -> Array:
    return np.column_stack([points, np.zeros(len(points))])


def _lines(name: str, lines: list[Array], colour: str) -> Part:
    """Polylines as one part."""
    starts = np.cumsum([0, *(len(line) for line in lines)])
    pairs = [
        np.column_stack([np.arange(len(line) - 1), np.arange(1, len(line))]) + start
        for line, start in zip(lines, starts, strict=False)
    ]
    return Part(name, np.concatenate(lines), np.concatenate(pairs), colour)


# ---- In space ------------------------------------------------------------------------------------


def _in_space(run: Run, time: float) -> Scenery:
    frame = run.frame(time)
    moment = Moment(frame.time, frame.path)
    flow = settled(run, read_field(frame.path))
    request = Request(quantity="speed", trails=False)
    still = np.zeros((1, 3))
    seen = _with_sides(run, flow, camera.seen(run, [moment], request, still, AROUND))
    cut = camera.cut(run, [moment], request, seen, still)
    quantities = quantities_of(run)
    parts, scales = [], {}
    for name, meshes in (
        (FLUID, [whole_slice(run.case, flow, cut, quantity) for quantity in quantities]),
        (BODIES, _bodies(run, smooth_pressure(flow))),
    ):
        if not meshes or not meshes[0].n_cells:
            continue
        values = {
            quantity: np.asarray(mesh.point_data["values"], dtype=float)
            for quantity, mesh in zip(quantities, meshes, strict=True)
        }
        for quantity, mesh in zip(quantities, meshes, strict=True):
            own = values[quantity]
            ends = (float(own.min()), float(own.max()))
            tail = style.ON_BODIES if name == BODIES else style.IN_SCENES
            look = style.colours(quantity, *samples(mesh), tail)
            scales[name, quantity] = Scale(*look, ends, tail)
        colour = style.BODY if name == BODIES else style.FLUID
        parts.append(_triangles(name, meshes[0], colour, values=values))
    extent = float(np.ptp(seen.box, axis=0).max())
    parts += [
        _triangles("headings" if colour == style.ARROW else "joints", mesh, colour)
        for mesh, colour in space.motion(run, frame.time, extent)
    ]
    parts += _sides(run, moment, seen)
    if not periods(run.case).any():
        parts += _streamlines(flow, seen.box, extent)
        if parts[-1].name == LINES:
            # They are of the colours of the fluid about them
            scales[LINES, "speed"] = scales.get((FLUID, "speed")) or _plain(parts[-1])
    towards, up = camera.direction(run, request, cut.plane)
    return Scenery(frame.time, parts, scales, seen.box, towards, up, cut.plane.text)


def _with_sides(run: Run, flow: Field, seen: camera.Seen) -> camera.Seen:
    """What is in view, as far as sides that are near: a tube around its sphere, a wall below it."""
    # A ball around all is seen from inside: it is in view only where the whole domain is
    if seen.is_whole or "sphere" in run.case["domain"]:
        return seen
    low, high = domain_box(run.case)
    if not np.isfinite(low).all():
        low, high = flow.nodes.min(axis=0), flow.nodes.max(axis=0)
    reach = NEAR_SIDES * np.ptp(seen.box, axis=0)
    box = np.array([
        np.where(seen.box[0] - low <= reach, low, seen.box[0]),
        np.where(high - seen.box[1] <= reach, high, seen.box[1]),
    ])  # fmt: skip
    if np.array_equal(box, seen.box):
        return seen
    margin = float(np.ptp(box, axis=0).max())
    return replace(seen, box=box, margin=margin)


def _plain(part: Part) -> Scale:
    own = part.values["speed"]
    ends = (float(own.min()), float(own.max()))
    return Scale(*style.colours("speed", own), ends)


def _bodies(run: Run, flow: Field) -> list[pyvista.PolyData]:
    """Their surfaces, one a quantity; none where there is no body."""
    faces = len(surfaces.boundary_faces(flow))
    # A face is halved along each side: four times as many triangles each time
    halvings = next((n for n in (3, 2, 1) if faces * 4**n <= MOST_TRIANGLES), 1)
    try:
        return [surfaces.bodies_surface(run, flow, one, halvings) for one in quantities_of(run)]
    except ValueError:
        return []


def _sides(run: Run, moment: Moment, seen: camera.Seen) -> list[Part]:
    found = []
    for wall, look in walls(run, [moment], is_whole=seen.is_whole):
        mesh = wall if seen.is_whole else _clipped(wall, seen.box)
        if mesh.n_cells == 0:
            continue
        if "line_width" in look:
            lines = [np.asarray(mesh.points)[ends] for ends in mesh.lines.reshape(-1, 3)[:, 1:]]
            found.append(_lines("sides", lines, look["color"]))
        else:
            found.append(_triangles("sides", mesh, look["color"], look["opacity"]))
    return found


def _clipped(wall: pyvista.PolyData, box: Array) -> pyvista.PolyData:
    """What of a side is in view."""
    for axis in range(3):
        for end, sign in zip(box[:, axis], (-1.0, 1.0), strict=True):
            if wall.n_cells:
                origin = np.where(np.arange(3) == axis, end, 0.0)
                wall = wall.clip(normal=sign * np.eye(3)[axis], origin=origin)
    return wall


def _streamlines(flow: Field, box: Array, extent: float) -> list[Part]:
    import pyvista

    lines = streams.streamlines(flow, box)
    if not lines:
        return []
    mesh = Cells(flow)
    tubes = []
    for line in lines:
        one = pyvista.lines_from_points(line)
        found = mesh.find(line)
        one.point_data["speed"] = np.nan_to_num(mesh.at(found, nodal_values(flow, "speed")))
        tubes.append(one.tube(radius=TUBE * extent, n_sides=6))
        tubes += _heads(mesh, line, HEAD * extent)
    every = pyvista.merge(tubes).triangulate()
    values = {"speed": np.asarray(every.point_data["speed"], dtype=float)}
    return [_triangles(LINES, every, style.STREAMTUBE, values=values)]


def _heads(mesh: Cells, line: Array, length: float) -> list[pyvista.PolyData]:
    """A cone on the middle of a line, the way the fluid goes."""
    import pyvista

    middle = line[len(line) // 2]
    (velocity,) = mesh.at(mesh.find(middle[None]), mesh.field.velocity)
    speed = float(np.linalg.norm(velocity))
    if not speed > 0.0:
        return []
    cone = pyvista.Cone(
        center=middle,
        direction=velocity / speed,
        height=length,
        radius=0.35 * length,
        resolution=12,
    )
    cone.point_data["speed"] = np.full(cone.n_points, speed)
    return [cone.triangulate()]


def _triangles(
    name: str,
    mesh: pyvista.PolyData,
    colour: str,
    opacity: float = 1.0,
    values: dict[str, Array] | None = None,
) -> Part:
    surface: Any = mesh if mesh.is_all_triangles else mesh.triangulate()
    cells = np.asarray(surface.faces).reshape(-1, 4)[:, 1:]
    return Part(name, np.asarray(surface.points, dtype=float), cells, colour, opacity, values or {})
