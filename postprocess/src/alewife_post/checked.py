"""Arguments as they are given: what is wrong is told with what is accepted, and the cure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from alewife_post.film import Request
    from alewife_post.read import Run

Names = str | Path | Iterable[Any]


def run(value: object, *, is_spatial: bool | None = None, instead: str = "") -> None:
    """TypeError where a value is no run; ValueError where it is one of the other dimension."""
    from alewife_post.read import Run

    if not isinstance(value, Run):
        cure = f"alewife_post.open_run({str(value)!r})" if isinstance(value, str | Path) else None
        raise TypeError(f"{value!r} is no run: {cure or 'alewife_post.open_run(DIRECTORY)'} is one")
    if is_spatial is not None and value.is_spatial != is_spatial:
        kind = "in space" if value.is_spatial else "in the plane or about an axis"
        raise ValueError(f"{value.path} is a run {kind}: {instead} draws it")


def choice(kind: str, value: object, choices: Sequence[str]) -> None:
    """ValueError where a value is none of the choices."""
    if value not in choices:
        raise ValueError(f"no {kind} {value}; there are {', '.join(choices)}")


def names(given: Names) -> list[Any]:
    """Names or paths as a list: a text or a path alone is one, and no list of letters."""
    return [given] if isinstance(given, str | Path) else list(given)


def view(given: Sequence[float]) -> tuple[float, float, float, float]:
    """The four ends of a view; ValueError where they are not four, or in another order."""
    wanted = "four numbers are accepted, xmin xmax ymin ymax, such as -2 2 -1 1"
    ends = _numbers(given)
    if len(ends) != 4:
        raise ValueError(f"view {_shown(given)}: {wanted}")
    for axis, low, high in (("x", *ends[:2]), ("y", *ends[2:])):
        if low > high:
            ordered = [*sorted(ends[:2]), *sorted(ends[2:])]
            raise ValueError(
                f"view {_shown(ends)}: {axis}min = {low:g} is above {axis}max = {high:g}; "
                f"the order is xmin xmax ymin ymax, so {_shown(ordered)}"
            )
        if low == high:
            raise ValueError(f"view {_shown(ends)}: it has no extent in {axis}; {wanted}")
    return tuple(ends)


def window(given: Sequence[float]) -> tuple[float, float]:
    """First and last time of a window; ValueError where they are not two, or in another order."""
    ends = _numbers(given)
    if len(ends) != 2:
        raise ValueError(
            f"window {_shown(given)}: two numbers are accepted, its first and its last time"
        )
    if ends[0] > ends[1]:
        raise ValueError(
            f"window {_shown(ends)}: its first time is after its last one; "
            f"write {_shown(ends[::-1])}"
        )
    return tuple(ends)


def no_film(run: Run, out: Path, request: Request, time: float) -> str:
    """That a film would have one frame only, and what to do instead."""
    still = out.with_suffix(".png")
    instead = f"draw a picture: alewife-post picture {run.path} --out {still}"
    if "unsteady" not in run.case["time"]:
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


def time(given: object) -> float:
    """A time; TypeError where it is none."""
    try:
        return float(given)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise TypeError(
            f"time {given!r}: a number is accepted, or None for the last frame"
        ) from None


def _numbers(given: object) -> list[float]:
    """Finite numbers; none where something else is given."""
    try:
        found = [] if isinstance(given, str) else [float(one) for one in given]  # type: ignore
    except (TypeError, ValueError):
        return []
    return found if all(map(math.isfinite, found)) else []


def _shown(given: object) -> str:
    found = _numbers(given)
    return " ".join(f"{one:g}" for one in found) if found else repr(given)
