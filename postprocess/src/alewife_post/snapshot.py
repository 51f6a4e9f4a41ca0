"""What one frame in the plane shows: the flow, bodies, what joins them, their ways and headings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from matplotlib.axes import Axes

from alewife_post import bodies, checked, drawing, scene, streamlines, style, tracing, ways
from alewife_post.domains import domain_low, periods
from alewife_post.fields import nodal_values
from alewife_post.periodic import images, joined, trail
from alewife_post.read import Field, Run
from alewife_post.streamlines import Streamlines

Array = np.ndarray
View = tuple[float, float, float, float]
Lines = Literal["streamlines", "arrows", "none"]
Painter = Literal["auto", "vtk", "matplotlib"]
LINES = get_args(Lines)
PAINTERS = get_args(Painter)

SMALL_BODY = 0.1
"""A body smaller than this part of the domain is looked at from near."""
LONGEST_STRIP = 8.0
"""A domain longer than this many widths is shown near its bodies only: whole, it is a line."""
FOLLOWED = 4.0
"""Half the height of a view over the reach of the body it follows."""
ARROWS = 28
"""Arrows on the longer side of a view."""
ABOVE_TRAILS = 5.7
"""Where bodies are drawn once more, so that ways end at them."""
NEAR_SWIMMER = 0.5
"""Space left around swimmers over what they take themselves."""


@dataclass(frozen=True)
class Look:
    """How frames are painted, the same for all frames of a film."""

    quantity: str
    colour_map: str
    limits: style.Limits
    lines: Lines
    painter: Painter
    width: int
    """Pixels of the image of the flow from left to right."""
    is_smooth: bool = True
    """Whether it is rendered finer than that, and averaged."""
    is_mirrored: bool = False
    contours: int = 0
    """Bands of one colour each, if not zero."""


def chosen_painter(painter: Painter) -> Painter:
    """The painter that can paint here."""
    checked.choice("painter", painter, PAINTERS)
    can_render = painter != "matplotlib" and scene.can_render()
    if painter == "auto":
        return "vtk" if can_render else "matplotlib"
    if painter == "vtk" and not can_render:
        raise ValueError("VTK can have no window here: install libosmesa6, or draw by matplotlib")
    return painter


def paint(
    axes: Axes, flow: list[Field], view: View, look: Look, lines: Streamlines | None = None
) -> None:
    """Paint a flow that is `prepared`, with streamlines if they are known already."""
    field = joined(flow)
    values = None if look.quantity == "mesh" else nodal_values(field, look.quantity)
    if look.painter == "vtk" and not look.contours:
        size = (look.width, look.is_smooth)
        image = scene.render(
            field, view, size, values, look.colour_map, look.limits, values is None
        )
        axes.imshow(image, extent=view, zorder=1, interpolation="antialiased", aspect="equal")
    elif values is None:
        drawing.draw_fluid(axes, field)
        drawing.draw_edges(axes, field)
    else:
        drawing.draw_values(axes, field, values, look.colour_map, look.limits, look.contours)
    colour = style.line_colour(look.quantity, look.colour_map)
    if lines is not None:
        drawing.draw_streamlines(axes, lines, view, colour)
    elif look.lines == "streamlines":
        drawing.draw_streamlines(
            axes, _traced(flow, view, is_mirrored=look.is_mirrored), view, colour
        )
    elif look.lines == "arrows":
        drawing.draw_arrows(axes, *drawing.on_grid(flow, view, ARROWS), colour)


def _traced(flow: list[Field], view: View, *, is_mirrored: bool) -> Streamlines:
    grid = tracing.Grid.of(*drawing.on_grid(flow, view, 240))
    mirror = tracing.Mirror(1, 0.0, 1.0) if is_mirrored and view[2] < 0.0 < view[3] else None
    return tracing.traced(grid, view, [], mirror)


def fitted_lines(run: Run, field: Field, view: View, look: Look) -> Streamlines | None:
    """Streamlines by the stream function, where a picture is to have them and they can be had."""
    if look.lines != "streamlines":
        return None
    return streamlines.streamlines(run, field, view, mirror=look.is_mirrored)


def paint_bodies(
    axes: Axes,
    run: Run,
    view: View,
    time: float,
    *,
    field: Field | None,
    colour: Callable[[str], str] = lambda name: style.BODY,
    trails: bool = False,
) -> None:
    """Bodies below the flow, so that its edge is theirs, and what shows their motion above it.

    `field` is the whole flow. Bodies that deform are what its mesh leaves out; without it they are
    dots.
    """
    placed = bodies.poses(run, time)
    changing = bodies.deforming(run) | {
        name for name in placed if bodies.shape(run, name, time) is None
    }
    if field is not None and not bodies.is_written(run, time):
        # The mesh knows better than messages of another time where they are.
        changing = set(placed)
    region = (np.array([view[0], view[2], 0.0]), np.array([view[1], view[3], 0.0]))
    if field is not None:
        low, high = field.nodes.min(axis=0), field.nodes.max(axis=0)
        shifts = images(run.case, np.append(low, 0.0), np.append(high, 0.0), region)[:, :2]
        drawing.draw_boundary(axes, field, periods(run.case)[:2], shifts)
        # Bodies of a run whose messages are lost are holes as well.
        if changing or not placed:
            drawing.draw_holes(axes, run.case, field, shifts)
    for name, (center, turn) in placed.items():
        size = bodies.radius(run, name)
        for shift in images(run.case, center - size, center + size, region):
            pose = (center + shift, turn)
            if name not in changing:
                seen = bodies.shape(run, name, time)
                drawing.draw_shape(axes, seen, pose, colour(name))
                if trails:
                    drawing.draw_shape(axes, seen, pose, colour(name), ABOVE_TRAILS)
            elif field is None:
                axes.plot(*pose[0][:2], "o", ms=4.0, color=colour(name), zorder=0)
    if trails:
        for times, way in ways.trails(run):
            drawing.draw_trail(
                axes,
                [
                    piece + shift
                    for piece in trail(run.case, way[times <= time * (1 + 1e-12)])
                    for shift in images(run.case, piece.min(axis=0), piece.max(axis=0), region)
                ],
            )
    for known in bodies.headings(run, placed):
        arrow = bodies.fitted(known, max(view[1] - view[0], view[3] - view[2]))
        for shift in images(run.case, arrow.start, arrow.start, region):
            drawing.draw_heading(axes, replace(arrow, start=arrow.start + shift))
    for points in bodies.rods(run, placed, time):
        for shift in images(run.case, points.min(axis=0), points.max(axis=0), region):
            drawing.draw_rod(axes, points + shift)


def title(run: Run, time: float) -> str:
    """The title of a case, with the time of a flow that is not steady."""
    return run.title + (f", {style.time_text(time, run.units)}" if run.is_unsteady else "")


def whole_view(run: Run, field: Field, *, mirror: bool = True) -> View:
    """All of the domain, of a periodic one as the case has it."""
    low, high = field.nodes.min(axis=0), field.nodes.max(axis=0)
    lengths, start = periods(run.case)[:2], domain_low(run.case)[:2]
    low = np.where(lengths > 0, start, low)
    high = np.where(lengths > 0, start + lengths, high)
    if run.is_axisymmetric and mirror:
        low[1] = -high[1]
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def default_view(run: Run, whole: View, times: Array) -> View:
    """All of the domain, or the surroundings of small bodies and of swimmers at some times."""
    low, high = np.array(whole[::2]), np.array(whole[1::2])
    around = bodies.surroundings(run, times[:: max(1, len(times) // 100)])
    if around is None or periods(run.case)[:2].any():
        return whole
    body_low, body_high = around[0][:2], around[1][:2]
    largest = max(bodies.radius(run, name) for name in bodies.poses(run, times[-1]))
    extent = (body_high - body_low).max()
    if 2 * largest < SMALL_BODY * (high - low).min():
        reach = 3.0 * largest + 0.25 * (extent - 2 * largest)
    elif bodies.swims(run):
        reach = NEAR_SWIMMER * extent
    elif (high - low).max() > LONGEST_STRIP * (high - low).min():
        reach = 1.5 * (high - low).min()
    else:
        return whole
    if run.is_axisymmetric and low[1] < 0.0:
        body_low[1] = -body_high[1]
    near = np.maximum(low, body_low - reach), np.minimum(high, body_high + reach)
    if np.prod(near[1] - near[0]) > 0.7 * np.prod(high - low):
        return whole
    return float(near[0][0]), float(near[1][0]), float(near[0][1]), float(near[1][1])


def followed_view(run: Run, name: str, time: float, whole: View) -> View:
    """The surroundings of a body or swimmer, relative to it, no larger than the domain."""
    members = bodies.followed(run, name)
    placed = bodies.poses(run, time)
    corners = np.array([bodies.corners(run, member, placed[member]) for member in members])
    middle = bodies.middle(run, name, time)
    around = max(np.abs(corners - middle)[..., :2].max(), 1e-300)
    half = 0.5 * (np.array(whole[1::2]) - np.array(whole[::2]))
    x, y = np.minimum(FOLLOWED * around * np.array([1.33, 1.0]), half)
    return float(-x), float(x), float(-y), float(y)


def kept_inside(run: Run, view: View, moved: Array, whole: View) -> Array:
    """How far a view that has `moved` `(2,)` stands back `(2,)`, to show nothing but the domain.

    A periodic domain has no end.
    """
    low, high = np.array(whole[::2]) - view[::2], np.array(whole[1::2]) - view[1::2]
    is_free = (periods(run.case)[:2] > 0) | (low > high)
    return np.where(is_free, 0.0, np.clip(moved, low, np.maximum(low, high)) - moved)
