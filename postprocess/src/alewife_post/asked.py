"""Quantities as they are asked for: by name, by ending, by pattern, or one minus another."""

from __future__ import annotations

import difflib
import fnmatch
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NoReturn, TypeVar

import numpy as np

Array = np.ndarray
MINUS = " minus "
SHOWN = 4
"""Names suggested for one that is not known."""
T = TypeVar("T")


class UnknownNameError(KeyError):
    """A name that is not there; its text is for a reader, without the quotes of a KeyError."""

    def __str__(self) -> str:
        """The text as it is."""
        return str(self.args[0])


class Named(dict[str, T]):
    """A dictionary by names that, asked for one it does not have, says which ones are near."""

    def __init__(self, items: Mapping[str, T], kind: str, listed: str) -> None:
        """Take over items; `kind` is what they are, and `listed` what gives all names."""
        super().__init__(items)
        self.kind = kind
        self.listed = listed

    def __missing__(self, name: object) -> NoReturn:
        """Say which names are nearest."""
        message = unknown(self.kind, str(name), self)
        raise UnknownNameError(
            f"{message}; {self.listed} gives all {len(self)}" if self else message
        )


@dataclass(frozen=True)
class Line:
    """One curve over time: a column of `series.csv`, or the difference of two."""

    name: str
    """Column, or both with ` minus ` between."""
    values: Array
    """`(n_rows,)`."""


def lines(series: Mapping[str, Array], asked: str) -> list[Line]:
    """The curves of one panel.

    `fish.power` is a column; `velocity.x` the column of each body or swimmer that ends so;
    `*.power` a pattern; `a.x minus b.x` a difference; several are separated by commas.
    """
    found: dict[str, Line] = {}
    for part in asked.split(","):
        for name in _names(series, part.strip()):
            if MINUS in name:
                first, _, second = name.partition(MINUS)
                found[name] = Line(name, series[first] - series[second])
            else:
                found[name] = Line(name, series[name])
    return list(found.values())


def _names(series: Mapping[str, Array], part: str) -> list[str]:
    known = [name for name in series if name != "time"]
    if MINUS in part:
        first, second = (one.strip() for one in part.split(MINUS, 1))
        for one in (first, second):
            if one not in known:
                raise UnknownNameError(unknown("quantity", one, known))
        return [first + MINUS + second]
    if part in known:
        return [part]
    if any(sign in part for sign in "*?["):
        chosen = [name for name in known if fnmatch.fnmatchcase(name, part)]
    else:
        # The flow has quantities of its own: `velocity.x` is none of them.
        chosen = [name for name in known if name.endswith(f".{part}") and _is_whole(name, part)]
    if not part or not chosen:
        raise UnknownNameError(unknown("quantity", part, known))
    return chosen


def _is_whole(name: str, ending: str) -> bool:
    """Whether what stands before the ending is the name of a body, and no part of a quantity."""
    return "." not in name.removesuffix(f".{ending}")


def unknown(kind: str, name: str, known: Iterable[str]) -> str:
    """That there is no such thing, and the names nearest to it."""
    known = list(dict.fromkeys(known))
    if not known:
        return f"no {kind} {name}: there is none"
    # A name may be right but for its body, or but for its component.
    ends = {one: one.split(".", 1)[-1] for one in known}
    # What is written in part comes before what is written wrongly
    begun = name.lower()
    close = [one for one in known if begun and one.lower().startswith(begun)]
    close += [one for one in known if begun and ends[one].lower().startswith(begun)]
    if not close:
        near = difflib.get_close_matches(name, ends.values())
        close = difflib.get_close_matches(name, known, SHOWN, 0.6)
        close += [one for one in known if ends[one] in near]
    close += [one for one in known if name and name.lower() in one.lower()]
    close = list(dict.fromkeys(close))[:SHOWN]
    if close:
        return f"no {kind} {name}; nearest: {', '.join(close)}"
    most = 12
    more = f" and {len(known) - most} more" if len(known) > most else ""
    return f"no {kind} {name}; there are {', '.join(known[:most])}{more}"


def owner(name: str) -> str:
    """The body, swimmer or probe of a quantity."""
    return name.partition(".")[0]


def ending(name: str) -> str:
    """What a quantity is, without whose."""
    return name.partition(".")[2] or name
