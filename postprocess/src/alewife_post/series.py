"""Figures over time: quantities with their references, energetics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from alewife_post import asked, checked, evidence, style
from alewife_post.quantities import percentile
from alewife_post.read import Run, check_run
from alewife_post.units import unit_of_quantity, units_of

Array = np.ndarray
Span = tuple[float, float]

START = 0.1
"""Share of the time at the start in which a transient may lie."""
TAIL = 0.02
"""Share of the time whose values may be a transient's outliers, on each side."""
SQUEEZED = 3.0
"""Outliers are cut off where they would make the axis so many times as long."""
MOST_PANELS = 5
"""Panels drawn where no quantity is asked for."""
MANY = 6
"""Curves from which on they are distinguished by a colour map."""
DASHES: tuple[Any, ...] = ("-", (0, (5, 3)), (0, (2, 2)), (0, (6, 2, 1, 2)))
"""Lines of curves in turn, so that one under another is seen."""
FEW = 10
"""Values below which each has a dot."""
MARKERS = "os^Dv"
"""Marks of the values of different sources."""
LETTERS = 13
"""Letters of a legend to the inch, less its margins."""
WIDEST = 78
"""Letters of a label."""
NOTHING = 1e-12
"""Size over that of its kind up to which a quantity is the rounding of zero."""
ALIKE = 1e-9
"""Difference over the size up to which runs have the same value."""


def series_figure(
    run: Run,
    names: Iterable[str] = (),
    *,
    window: Span | None = None,
    is_whole: bool = False,
) -> Figure:
    """Quantities over time, one panel for each one asked for, with the references of the case.

    `names` are as in `asked.lines`: `velocity.x` has one curve for each body. Without them, what
    the case has references for. A transient at the start that would squeeze the rest is cut off,
    and marked, unless `is_whole`.
    """
    check_run(run)
    style.use()
    wanted = checked.names(names) or suggested(run)
    panels = [asked.lines(run.series, name) for name in wanted]
    time = run.series["time"]
    if len(time) == 0:
        raise ValueError(f"{run.path} has no rows yet")
    shown = within(time, window)
    figure, rows = stacked(len(panels), run.title)
    for axes, lines in zip(rows, panels, strict=True):
        colours = line_colours(len(lines))
        curves = [(time[shown], line.values[shown]) for line in lines]
        for rank, (line, curve) in enumerate(zip(lines, curves, strict=True)):
            label = asked.owner(line.name) if len(lines) > 1 else None
            draw(axes, curve, colour=colours[rank], label=label, rank=rank)
        known = [
            (reference, colour)
            for line, colour in zip(lines, colours, strict=True)
            for reference in evidence.references(run.case)
            if reference.quantity == line.name and reference.is_drawn
        ]
        finish(axes, curves, [one for one, _ in known], is_whole=is_whole)
        draw_references(axes, run.case, known, is_alone=len(lines) == 1)
        axes.set_ylabel(panel_label([line.name for line in lines], run.case))
        if len(lines) > 1 or known:
            legend(axes)
    rows[-1].set_xlabel(time_label(run))
    return figure


def suggested(run: Run) -> list[str]:
    """Quantities to draw where none is asked for: those with references, else what moves."""
    series = run.series
    found = evidence.compared(run)
    if not found:
        moving = [name for name in ("velocity.x", "velocity.y") if _has(series, name)]
        found = [
            name for name in moving if any(np.ptp(_finite(one)) > 0 for one in _of(series, name))
        ]
        found += [name for name in ("drag_coefficient", "lift_coefficient") if _has(series, name)]
    others = (name for name in series if name != "time")
    return (found or [name for name in others if not name.endswith(evidence.DEFECT)])[:MOST_PANELS]


def in_common(runs: list[Run]) -> list[str]:
    """Columns to draw where none is asked for, one a panel, of those that all runs have.

    Of several bodies the first ones: what is suggested may be an ending that each of them has.
    Columns with references come first; of others only those that are not zero in all rows of all
    runs, and where nothing suggested is left, any that differ between runs.
    """
    first = runs[0].series
    shared = [name for name in first if all(name in run.series for run in runs)]
    names = dict.fromkeys(
        line.name for asked_for in suggested(runs[0]) for line in asked.lines(first, asked_for)
    )
    kept = [name for name in names if all(one in shared for one in name.split(asked.MINUS))]
    referenced = set(evidence.compared(runs[0]))
    found = [name for name in kept if name in referenced or not _is_zero(runs, name)]
    if not found:
        found = [
            name
            for name in shared
            if name != "time" and not name.endswith(evidence.DEFECT) and differs(runs, name)
        ]
    return (found or kept)[:MOST_PANELS]


def _is_zero(runs: list[Run], name: str) -> bool:
    """Whether a quantity is zero in all rows of all runs, up to rounding of those of its kind."""
    size = max(_largest(run, name) for run in runs)
    beside = [one for one in runs[0].series if _kind(one) is not None and _kind(one) == _kind(name)]
    kind = max([0.0, *(_largest(run, one) for one in beside for run in runs if one in run.series)])
    return size <= NOTHING * kind


def _kind(name: str) -> tuple[str, str] | None:
    """What components of a vector have in common, and coefficients of a body."""
    owner, _, last = name.rpartition(".")
    if last in ("x", "y", "z") and "." in owner:
        return owner, ""
    return (owner, last.rpartition("_")[2]) if "_" in last else None


def _largest(run: Run, name: str) -> float:
    (line,) = asked.lines(run.series, name)
    return float(np.abs(_finite(line.values)).max())


def differs(runs: list[Run], name: str) -> bool:
    """Whether the last values of a quantity are not all the same."""
    lines = [asked.lines(run.series, name)[0] for run in runs]
    last = np.array([_finite(line.values)[-1] for line in lines])
    return bool(np.ptp(last) > ALIKE * np.abs(last).max())


def _has(series: Mapping[str, Array], name: str) -> bool:
    return any(column.endswith(f".{name}") for column in series)


def _of(series: Mapping[str, Array], name: str) -> list[Array]:
    return [line.values for line in asked.lines(series, name)]


def _finite(values: Array) -> Array:
    kept = values[np.isfinite(values)]
    return kept if len(kept) else np.zeros(1)


# ---- Energetics ----------------------------------------------------------------------------------

ENERGETICS = (
    ("power", ("power", "shape_power", "expended_power", "dissipation")),
    ("mean power, last cycle", ("cycle.power",)),
    ("speed over the last cycle", ("cycle.speed",)),
    ("efficiency", ("cycle.efficiency", "cycle.lighthill_efficiency", "lighthill_efficiency")),
    ("cost of transport", ("cycle.cost_of_transport",)),
)


def energy_figure(run: Run, *, window: Span | None = None, is_whole: bool = False) -> Figure:
    """Power, dissipation, efficiency and cost of transport of everything that swims."""
    check_run(run)
    style.use()
    swimmers = {
        asked.owner(name) for name in run.series if asked.ending(name) == "shape_power"
    } or {asked.owner(name) for name in run.series if asked.ending(name) == "power"}
    panels = []
    for title, endings in ENERGETICS:
        names = [
            name
            for name in run.series
            if asked.ending(name) in endings and asked.owner(name) in {*swimmers, "flow"}
        ]
        names = [name for name in names if np.isfinite(run.series[name]).any()]
        if names:
            panels.append((title, names))
    if not panels:
        raise ValueError(f"{run.path} has neither power nor dissipation in its series")
    time = run.series["time"]
    shown = within(time, window)
    figure, rows = stacked(len(panels), run.title)
    for axes, (title, names) in zip(rows, panels, strict=True):
        colours = line_colours(len(names))
        curves = [(time[shown], run.series[name][shown]) for name in names]
        for rank, (name, curve) in enumerate(zip(names, curves, strict=True)):
            label = name.replace("_", " ")
            draw(axes, curve, colour=colours[rank], label=label, rank=rank)
        finish(axes, curves, [], is_whole=is_whole)
        axes.set_ylabel(title.replace(", ", ",\n") + _common_unit(names, run.case))
        legend(axes)
    rows[-1].set_xlabel(time_label(run))
    return figure


# ---- In common -----------------------------------------------------------------------------------


def within(time: Array, window: Span | None) -> Array:
    """Which rows lie in a window."""
    if window is None:
        return np.ones(len(time), dtype=bool)
    window = checked.window(window)
    inside = (time >= window[0]) & (time <= window[1])
    if not inside.any():
        there = f"t = {time[0]:g} to {time[-1]:g}" if len(time) else "nothing"
        raise ValueError(f"nothing between t = {window[0]:g} and {window[1]:g}: there is {there}")
    return inside


def stacked(n: int, title: str) -> tuple[Figure, list[Axes]]:
    """Panels one below the other, over one axis of time."""
    figure = Figure(figsize=(6.4, 1.0 + 1.9 * n), layout="constrained")
    rows = list(figure.subplots(n, 1, sharex=True, squeeze=False)[:, 0])
    figure.suptitle(title, fontsize=style.PARAMETERS["axes.titlesize"])
    return figure, rows


def line_colours(n: int) -> list[Any]:
    """Colours for so many curves."""
    if n <= MANY and n <= len(style.SERIES):
        return list(style.SERIES[:n])
    return list(matplotlib.colormaps["viridis"](np.linspace(0.0, 0.9, n)))


def draw(
    axes: Axes, curve: tuple[Array, Array], *, colour: object, label: str | None, rank: int = 0
) -> None:
    """One curve, dashed over others of lower rank; with dots if it has few values."""
    is_sparse = np.isfinite(curve[1]).sum() < FEW
    axes.plot(
        *curve,
        color=colour,
        lw=1.1,
        ls=DASHES[rank % len(DASHES)],
        marker="o" if is_sparse else "",
        ms=3.5,
        label=label,
    )


def panel_label(names: list[str], case: dict[str, Any]) -> str:
    """What a panel shows, and its unit: a name on two lines, or what its curves have in common."""
    return _shown_name(names) + _common_unit(names, case)


def _common_unit(names: list[str], case: dict[str, Any]) -> str:
    """The unit in brackets, if all curves have the same one."""
    parts = [part for name in names for part in name.split(asked.MINUS)]
    known = {unit_of_quantity(part, case) for part in parts}
    unit = known.pop() if len(known) == 1 else None
    return f" ({unit})" if unit else ""


def _shown_name(names: list[str]) -> str:
    if len(names) == 1:
        parts = names[0].split(asked.MINUS)
        if len(parts) == 2:
            return "\nminus ".join(part.replace("_", " ") for part in parts)
        return names[0].replace(".", "\n", 1).replace("_", " ")
    endings = list(dict.fromkeys(asked.ending(name) for name in names))
    return "\n".join(endings[:3]).replace("_", " ")


def time_label(run: Run) -> str:
    """Label of the axis of time."""
    unit = units_of(run.units).time
    return f"t ({unit})" if unit else "t"


def legend(axes: Axes) -> None:
    """Above the panel, where no curve can be."""
    n = len(axes.get_legend_handles_labels()[0])
    if n:
        widest = max(len(label) for label in axes.get_legend_handles_labels()[1])
        axes.legend(
            loc="lower right",
            bbox_to_anchor=(1.0, 1.0),
            borderaxespad=0.0,
            ncols=max(1, min(n, round(LETTERS * axes.figure.get_figwidth()) // (widest + 8))),
        )


def finish(
    axes: Axes,
    curves: list[tuple[Array, Array]],
    known: list[evidence.Reference],
    *,
    is_whole: bool = False,
) -> None:
    """Limits that show what matters, and marks where something lies beyond them."""
    tidy(axes)
    values = [value for one in known for value in (one.value - one.half, one.value + one.half)]
    limits = None if is_whole else robust_limits(curves, values)
    if limits is not None:
        cut(axes, curves, limits)


def tidy(axes: Axes) -> None:
    """A frame without its upper and right side, and little room beside the curves."""
    axes.margins(x=0.01)
    axes.ticklabel_format(axis="y", useOffset=False)
    axes.spines[["top", "right"]].set_visible(False)


def cut(axes: Axes, curves: list[tuple[Array, Array]], limits: Span) -> None:
    """Cut off what lies beyond limits, and say how far it goes."""
    axes.set_ylim(*limits)
    for is_low in (True, False):
        extremes = []
        for time, values in curves:
            if np.isfinite(values).any():
                at = int(np.nanargmin(values) if is_low else np.nanargmax(values))
                extremes.append((float(values[at]), float(time[at])))
        value, at = min(extremes) if is_low else max(extremes)
        if limits[0] <= value <= limits[1]:
            continue
        axes.annotate(
            f"{'v' if is_low else '^'} to {value:.3g} at t = {at:.3g}, cut off",
            (at, 0.0 if is_low else 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(4, 3 if is_low else -3),
            textcoords="offset points",
            va="bottom" if is_low else "top",
            fontsize=7.0,
            color=style.EDGE,
        )


def robust_limits(curves: list[tuple[Array, Array]], others: list[float]) -> Span | None:
    """Limits without the outliers of a transient at the start; none if it squeezes nothing.

    All values after the first tenth of the time are inside, and those of all but a fiftieth of the
    time on either side.
    """
    lows, highs, least, most = [], [], [], []
    for time, values in curves:
        kept = np.isfinite(values)
        time, values = time[kept], values[kept]
        if len(time) < 10:
            return None
        late = time >= time[0] + START * (time[-1] - time[0])
        share = np.gradient(time)
        lows.append(min(values[late].min(), percentile(values, share, 100 * TAIL)))
        highs.append(max(values[late].max(), percentile(values, share, 100 - 100 * TAIL)))
        least.append(values.min())
        most.append(values.max())
    if not lows:
        return None
    low, high = min([*lows, *others]), max([*highs, *others])
    whole = max([*most, *others]) - min([*least, *others])
    if high <= low or whole <= SQUEEZED * (high - low):
        return None
    room = 0.08 * (high - low)
    return low - room, high + room


def draw_references(
    axes: Axes,
    case: dict[str, Any],
    known: list[tuple[evidence.Reference, object]],
    *,
    is_alone: bool = True,
) -> None:
    """The interval each reference allows, over the stretch of time it speaks of."""
    given = evidence.window(case)
    ends = axes.get_xlim()
    seen: list[str] = []
    for reference, curve_colour in known:
        colour = style.REFERENCE if is_alone else curve_colour
        value, half = reference.value, reference.half
        label = shortened(f"{reference.word}: {reference.source.split(';')[0]}")
        if reference.statistic == "at":
            shown = None if label in seen else label
            marker = MARKERS[list(dict.fromkeys([*seen, label])).index(label) % len(MARKERS)]
            axes.errorbar(
                [reference.at], [value], [half], fmt=marker, ms=3.5, mfc="none",
                color=colour, capsize=2, lw=0.8, label=shown,
            )  # fmt: skip
        else:
            start, end = given or ends
            if start > ends[1] or end < ends[0]:
                # Not reached yet, or not in the window drawn.
                continue
            label = f"{reference.statistic}, {label}"
            axes.fill_between(
                [start, end], value - half, value + half, color=colour, alpha=0.2, lw=0
            )
            shown = f"{label}: {value:.4g} ± {half:.2g}"
            axes.plot([start, end], [value, value], color=colour, lw=0.8, ls="--", label=shown)
        seen.append(label)
    axes.set_xlim(*ends)


def shortened(label: str) -> str:
    """A label without the words it has no room for."""
    if len(label) <= WIDEST:
        return label
    return label[: WIDEST - 3].rpartition(" ")[0].rstrip(",;:(") + " ..."
