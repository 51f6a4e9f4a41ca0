"""What a film is to show: its request, and the quantity, the times and the colours it comes to."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from alewife_post import bodies, checked, style
from alewife_post.page import Bar
from alewife_post.read import Field, Run, read_field
from alewife_post.snapshot import LINES, Lines, Painter, View
from alewife_post.units import Given

Array = np.ndarray

QUANTITIES = ("speed", "pressure", "vorticity", "mesh", "bodies")
FEW_FIELDS = 5
"""Runs with fewer field files are shown by their bodies alone, if they move."""
MOST_FRAMES = 300
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
    particles: Path | None = None
    """Paths of particles that are drawn as well."""
    is_still: bool = False
    """Whether it is a picture: ways of particles are whole, of a steady flow to their ends."""
    scale: style.Scale = style.FREE
    """Limits and map of colours, if they are asked for."""
    camera: tuple[float, float] | None = None
    """In space: degrees about z and above the horizon."""


@dataclass(frozen=True)
class Moment:
    """One frame: a time, and the field file it shows, if any."""

    time: float
    path: Path | None


def checked_request(request: Request) -> Request:
    """The request, its view and window as numbers; ValueError where they are none."""
    checked.choice("lines", request.lines, LINES)
    if request.view is not None:
        request = replace(request, view=checked.view(request.view))
    if request.window is not None:
        request = replace(request, window=checked.window(request.window))
    return request


def chosen_quantity(run: Run, request: Request, report: Callable[[str], None]) -> str:
    """The quantity asked for, if the run has it, or the one that suits the run."""
    n = len(run.fields)
    has_motion = any(len(history.time) > 1 for history in run.bodies.values())
    if request.iso is not None and n:
        return "iso"
    if request.quantity is None:
        if request.surface and n:
            return "pressure"
        if n < FEW_FIELDS and has_motion and n < len(next(iter(run.bodies.values())).time):
            report(
                f"{n} field {'file' if n == 1 else 'files'} only: bodies are shown without the "
                "flow; output.fields of the case, such as { time = 0.1 }, asks for more"
            )
            return "bodies"
        if n == 0:
            raise FileNotFoundError(
                f"{run.path} has neither field files nor bodies that move: nothing to film"
            )
        return "speed"
    checked.choice("quantity", request.quantity, [*QUANTITIES, *run.scalars])
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


def who_is_followed(run: Run, request: Request) -> str | None:
    """Who is followed: the one asked for, or the one the run's own frame goes with."""
    follow = request.follow
    if follow == "none":
        return None
    if follow is None:
        name = run.frame_name
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
    if not run.is_unsteady:
        return "steady"
    return style.time_text(time, run.units)


def field_at(moment: Moment) -> Field | None:
    """The flow a frame shows."""
    return None if moment.path is None else read_field(moment.path)


def group_colours(run: Run) -> dict[str, str]:
    """A colour for each body: that of its swimmer."""
    found = {}
    for nth, members in enumerate(bodies.groups(run).values()):
        found |= dict.fromkeys(members, style.SERIES[nth % len(style.SERIES)])
    return found


def colour_scale(
    quantity: str,
    samples: Iterable[tuple[Array, Array]],
    units: Given,
    alpha: float = 1.0,
    scale: style.Scale = style.FREE,
) -> Bar:
    """One scale of colours for all frames, of the values `(n,)` of each and the areas they hold."""
    kept, ends = [], []
    for values, share in samples:
        kept.append(thinned(values, share))
        ends += [values.min(), values.max()]
    values = np.concatenate([one for one, _ in kept])
    share = np.concatenate([one / one.sum() for _, one in kept])
    colour_map, limits = scale.colours(quantity, values, share)
    return Bar(colour_map, limits, np.array(ends), style.label(quantity, units), alpha)


def thinned(values: Array, share: Array) -> tuple[Array, Array]:
    """Some of many values, evenly."""
    step = max(1, len(values) // SAMPLES)
    return values[::step], share[::step]


def no_film(run: Run, out: Path, request: Request, time: float) -> str:
    """That a film would have one frame only, and what to do instead."""
    still = out.with_suffix(".png")
    paths = f" --particles {request.particles}" if request.particles else ""
    instead = f"draw a picture: alewife-post picture {run.path}{paths} --out {still}"
    if not run.is_unsteady:
        return f"{run.path} is steady: it has one frame only, which is no film; {instead}"
    if request.window is not None:
        more = "a longer window may have more"
    elif request.quantity == "bodies":
        more = "a longer run has more"
    else:
        more = "output.fields of the case, such as { time = 0.1 }, asks for more"
    shown = request.iso or request.quantity
    return (
        f"{run.path} has one frame only of {shown}, at t = {time:.6g}, which is no film: "
        f"{more}; or {instead}"
    )
