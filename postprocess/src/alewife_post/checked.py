"""Arguments as they are given: what is wrong is reported with what is accepted, and the cure."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

Names = str | Path | Iterable[Any]


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
