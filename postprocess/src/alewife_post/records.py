"""What was recorded of the markers of a soft case, beside a run of it."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from alewife_post import style
from alewife_post.read import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = np.ndarray


@dataclass(frozen=True)
class Recorded:
    """A place of a marker over time, from the record, moved to where the run begins."""

    name: str
    """The column of the series, such as `tip.x`."""
    times: Array
    """Seconds, `(n,)`."""
    values: Array
    """Metres, `(n,)`; not a number where there is a gap."""


def records(run: Run) -> list[Recorded]:
    """All recorded places of markers, those of the frames of the case; none without a record."""
    given = run.case.get("record")
    if given is None or not (run.path / given["file"]).is_file():
        return []
    columns = _columns(run.path / given["file"])
    names = list(columns)
    kept = _kept(columns, given.get("begins_with"))[: int(run.case["soft"]["frames"]) + 1]
    time = columns[names[0]][kept]
    time = (time - time[0]) * given.get("time_unit", 1.0)
    found = []
    for marker in run.case.get("marker", []):
        for axis, column in marker.get("columns", {}).items():
            name = f"{marker['name']}.{axis}"
            sign, own = (-1.0, column[1:]) if column.startswith("-") else (1.0, column)
            if own not in columns or name not in run.series:
                continue
            values = sign * given.get("length_unit", 1.0) * columns[own][kept]
            moved = values - values[0] + run.series[name][0]
            found.append(Recorded(name, time, moved))
    return found


def _columns(path: Path) -> dict[str, Array]:
    with path.open(encoding="utf-8", newline="") as file:
        head, *rows = [row for row in csv.reader(file) if row]
    return {
        name.strip(): np.array([_number(row[k]) if k < len(row) else np.nan for row in rows])
        for k, name in enumerate(head)
    }


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")


def _kept(columns: dict[str, Array], begins_with: str | None) -> Array:
    """Rows that are used: those from the first change of a column on, if the case names one."""
    count = len(next(iter(columns.values())))
    if begins_with is None:
        return np.arange(count)
    told = columns[begins_with.removeprefix("-")]
    rows = np.flatnonzero(np.isfinite(told))
    begin = np.flatnonzero(told[rows] != told[rows[0]])
    return rows[begin[0] :] if len(begin) else rows[:0]


def draw_record(axes: Axes, recorded: Recorded) -> None:
    """The record under a curve of the run."""
    axes.plot(
        recorded.times, recorded.values, color=style.REFERENCE, lw=2.4, label="recorded", zorder=1
    )
