"""Films in the plane: one view for all frames, which may go with a swimmer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedFormatter, FixedLocator, MaxNLocator

from alewife_post import bodies, domains, drawing, style, tracers
from alewife_post.elements import mirrored, shares
from alewife_post.fields import nodal_values, prepared
from alewife_post.page import Page
from alewife_post.periodic import joined
from alewife_post.read import Run
from alewife_post.request import (
    Moment,
    Request,
    colour_scale,
    field_at,
    group_colours,
    offsets,
    time_stamp,
)
from alewife_post.snapshot import (
    Look,
    View,
    chosen_painter,
    default_view,
    fitted_lines,
    followed_view,
    kept_inside,
    paint,
    paint_bodies,
    whole_view,
)

Array = np.ndarray

FINER = 2
"""Pixels of the flow in the plane over those of the page, from left to right."""


def images(run: Run, moments: list[Moment], request: Request) -> Iterator[Array]:
    """One image a moment."""
    painter = chosen_painter(request.painter)
    units = run.units
    moved = offsets(run, request.follow, moments)[:, :2]
    if run.is_axisymmetric:
        moved[:, 1] = 0.0
    view, back = views(run, moments, request, moved)

    def seen(nth: int) -> View:
        return tuple(view + np.repeat(moved[nth] + back[nth], 2))

    bar, look = None, None
    if request.quantity != "bodies":
        colour_map, limits = ("viridis", (0.0, 1.0))
        if request.quantity != "mesh":
            bar = colour_scale(
                request.quantity,
                (_samples(run, moment, seen(nth), request) for nth, moment in enumerate(moments)),
                units,
                scale=request.scale,
            )
            colour_map, limits = bar.colour_map, bar.limits
        is_mirrored = run.is_axisymmetric and request.mirror
        look = Look(
            request.quantity, colour_map, limits, request.lines, painter, 0, False, is_mirrored
        )
    page = Page(request.size, run.title, (view[1] - view[0]) / (view[3] - view[2]), bar)
    if look is not None:
        # Finer than the page: edges of the flow are those of bodies.
        look = replace(look, width=FINER * page.pixels[0])
    _label(page, run, request)
    step = max(1, len(moments) // 20)
    placed = [
        bodies.landmarks(run, moments[nth].time)[:, :2] - moved[nth] - back[nth]
        for nth in range(0, len(moments), step)
    ]
    drawing.draw_scale_bar(page.axes, tuple(view), units, np.concatenate(placed))
    tracks = None if request.particles is None else tracers.read_paths(request.particles)
    for nth, moment in enumerate(moments):
        page.clear()
        _paint_moment(page.axes, run, moment, seen(nth), (request, look))
        if tracks is not None:
            is_mirrored = run.is_axisymmetric and request.mirror
            lines, heads = tracks.shown(run, moment.time)
            colour_map = bar.colour_map if bar is not None else ""
            shown = request.quantity if bar is not None else "mesh"
            colour = style.line_colour(shown, colour_map)
            drawing.draw_particles(page.axes, lines, heads, colour, is_mirrored=is_mirrored)
        _place(page.axes, view + np.repeat(back[nth], 2), moved[nth])
        yield page.image(time_stamp(run, moment.time))


def _samples(run: Run, moment: Moment, view: View, request: Request) -> tuple[Array, Array]:
    """Values in a view, and the areas they hold."""
    flow = joined(prepared(run, field_at(moment), view, mirror=request.mirror))
    return shares(flow, nodal_values(flow, request.quantity), view)


def _paint_moment(
    axes: Axes, run: Run, moment: Moment, view: View, how: tuple[Request, Look | None]
) -> None:
    request, look = how
    field = field_at(moment)
    if field is not None and run.is_axisymmetric and request.mirror:
        whole = mirrored(field)
    else:
        whole = field
    colours = group_colours(run) if look is None else {}
    paint_bodies(
        axes,
        run,
        view,
        moment.time,
        field=whole,
        colour=lambda name: colours.get(name, style.BODY),
        trails=request.trails,
    )
    if field is None:
        drawing.draw_domain(axes, run.case, view)
    else:
        lines = fitted_lines(run, field, view, look)
        paint(axes, prepared(run, field, view, mirror=request.mirror), view, look, lines)


def views(run: Run, moments: list[Moment], request: Request, moved: Array) -> tuple[Array, Array]:
    """A view `(4,)` for all frames, relative to what is followed, and how far back each stands.

    The latter `(n, 2)` is zero but where the followed one is near the end of the domain.
    """
    back = np.zeros((len(moments), 2))
    if request.view is not None:
        return np.array(request.view), back
    times = np.array([moment.time for moment in moments])
    whole = _whole(run, moments, request)
    if request.follow is None:
        return np.array(default_view(run, whole, times)), back
    if request.is_asked:
        view = np.array(followed_view(run, request.follow, moments[0].time, whole))
    else:
        # The view goes with the frame of the run: all bodies as they are around it at first.
        view = np.array(default_view(run, whole, times[:1])) - np.repeat(moved[0], 2)
    goes = np.zeros((len(moments), 2))
    frame = run.members.frame
    if frame in run.bodies:
        # The domain travels.
        goes = offsets(run, frame, moments)[:, :2]
    for nth, at in enumerate(moved):
        there = tuple(np.array(whole) + np.repeat(goes[nth] - goes[0], 2))
        back[nth] = kept_inside(run, tuple(view), at, there)
    return view, back


def _whole(run: Run, moments: list[Moment], request: Request) -> View:
    """All of the domain at the first frame; of a mesh unread what is around the bodies."""
    field = field_at(moments[0])
    if field is not None:
        return whole_view(run, field, mirror=request.mirror)
    whole = domains.domain_view(run.case)
    if whole is None:
        around = bodies.surroundings(run, np.array([moment.time for moment in moments]))
        low, high = around[0][:2], around[1][:2]
        reach = 0.5 * (high - low).max()
        whole = (low[0] - reach, high[0] + reach, low[1] - reach, high[1] + reach)
    return whole


def _label(page: Page, run: Run, request: Request) -> None:
    units = run.units
    after = f" - {request.follow}" if request.follow else ""
    across = "r" if run.is_axisymmetric else "y"
    page.axes.set_xlabel(style.length_label("x", units) + after)
    page.axes.set_ylabel(style.length_label(across, units) + ("" if across == "r" else after))
    page.axes.set_facecolor("white")


def _place(axes: Axes, view: Array, moved: Array) -> None:
    """Limits and marks of the axes, which stand still however the view moves."""
    axes.set_xlim(*(view[:2] + moved[0]))
    axes.set_ylim(*(view[2:] + moved[1]))
    pixels = axes.get_window_extent()
    for axis, ends, shift, length in (
        (axes.xaxis, view[:2], moved[0], pixels.width),
        (axes.yaxis, view[2:], moved[1], pixels.height),
    ):
        locator = MaxNLocator(int(np.clip(length / 70, 2, 9)), steps=[1, 2, 2.5, 5, 10])
        ticks = locator.tick_values(*ends)
        ticks = ticks[(ticks >= ends[0]) & (ticks <= ends[1])]
        axis.set_major_locator(FixedLocator(ticks + shift))
        axis.set_major_formatter(FixedFormatter([f"{tick:.6g}" for tick in ticks]))
