"""Films of runs: which frames, one view and one scale of colours for all, and what each shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedFormatter, FixedLocator, MaxNLocator

from alewife_post import bodies, checked, drawing, movie, style
from alewife_post.elements import mirrored, shares
from alewife_post.page import SIZE, Page
from alewife_post.periodic import joined
from alewife_post.read import Field, Run, read_field
from alewife_post.snapshot import (
    LINES,
    Lines,
    Look,
    Painter,
    View,
    chosen_painter,
    default_view,
    fitted_lines,
    followed_view,
    kept_inside,
    nodal_values,
    paint,
    paint_bodies,
    prepared,
    whole_view,
)

Array = np.ndarray

QUANTITIES = ("speed", "pressure", "vorticity", "mesh", "bodies")
FEW_FIELDS = 5
"""Runs with fewer field files are shown by their bodies alone, if they move."""
MOST_FRAMES = 300
FINER = 2
"""Pixels of the flow in the plane over those of the page, from left to right."""
SAMPLES = 20_000
"""Values kept of each frame for the limits of colours."""


@dataclass(frozen=True)
class Request:
    """What a film is to show."""

    quantity: str | None = None
    """One of `QUANTITIES`; what suits the run if absent."""
    follow: str | None = None
    """Body or swimmer the view moves with."""
    is_asked: bool = False
    """Whether it was asked to follow, rather than the run's own frame moving."""
    view: View | None = None
    """Relative to the followed body, if there is one."""
    window: tuple[float, float] | None = None
    """First and last time."""
    frames: int = MOST_FRAMES
    """At most so many."""
    fps: float | None = None
    size: tuple[int, int] | None = None
    """Pixels from left to right and from top to bottom; what suits the view if absent."""
    lines: Lines = "none"
    trails: bool = True
    mirror: bool = True
    painter: Painter = "auto"
    plane: str | None = None
    """In space: plane of a slice, as `z=0.5`."""
    surface: bool = False
    """In space: pressure, or another quantity, on the bodies, and no slice."""
    iso: str | None = None
    """In space: surface of equal `vorticity`, or `vorticity=2.5`, and no slice."""
    camera: tuple[float, float] | None = None
    """In space: degrees about z and above the horizon."""


@dataclass(frozen=True)
class Moment:
    """One frame: a time, and the field file it shows, if any."""

    time: float
    path: Path | None


def film(run: Run, out: Path, request: Request, tell: Callable[[str], None] = print) -> int:
    """Write a film of a run, finished or under way; returns the number of frames."""
    checked.run(run)
    out = Path(out)
    movie.check(out)
    request = _checked(request)
    width, height = request.size or SIZE
    if width % 2 or height % 2 or min(width, height) < 120:
        raise ValueError(f"{width} x {height}: sides of a film are even, and at least 120 pixels")
    if request.fps is not None and not 0.1 <= request.fps <= 100:
        raise ValueError(f"{request.fps:g} frames a second: between 0.1 and 100 can be played")
    if request.frames < 1:
        raise ValueError("a film has one frame at least")
    quantity = chosen_quantity(run, request, tell)
    is_asked = request.follow is not None
    request = replace(request, quantity=quantity, follow=_followed(run, request), is_asked=is_asked)
    moments = chosen_moments(run, request)
    if len(moments) == 1 and request.frames > 1:
        raise ValueError(checked.no_film(run, out, request, moments[0].time))
    fps = request.fps or min(25.0, max(4.0, len(moments) / 5.0))
    style.use()
    if run.is_spatial:
        from alewife_post import stage

        images = stage.images(run, moments, request)
    else:
        images = _planar_images(run, moments, request)
    n = movie.write(out, images, fps)
    tell(
        f"{out}: {n} {'frame' if n == 1 else 'frames'} of {request.iso or quantity}, "
        f"t = {moments[0].time:.4g} to {moments[-1].time:.4g}, {fps:g} a second"
    )
    return n


def _checked(request: Request) -> Request:
    checked.choice("lines", request.lines, LINES)
    if request.view is not None:
        request = replace(request, view=checked.view(request.view))
    if request.window is not None:
        request = replace(request, window=checked.window(request.window))
    return request


# ---- What is shown, and when ---------------------------------------------------------------------


def chosen_quantity(run: Run, request: Request, tell: Callable[[str], None]) -> str:
    """The quantity asked for, if the run has it, or the one that suits the run."""
    n = len(run.fields)
    has_motion = any(len(history.time) > 1 for history in run.bodies.values())
    if request.iso is not None and n:
        return "iso"
    if request.quantity is None:
        if request.surface and n:
            return "pressure"
        if n < FEW_FIELDS and has_motion and n < len(next(iter(run.bodies.values())).time):
            tell(
                f"{n} field {'file' if n == 1 else 'files'} only: bodies are shown without the "
                "flow; output.fields of the case, such as { time = 0.1 }, asks for more"
            )
            return "bodies"
        if n == 0:
            raise FileNotFoundError(
                f"{run.path} has neither field files nor bodies that move: nothing to film"
            )
        return "speed"
    if request.quantity not in QUANTITIES:
        raise ValueError(f"no quantity {request.quantity}; there are {', '.join(QUANTITIES)}")
    if request.quantity == "bodies":
        if not has_motion:
            known = "speed, pressure, vorticity" if n else "none"
            raise ValueError(f"no body moves in {run.path}; quantities of its fields: {known}")
    elif n == 0:
        instead = "; bodies can be shown: --quantity bodies" if has_motion else ""
        raise FileNotFoundError(
            f"{run.path} has no field files, which {request.quantity} needs: "
            f"see output.fields of its case{instead}"
        )
    return request.quantity


def _followed(run: Run, request: Request) -> str | None:
    """Who is followed: the one asked for, or the one the run's own frame goes with."""
    follow = request.follow
    if follow == "none":
        return None
    if follow is None:
        frame = run.case.get("frame")
        name = frame if isinstance(frame, str) else None
        return name if name in bodies.groups(run) or name in run.bodies else None
    bodies.followed(run, follow)
    return follow


def chosen_moments(run: Run, request: Request) -> list[Moment]:
    """Times evenly over the run, or the window, at each the nearest field or message.

    Nothing is interpolated: there are at most as many frames as fields or messages, and each frame
    has the time of its own.
    """
    if request.quantity == "bodies":
        history = max(run.bodies.values(), key=lambda one: len(one.time))
        known = [Moment(float(time), None) for time in history.time]
    else:
        known = [Moment(frame.time, frame.path) for frame in run.fields]
        # Of a run under way messages come later than fields: a film ends where both are there.
        latest = max([0.0, *(history.time[-1] for history in run.bodies.values())])
        if run.bodies and known[0].time <= latest:
            known = [one for one in known if one.time <= latest * (1 + 1e-9) + 1e-12]
    first, last = known[0].time, known[-1].time
    if request.window is not None:
        start, end = request.window
        known = [one for one in known if start - 1e-9 <= one.time <= end + 1e-9]
        if not known:
            raise ValueError(
                f"nothing between t = {start:g} and {end:g}: there is t = {first:g} to {last:g}"
            )
    times = np.array([one.time for one in known])
    n = min(request.frames, len(known))
    wanted = np.linspace(times[0], times[-1], n)
    return [known[int(np.argmin(np.abs(times - time)))] for time in wanted]


def offsets(run: Run, follow: str | None, moments: list[Moment]) -> Array:
    """Where the view moves to at each frame, `(n, 3)`: the middle of what is followed."""
    if follow is None:
        return np.zeros((len(moments), 3))
    return np.array([bodies.middle(run, follow, moment.time) for moment in moments])


def time_stamp(run: Run, time: float) -> str:
    """The time of a frame, in the units of the case."""
    if "unsteady" not in run.case["time"]:
        return "steady"
    return style.time_text(time, run.case.get("units", ""))


def field_at(moment: Moment) -> Field | None:
    """The flow a frame shows."""
    return None if moment.path is None else read_field(moment.path)


def limits_of(quantity: str, samples: list[tuple[Array, Array]]) -> tuple[str, style.Limits]:
    """Colour map and limits over all frames, by the area each value holds."""
    values = np.concatenate([one for one, _ in samples])
    share = np.concatenate([one / one.sum() for _, one in samples])
    return style.colours(quantity, values, share)


def thinned(values: Array, share: Array) -> tuple[Array, Array]:
    """Some of many values, evenly."""
    step = max(1, len(values) // SAMPLES)
    return values[::step], share[::step]


def group_colours(run: Run) -> dict[str, str]:
    """A colour for each body: that of its swimmer."""
    found = {}
    for nth, members in enumerate(bodies.groups(run).values()):
        found |= dict.fromkeys(members, style.SERIES[nth % len(style.SERIES)])
    return found


# ---- In the plane --------------------------------------------------------------------------------


def _planar_images(run: Run, moments: list[Moment], request: Request) -> Iterator[Array]:
    painter = chosen_painter(request.painter)
    units = run.case.get("units", "")
    moved = offsets(run, request.follow, moments)[:, :2]
    if run.is_axisymmetric:
        moved[:, 1] = 0.0
    view, back = _planar_views(run, moments, request, moved)

    def seen(nth: int) -> View:
        return tuple(view + np.repeat(moved[nth] + back[nth], 2))

    bar, look = None, None
    if request.quantity != "bodies":
        colour_map, limits = ("viridis", (0.0, 1.0))
        if request.quantity != "mesh":
            samples = []
            for nth, moment in enumerate(moments):
                flow = joined(prepared(run, field_at(moment), seen(nth), mirror=request.mirror))
                values = nodal_values(flow, request.quantity)
                samples.append(thinned(*shares(flow, values, seen(nth))))
            colour_map, limits = limits_of(request.quantity, samples)
            every = np.concatenate([values for values, _ in samples])
            bar = (colour_map, limits, every, style.label(request.quantity, units), 1.0)
        is_mirrored = run.is_axisymmetric and request.mirror
        look = Look(
            request.quantity, colour_map, limits, request.lines, painter, 0, False, is_mirrored
        )
    page = Page(request.size, run.case["title"], (view[1] - view[0]) / (view[3] - view[2]), bar)
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
    for nth, moment in enumerate(moments):
        page.clear()
        _paint_moment(page.axes, run, moment, seen(nth), (request, look))
        _place(page.axes, view + np.repeat(back[nth], 2), moved[nth])
        yield page.image(time_stamp(run, moment.time))


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


def _planar_views(
    run: Run, moments: list[Moment], request: Request, moved: Array
) -> tuple[Array, Array]:
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
    frame = run.case.get("frame")
    goes = np.zeros((len(moments), 2))
    if isinstance(frame, str) and (frame in bodies.groups(run) or frame in run.bodies):
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
    whole = drawing.domain_view(run.case)
    if whole is None:
        around = bodies.surroundings(run, np.array([moment.time for moment in moments]))
        low, high = around[0][:2], around[1][:2]
        reach = 0.5 * (high - low).max()
        whole = (low[0] - reach, high[0] + reach, low[1] - reach, high[1] + reach)
    return whole


def _label(page: Page, run: Run, request: Request) -> None:
    units = run.case.get("units", "")
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
