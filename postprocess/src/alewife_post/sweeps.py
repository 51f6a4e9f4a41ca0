"""Sweeps: a quantity of all points against what is swept, or a curve over time for each."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from alewife_post import asked, evidence, quantities, series, style
from alewife_post.compare import STATISTICS, Named, Row, Sweep, short, value_text
from alewife_post.read import Run

Array = np.ndarray
SCALE_LOG = 20.0
"""Largest over smallest value of a parameter from which on its axis is logarithmic."""


def value_of(run: Run, name: str, statistic: str = "final") -> float:
    """A statistic of a quantity, over the window of the case or all of the run."""
    if statistic not in STATISTICS:
        raise ValueError(f"no statistic {statistic}; there are {', '.join(STATISTICS)}")
    (line,) = asked.lines(run.series, name)
    time, values = run.series["time"], line.values
    if statistic == "final":
        return float(values[-1])
    window = evidence.window(run.case)
    if window is not None:
        time, values = quantities.within(time, values, *window)
    kept = np.isfinite(values)
    time, values = time[kept], values[kept]
    if len(values) == 0:
        return float("nan")
    match statistic:
        case "mean":
            return quantities.mean(time, values)
        case "max":
            return quantities.maximum(time, values)[1]
        case "min":
            return quantities.minimum(time, values)[1]
        case _:
            return quantities.rms(time, values)


def chosen_names(sweep: Sweep, names: list[str]) -> list[str]:
    """Quantities to show, which every point has."""
    first = sweep.points[0][1]
    found = [line.name for name in names for line in asked.lines(first.series, name)]
    if found:
        return list(dict.fromkeys(found))
    runs = [run for _, run in sweep.points]
    usual = series.in_common(runs)
    referenced = set(evidence.compared(first))
    return [name for name in usual if name in referenced or series.differs(runs, name)] or usual


def table(sweep: Sweep, names: list[str], statistic: str = "final") -> list[Row]:
    """One row a point: what it sets, and the statistic of each quantity."""
    rows = []
    for values, run in sweep.points:
        row: Row = {"point": int(run.path.name)}
        row |= dict(zip(sweep.swept, values, strict=True))
        row["state"] = run.status.get("state")
        row |= {name: value_of(run, name, statistic) for name in names}
        rows.append(row)
    return rows


def sweep_figure(
    sweep: Sweep, names: list[str], *, against: str | None = None, statistic: str = "final"
) -> Figure:
    """Quantities against a swept key, one curve for each value of the others."""
    style.use()
    key = chosen_key(sweep, against)
    rows = [row for row in table(sweep, names, statistic) if isinstance(row[key], int | float)]
    others = [one for one in sweep.swept if one != key and one not in _alongside(sweep, key)]
    families: dict[str, list[Row]] = {}
    for row in rows:
        text = ", ".join(f"{short(one, sweep.swept)} = {value_text(row[one])}" for one in others)
        families.setdefault(text, []).append(row)
    figure, panels = series.stacked(len(names), sweep.points[0][1].case["title"])
    colours = series.line_colours(len(families))
    for axes, name in zip(panels, names, strict=True):
        for (text, family), colour in zip(families.items(), colours, strict=True):
            x, y = np.array(sorted((row[key], row[name]) for row in family), dtype=float).T
            axes.plot(x, y, "o-", ms=3.5, lw=1.0, color=colour, label=text or None)
        axes.set_ylabel(series.panel_label([name], sweep.points[0][1].case))
        axes.ticklabel_format(axis="y", useOffset=False)
        axes.spines[["top", "right"]].set_visible(False)
        series.legend(axes)
    at = np.array([row[key] for row in rows], dtype=float)
    if len(at) > 2 and at.min() > 0 and at.max() >= SCALE_LOG * at.min():
        panels[-1].set_xscale("log")
    panels[-1].set_xlabel(f"{key}   ({statistic} values)")
    return figure


def chosen_key(sweep: Sweep, against: str | None) -> str:
    """The swept key on the axis: the one asked for, else the one with most values."""
    columns = {
        key: [values[nth] for values, _ in sweep.points] for nth, key in enumerate(sweep.swept)
    }
    numeric = {
        key: set(column)
        for key, column in columns.items()
        if all(isinstance(value, int | float) for value in column)
    }
    if against is not None:
        ends = [key for key in numeric if key == against or key.endswith(f".{against}")]
        if len(ends) != 1:
            raise asked.UnknownNameError(asked.unknown("swept number", against, numeric))
        return ends[0]
    if not numeric:
        raise ValueError(
            f"{sweep.path} sweeps no numbers ({', '.join(sweep.swept)}): --curves draws a curve "
            "for each point"
        )
    return max(numeric, key=lambda key: len(numeric[key]))


def _alongside(sweep: Sweep, key: str) -> set[str]:
    """Keys that change with another one, so that one value of it has one of theirs."""
    nth = sweep.swept.index(key)
    found = set()
    for mth, other in enumerate(sweep.swept):
        pairs: dict[Any, set[str]] = {}
        for values, _ in sweep.points:
            pairs.setdefault(repr(values[nth]), set()).add(repr(values[mth]))
        if other != key and all(len(one) == 1 for one in pairs.values()):
            found.add(other)
    return found


def as_runs(sweep: Sweep) -> list[Named]:
    """Each point as a run, called by what it sets."""
    return [
        Named(
            ", ".join(
                f"{short(key, sweep.swept)} = {value_text(value)}"
                for key, value in zip(sweep.swept, values, strict=True)
            ),
            run,
        )
        for values, run in sweep.points
    ]
