"""The figure of a snapshot, with its axes and colour bar."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from alewife_post import asked, bodies, checked, drawing, style
from alewife_post.elements import mirrored, shares
from alewife_post.periodic import joined
from alewife_post.read import Field, Run
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
    nodal_values,
    paint,
    paint_bodies,
    prepared,
    settled,
    whole_view,
)

Array = np.ndarray
View = tuple[float, float, float, float]
Quantity = Literal["speed", "pressure", "vorticity", "mesh"]

QUANTITIES = ("speed", "pressure", "vorticity", "mesh")
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
    checked.run(run, is_spatial=False, instead="slices.slice_picture, or space.surface_picture,")
    checked.choice("quantity", quantity, QUANTITIES)
    if lines is not None:
        checked.choice("lines", lines, LINES)
    view = None if view is None else checked.view(view)
    painter = chosen_painter(painter)
    style.use()
    field = settled(run, run.field(time))
    velocity = field.velocity
    if frame is not None:
        velocity = velocity - body_velocity(run, frame, field.time)
    field = replace(field, velocity=velocity)
    view = _seen(run, field, view, follow, mirror=mirror)
    whole = mirrored(field) if run.is_axisymmetric and mirror else field
    flow = prepared(run, field, view, mirror=mirror)
    shown = joined(flow)
    lines = lines or ("streamlines" if quantity == "speed" else "none")

    units = run.case.get("units", "")
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
    is_unsteady = "unsteady" in run.case["time"]
    moment = f", {style.time_text(field.time, units)}" if is_unsteady else ""
    axes.set_title(style.fitted(run.case["title"] + moment, width))
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


def body_velocity(run: Run, name: str, time: float) -> Array:
    """Velocity of a body, of as many components as the run has dimensions."""
    if name not in run.bodies:
        known = ", ".join(run.bodies) or "none"
        raise asked.UnknownNameError(f"no body {name}; bodies of this run: {known}")
    history = run.bodies[name]
    return history.velocity[bodies.nearest(history, time), : 3 if run.is_spatial else 2]


def _size(view: View) -> tuple[float, float]:
    """Size of the axes (inches)."""
    largest_width, largest_height = style.LARGEST
    aspect = (view[1] - view[0]) / (view[3] - view[2])
    width = min(largest_width, aspect * largest_height)
    # Room for title, labels and a bar below.
    return width + 0.6, width / aspect + 0.9


def colour_bar(
    axes: Axes,
    values: Array,
    colour_map: str,
    limits: style.Limits,
    *,
    cax: Axes | None = None,
    is_beside: bool = False,
    alpha: float = 1.0,
) -> matplotlib.colorbar.Colorbar:
    """A bar in axes of its own, else beside a tall picture, or below a wide one, never over it."""
    least = 1e-6 * (limits[1] - limits[0])
    below = bool(values.min() < limits[0] - least)
    above = bool(values.max() > limits[1] + least)
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[below, above]
    mappable = ScalarMappable(Normalize(*limits), colour_map)
    if cax is not None:
        box = cax.get_position()
        width, height = axes.figure.get_size_inches() * (box.width, box.height)
        orientation = "horizontal" if width > height else "vertical"
        return axes.figure.colorbar(
            mappable, cax=cax, extend=extend, orientation=orientation, alpha=alpha
        )
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    is_wide = x1 - x0 > 1.4 * abs(y1 - y0) and not is_beside
    return axes.figure.colorbar(
        mappable,
        ax=axes,
        location="bottom" if is_wide else "right",
        shrink=0.6 if is_wide else 0.85,
        aspect=40 if is_wide else 28,
        pad=0.03,
        extend=extend,
    )
