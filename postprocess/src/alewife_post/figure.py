"""The figure of a snapshot, with its axes and colour bar."""

from __future__ import annotations

from typing import Literal

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from alewife_post import bodies, checked, drawing, style
from alewife_post.derived import with_quantity
from alewife_post.drawing import colour_bar
from alewife_post.elements import mirrored, shares
from alewife_post.fields import flow_at, nodal_values, prepared
from alewife_post.periodic import joined
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
Quantity = Literal["speed", "pressure", "vorticity", "shear-rate", "q", "mesh"]

QUANTITIES = ("speed", "pressure", "vorticity", "shear-rate", "q", "mesh")
IMAGE_WIDTH = 2400


def picture(
    run: Run,
    quantity: Quantity = "speed",
    *,
    time: float | None = None,
    view: View | None = None,
    frame: str | None = None,
    follow: str | None = None,
    lines: Lines | None = None,
    mirror: bool = True,
    painter: Painter = "auto",
) -> Figure:
    """A picture of one quantity at the frame nearest to `time`, or at the last one.

    `view` is x0, x1, y0, y1; without it, all of the domain, or the bodies if they are small in it.
    With a body or swimmer to `follow` it is relative to that, or what is around it.
    `frame` names a body whose velocity is subtracted. Speed has streamlines unless `lines` says
    otherwise. An axisymmetric run is shown on both sides of its axis unless `mirror` is false.
    """
    check_run(run, is_spatial=False, instead="slices.slice_picture, or space.surface_picture,")
    checked.choice("quantity", quantity, QUANTITIES)
    if lines is not None:
        checked.choice("lines", lines, LINES)
    view = None if view is None else checked.view(view)
    painter = chosen_painter(painter)
    style.use()
    field = with_quantity(run, flow_at(run, time, frame), quantity)
    view = _seen(run, field, view, follow, mirror=mirror)
    whole = mirrored(field) if run.is_axisymmetric and mirror else field
    flow = prepared(run, field, view, mirror=mirror)
    shown = joined(flow)
    lines = lines or ("streamlines" if quantity == "speed" else "none")

    units = run.units
    width, height = _size(view)
    figure = Figure(figsize=(width, height), layout="compressed")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    values, share = None, None
    colour_map, limits = ("viridis", (0.0, 1.0))
    if quantity != "mesh":
        values, share = shares(shown, nodal_values(shown, quantity), view)
        colour_map, limits = style.colours(quantity, values, share)
    is_mirrored = run.is_axisymmetric and mirror
    look = Look(quantity, colour_map, limits, lines, painter, IMAGE_WIDTH, is_mirrored=is_mirrored)
    paint_bodies(axes, run, view, field.time, field=whole)
    paint(axes, flow, view, look, fitted_lines(run, field, view, look))

    axes.set_xlim(view[0], view[1])
    axes.set_ylim(view[2], view[3])
    drawing.draw_scale_bar(axes, view, units, bodies.landmarks(run, field.time)[:, :2])
    axes.set_xlabel(style.length_label("x", units))
    axes.set_ylabel(style.length_label("r" if run.is_axisymmetric else "y", units))
    # A flat picture has room for few marks on its short side.
    for axis, inches in ((axes.xaxis, width), (axes.yaxis, height - 0.9)):
        axis.set_major_locator(
            MaxNLocator(int(np.clip(2 * inches, 4, 9)), steps=[1, 2, 2.5, 5, 10])
        )
    axes.set_title(style.fitted(title(run, field.time), width))
    if values is not None:
        colour_bar(axes, values, colour_map, limits).set_label(
            style.label(quantity, units) + ("" if frame is None else f" relative to {frame}")
        )
    return figure


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
