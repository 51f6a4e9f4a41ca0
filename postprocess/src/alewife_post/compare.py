"""Runs, points of a sweep and published curves on the same axes, and their differences."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from alewife_post import asked, quantities, series, style
from alewife_post.curves import Curve, curves_of, is_curve, read_curve
from alewife_post.read import Run, open_run

Array = np.ndarray
Row = dict[str, Any]

UNSEEN = ("title", "description", "reference", "output", "quick", "numbers", "sweep", "units")
"""Keys of a case in which two runs may differ and still compute the same."""
MOST_KEYS = 3
"""Keys a legend names; where more differ, the directory is named."""
STATISTICS = ("final", "mean", "max", "min", "rms")
N_SAMPLES = 2000
"""Times at which two curves are subtracted."""


@dataclass(frozen=True)
class Sweep:
    """The points of a sweep, as far as they have been run."""

    path: Path
    swept: list[str]
    points: list[tuple[list[Any], Run]]
    """What each point sets, and its run."""


@dataclass(frozen=True)
class Named:
    """A run and what it is called beside others."""

    label: str
    run: Run


# ---- What is compared ----------------------------------------------------------------------------


def is_sweep(path: Path) -> bool:
    """Whether a directory is that of a sweep."""
    return (path / "sweep.json").is_file()


def open_sweep(path: str | Path) -> Sweep:
    """Open the directory of a sweep, finished or not."""
    path = Path(path)
    if not is_sweep(path):
        raise FileNotFoundError(f"{path} is not a sweep: it has no sweep.json")
    plan = json.loads((path / "sweep.json").read_text())
    points = []
    for number, values in enumerate(plan["points"], 1):
        directory = path / f"points/{number:04}"
        if (directory / "case.toml").is_file() and (directory / "series.csv").is_file():
            run = open_run(directory)
            if len(run.series["time"]):
                points.append((values, run))
    if not points:
        raise ValueError(f"no point of {path} has been run: alewife sweep status {path}")
    return Sweep(path, plan["swept"], points)


def open_all(paths: Iterable[Path]) -> tuple[list[Named], list[Sweep], list[Curve]]:
    """Runs, sweeps and curves of the paths given: of a case the curves it ships."""
    runs, sweeps, curves = [], [], []
    for path in paths:
        if path.is_file():
            if not is_curve(path):
                read_curve(path)
            curves.append(read_curve(path))
        elif is_sweep(path):
            sweeps.append(open_sweep(path))
        elif (path / "case.toml").is_file() and not (path / "series.csv").is_file():
            shipped = curves_of(path)
            if not shipped:
                open_run(path)
            curves += shipped
        else:
            runs.append(open_run(path))
    return named(runs), sweeps, curves


def named(runs: list[Run]) -> list[Named]:
    """Each run with what sets its case apart from those of the others."""
    if len(runs) < 2:
        return [Named(run.path.resolve().name, run) for run in runs]
    flat = [flattened(run.case) for run in runs]
    keys = list(dict.fromkeys(key for one in flat for key in one))
    apart = [key for key in keys if len({repr(one.get(key)) for one in flat}) > 1]
    names = [run.path.resolve().name for run in runs]
    labels = names
    if apart and len(apart) <= MOST_KEYS:
        texts = [", ".join(f"{short(key, apart)} = {value_text(one.get(key))}" for key in apart)
                 for one in flat]  # fmt: skip
        if max(map(len, texts)) <= 60:
            labels = texts
    if len(set(labels)) < len(labels):
        # Equal cases: what differs is the program, the machine, or the threads.
        labels = [
            f"{label} ({name})" if label != name else str(run.path)
            for label, name, run in zip(labels, names, runs, strict=True)
        ]
    return [Named(label, run) for label, run in zip(labels, runs, strict=True)]


def flattened(case: dict[str, Any]) -> dict[str, Any]:
    """Keys of a case by their paths, but for those that change nothing computed."""
    found: dict[str, Any] = {}

    def visit(prefix: str, value: object) -> None:
        if isinstance(value, dict):
            for key, inner in value.items():
                visit(f"{prefix}.{key}" if prefix else key, inner)
        elif isinstance(value, list) and any(isinstance(one, dict) for one in value):
            for nth, inner in enumerate(value):
                visit(f"{prefix}.{nth}", inner)
        else:
            found[prefix] = value

    visit("", {key: value for key, value in case.items() if key not in UNSEEN})
    return found


def short(key: str, others: Iterable[str]) -> str:
    """The end of a path that no other path has; no bare number."""
    parts = key.split(".")
    rest = [other.split(".") for other in others if other != key]
    for n in range(1, len(parts) + 1):
        end = parts[-n:]
        if not end[0].isdigit() and all(other[-n:] != end for other in rest):
            return ".".join(end)
    return key


def value_text(value: object) -> str:
    """A value of a key, for a legend."""
    if value is None:
        return "none"
    return f"{value:g}" if isinstance(value, float) else str(value)


# ---- Curves on the same axes ---------------------------------------------------------------------


@dataclass(frozen=True)
class Entry:
    """One curve of a panel."""

    label: str
    time: Array
    values: Array
    is_ours: bool


def chosen_names(runs: list[Named], curves: list[Curve], names: list[str]) -> list[str]:
    """Panels: what was asked for, else what the curves show, else what suits the first run."""
    if names:
        found = []
        for name in names:
            for one in runs:
                asked.lines(one.run.series, name)
            found += [line.name for line in asked.lines(runs[0].run.series, name)]
        return list(dict.fromkeys(found))
    if curves:
        return list(dict.fromkeys(curve.quantity for curve in curves))
    own = series.in_common([one.run for one in runs])
    if not own:
        raise ValueError("these runs have no quantity in common")
    return own


def entries(
    runs: list[Named], curves: list[Curve], name: str, window: series.Span | None
) -> list[Entry]:
    """All curves of one quantity, ours before those of others."""
    found = []
    for one in runs:
        time = one.run.series["time"]
        shown = series.within(time, window)
        (line,) = asked.lines(one.run.series, name)
        found.append(Entry(one.label, time[shown], line.values[shown], True))
    for curve in curves:
        if curve.quantity == name:
            kept = np.ones(len(curve.time), dtype=bool)
            if window is not None:
                kept = (curve.time >= window[0]) & (curve.time <= window[1])
            found.append(Entry(curve.label, curve.time[kept], curve.values[kept], False))
    return found


def compare_figure(
    runs: list[Named],
    curves: list[Curve],
    names: list[str],
    *,
    window: series.Span | None = None,
    is_whole: bool = False,
) -> Figure:
    """Runs as lines and published curves as marks, one panel for each quantity."""
    style.use()
    titles = dict.fromkeys(one.run.title for one in runs)
    figure, rows = series.stacked(len(names), " / ".join(titles))
    for axes, name in zip(rows, names, strict=True):
        found = entries(runs, curves, name, window)
        colours = series.line_colours(len(runs))
        others = 0
        for nth, entry in enumerate(found):
            if entry.is_ours:
                label = entry.label if len(runs) > 1 else "computed"
                curve = (entry.time, entry.values)
                series.draw(axes, curve, colour=colours[nth], label=label, rank=nth)
            else:
                axes.plot(
                    entry.time, entry.values, series.MARKERS[others % len(series.MARKERS)],
                    ms=3.2, mew=0.8, color=style.REFERENCE, mfc="none", label=entry.label,
                )  # fmt: skip
                others += 1
        ours = [(entry.time, entry.values) for entry in found if entry.is_ours]
        theirs = [value for entry in found if not entry.is_ours for value in entry.values]
        if not is_whole:
            limits = series.robust_limits(ours, theirs)
            if limits is not None:
                series.cut(axes, ours, limits)
        series.tidy(axes)
        axes.set_ylabel(series.panel_label([name], runs[0].run.case))
        series.legend(axes)
    rows[-1].set_xlabel(series.time_label(runs[0].run))
    return figure


def differences(
    runs: list[Named], curves: list[Curve], names: list[str], window: series.Span | None = None
) -> list[Row]:
    """Statistics of each curve, and how far it is from the first run where both are known.

    Differences are of the curves, interpolated between rows, over the time both have: the root mean
    square and the largest; of a published curve at its own points, computed less published. A
    steady run, of one row, is compared by its value.
    """
    rows: list[Row] = []
    for name in names:
        first: Entry | None = None
        for entry in entries(runs, curves, name, window):
            kept = np.isfinite(entry.values)
            time, values = entry.time[kept], entry.values[kept]
            row: Row = {"quantity": name, "curve": entry.label}
            if len(time):
                row |= {
                    "final": float(values[-1]),
                    "mean": quantities.mean(time, values),
                    "max": float(values.max()),
                    "min": float(values.min()),
                }
                if first is None:
                    first = Entry(entry.label, time, values, True)
                else:
                    row |= _distance(first, Entry(entry.label, time, values, entry.is_ours))
            rows.append(row)
    return rows


def _distance(first: Entry, other: Entry) -> Row:
    if len(first.time) == 1 or len(other.time) == 1:
        apart = float(other.values[-1] - first.values[-1])
        return {"rms difference": abs(apart), "largest": apart, "at": float(other.time[-1])}
    start = max(first.time[0], other.time[0])
    end = min(first.time[-1], other.time[-1])
    if end <= start:
        return {}
    if other.is_ours:
        at = np.linspace(start, end, N_SAMPLES)
        apart = np.interp(at, other.time, other.values) - np.interp(at, first.time, first.values)
    else:
        inside = (other.time >= start) & (other.time <= end)
        at = other.time[inside]
        if len(at) == 0:
            return {}
        apart = np.interp(at, first.time, first.values) - other.values[inside]
    worst = int(np.argmax(np.abs(apart)))
    return {
        "rms difference": float(np.sqrt(np.mean(apart**2))),
        "largest": float(apart[worst]),
        "at": float(at[worst]),
    }
