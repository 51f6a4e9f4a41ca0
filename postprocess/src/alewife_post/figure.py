"""The figure of a snapshot, with its axes and colour bar."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from alewife_post import bodies, checked, drawing, skins, style, tracers, traction
from alewife_post.derived import with_quantity
from alewife_post.drawing import colour_bar
from alewife_post.elements import edge_curves, edge_values, mirrored, shares
from alewife_post.fields import flow_at, nodal_values, prepared
from alewife_post.periodic import images, joined
from alewife_post.read import Field, Run, check_run
from alewife_post.snapshot import (
    LINES,
    Lines,
    Look,
    Painter,
    chosen_painter,
    default_view,
    fitted_lines,
    followed_view,
    kept_inside,
    paint,
    paint_bodies,
    title,
    whole_view,
)

Array = np.ndarray
View = tuple[float, float, float, float]
Quantity = Literal[
    "speed", "pressure", "vorticity", "shear-rate", "q", "mesh", "traction", "wall-shear"
]

QUANTITIES = get_args(Quantity)
IMAGE_WIDTH = 2400
MARGIN = 0.01
"""Room around outlines over the longer side of a view."""


@dataclass(frozen=True)
class Shown:
    """What a picture shows of a run."""

    time: float | None = None
    view: View | None = None
    frame: str | None = None
    """A body whose velocity is subtracted."""
    follow: str | None = None
    lines: Lines | None = None
    mirror: bool = True
    painter: Painter = "auto"
    particles: Path | None = None
    """Paths that `alewife-post trace` wrote."""


@dataclass(frozen=True)
class _Part:
    """One run, ready to be drawn."""

    run: Run
    quantity: str
    field: Field
    view: View
    values: Array | None
    share: Array | None
    outline: tuple[Array, Array] | None
    """Curves `(n, k, 2)` of surfaces and values `(n, k)` on them."""
    tracks: tracers.Tracks | None


def picture(
    run: Run,
    quantity: Quantity | str = "speed",
    *,
    time: float | None = None,
    view: View | None = None,
    frame: str | None = None,
    follow: str | None = None,
    lines: Lines | None = None,
    mirror: bool = True,
    painter: Painter = "auto",
    particles: Path | None = None,
    scale: style.Scale = style.FREE,
) -> Figure:
    """A picture of one quantity at the frame nearest to `time`, or at the last one.

    `view` is x0, x1, y0, y1; without it, all of the domain, or the bodies if they are small in it.
    With a body or swimmer to `follow` it is relative to that, or what is around it.
    `frame` names a body whose velocity is subtracted. Speed has streamlines unless `lines` says
    otherwise. An axisymmetric run is shown on both sides of its axis unless `mirror` is false.
    A scalar is a quantity by its name. Traction and wall shear are shown as coloured outlines of
    bodies and sides. `particles` is a directory of paths that are drawn as well. `scale` has limits
    and a map of colours.
    """
    asked = Shown(time, view, frame, follow, lines, mirror, painter, particles)
    return panels([(run, asked)], quantity, scale)


def panels(
    wanted: list[tuple[Run, Shown]], quantity: Quantity | str, scale: style.Scale = style.FREE
) -> Figure:
    """Pictures one below the other, or side by side where they are tall, with one scale for all."""
    style.use()
    parts = [_prepared(run, asked, quantity) for run, asked in wanted]
    colour_map, limits = ("viridis", (0.0, 1.0))
    values = None
    if quantity != "mesh":
        values = np.concatenate([part.values for part in parts])
        share = np.concatenate([part.share / part.share.sum() for part in parts])
        colour_map, limits = scale.colours(quantity, values, share)
    sizes = [_size(part.view) for part in parts]
    is_tall = max(height for _, height in sizes) > max(width for width, _ in sizes)
    grid = (1, len(parts)) if is_tall else (len(parts), 1)
    width, height = (
        float(sum(ends) if n == len(parts) else max(ends))
        for ends, n in zip(zip(*sizes, strict=True), grid[::-1], strict=True)
    )
    figure = Figure(figsize=(width, height), layout="compressed")
    rows = figure.subplots(*grid, squeeze=False).ravel()
    for nth, (axes, part, (_, asked)) in enumerate(zip(rows, parts, wanted, strict=True)):
        _draw(axes, part, asked, (colour_map, limits, scale.contours))
        heading = title(part.run, part.field.time)
        if len(parts) > 1:
            heading = f"({chr(ord('a') + nth)}) {heading}"
        axes.set_title(style.fitted(heading, sizes[nth][0]))
    if values is not None:
        frame = wanted[0][1].frame
        own = rows[0] if len(parts) == 1 else list(rows)
        bands = 0 if quantity in traction.QUANTITIES else scale.contours
        colour_bar(own, values, colour_map, limits, contours=bands).set_label(
            style.label(quantity, parts[0].run.units)
            + ("" if frame is None else f" relative to {frame}")
        )
    return figure


def _prepared(run: Run, asked: Shown, quantity: str) -> _Part:
    check_run(run, is_spatial=False, instead="slices.slice_picture, or space.surface_picture,")
    checked.choice("quantity", quantity, [*QUANTITIES, *run.scalars])
    if asked.lines is not None:
        checked.choice("lines", asked.lines, LINES)
    view = None if asked.view is None else checked.view(asked.view)
    field = with_quantity(run, flow_at(run, asked.time, asked.frame), quantity)
    view = _seen(run, field, view, asked.follow, mirror=asked.mirror)
    tracks = None if asked.particles is None else tracers.read_paths(asked.particles)
    if tracks is not None and run.is_unsteady:
        tracks.check_time(field.time, asked.particles)
    outline, values, share = None, None, None
    if quantity in traction.QUANTITIES:
        outline, values, share = _outline(run, field, view, (quantity, asked.mirror))
    elif quantity != "mesh":
        shown = joined(prepared(run, field, view, mirror=asked.mirror))
        values, share = shares(shown, nodal_values(shown, quantity), view)
    return _Part(run, quantity, field, view, values, share, outline, tracks)


def _outline(
    run: Run, field: Field, view: View, what: tuple[str, bool]
) -> tuple[tuple[Array, Array], Array, Array]:
    """Curves of surfaces with values along them; values in view, and the lengths they hold."""
    quantity, mirror = what
    found = traction.surfaces_of(run, field)
    if not found:
        raise ValueError(f"there is no surface in {run.path} that has a {quantity}")
    curves = np.concatenate([edge_curves(field.nodes, one.facets.nodes) for one in found])
    along = np.concatenate(
        [edge_values(skins.values(field, one, quantity)[one.own]) for one in found]
    )
    if run.is_axisymmetric and mirror:
        curves = np.concatenate([curves, curves * [1.0, -1.0]])
        along = np.concatenate([along, along])
    region = (np.array([view[0], view[2], 0.0]), np.array([view[1], view[3], 0.0]))
    ends = (np.append(end(field.nodes), 0.0) for end in (_lowest, _highest))
    shifts = images(run.case, *ends, region)[:, :2]
    curves = np.concatenate([curves + shift for shift in shifts])
    along = np.concatenate([along for _ in shifts])
    middle = curves[:, curves.shape[1] // 2]
    seen = ((middle >= [view[0], view[2]]) & (middle <= [view[1], view[3]])).all(axis=1)
    if not seen.any():
        seen[:] = True
    length = np.linalg.norm(np.diff(curves, axis=1), axis=2).sum(axis=1)
    n = along.shape[1]
    return (curves, along), along[seen].ravel(), np.repeat(length[seen] / n, n)


def _lowest(nodes: Array) -> Array:
    return nodes.min(axis=0)


def _highest(nodes: Array) -> Array:
    return nodes.max(axis=0)


def _draw(axes: Axes, part: _Part, asked: Shown, colours: tuple[str, style.Limits, int]) -> None:
    run, field, view, quantity = part.run, part.field, part.view, part.quantity
    colour_map, limits, contours = colours
    axes.set_aspect("equal")
    is_mirrored = run.is_axisymmetric and asked.mirror
    flow = prepared(run, field, view, mirror=asked.mirror)
    paint_bodies(axes, run, view, field.time, field=mirrored(field) if is_mirrored else field)
    lines = asked.lines
    if lines is None:
        lines = "streamlines" if quantity == "speed" and part.tracks is None else "none"
    look = Look(
        quantity, colour_map, limits, lines, chosen_painter(asked.painter), IMAGE_WIDTH,
        is_mirrored=is_mirrored, contours=contours,
    )  # fmt: skip
    if part.outline is None:
        paint(axes, flow, view, look, fitted_lines(run, field, view, look))
    else:
        drawing.draw_fluid(axes, joined(flow))
        drawing.draw_outline(axes, *part.outline, colour_map, limits)
    if part.tracks is not None:
        time = field.time if run.is_unsteady else None
        ways, heads = part.tracks.still(run, time)
        colour = style.line_colour(quantity, colour_map)
        drawing.draw_particles(axes, ways, heads, colour, is_mirrored=is_mirrored)
    # Half the width of an outline at the end of a view would be cut off
    room = MARGIN * max(view[1] - view[0], view[3] - view[2])
    room = room if part.outline is not None and asked.view is None else 0.0
    axes.set_xlim(view[0] - room, view[1] + room)
    axes.set_ylim(view[2] - room, view[3] + room)
    units = run.units
    drawing.draw_scale_bar(axes, view, units, bodies.landmarks(run, field.time)[:, :2])
    axes.set_xlabel(style.length_label("x", units))
    axes.set_ylabel(style.length_label("r" if run.is_axisymmetric else "y", units))
    # A flat picture has room for few marks on its short side.
    width, height = _size(view)
    for axis, inches in ((axes.xaxis, width), (axes.yaxis, height - 0.9)):
        axis.set_major_locator(
            MaxNLocator(int(np.clip(2 * inches, 4, 9)), steps=[1, 2, 2.5, 5, 10])
        )


def _seen(run: Run, field: Field, view: View | None, follow: str | None, *, mirror: bool) -> View:
    whole = whole_view(run, field, mirror=mirror)
    if follow is None:
        return view or default_view(run, whole, np.array([field.time]))
    x, y, _ = bodies.middle(run, follow, field.time)
    if run.is_axisymmetric:
        y = 0.0
    moved = np.array([x, y])
    if view is None:
        view = followed_view(run, follow, field.time, whole)
        moved = moved + kept_inside(run, view, moved, whole)
    return tuple(np.array(view) + np.repeat(moved, 2))


def _size(view: View) -> tuple[float, float]:
    """Size of the axes (inches)."""
    largest_width, largest_height = style.LARGEST
    aspect = (view[1] - view[0]) / (view[3] - view[2])
    width = min(largest_width, aspect * largest_height)
    # Room for title, labels and a bar below.
    return width + 0.6, width / aspect + 0.9
