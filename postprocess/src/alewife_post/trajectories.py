"""Paths of the centres of bodies and swimmers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from matplotlib.figure import Figure

from alewife_post import asked, checked, series, style
from alewife_post.read import Run, check_run

Array = np.ndarray
LARGEST = (5.8, 6.0)
"""Width and height of the largest panel (inches)."""
SLIMMEST = 0.15
"""Least ratio of its sides."""
NARROWEST = 3.2
"""Least width (inches): the title and the labels need it."""


def trajectory_figure(
    run: Run, names: Iterable[str] = (), *, window: series.Span | None = None
) -> Figure:
    """Paths of the centres of bodies and swimmers, from a dot to a ring."""
    check_run(run)
    style.use()
    movers = tracks(run.series)
    wanted = checked.names(names) or list(movers)
    for name in wanted:
        if name not in movers:
            raise asked.UnknownNameError(asked.unknown("body or swimmer", name, movers))
    if not wanted:
        raise ValueError(f"{run.path} has no bodies")
    shown = series.within(run.series["time"], window)
    planes = ((0, 1), (0, 2)) if run.is_spatial else ((0, 1),)
    points = np.concatenate([movers[name][shown] for name in wanted])
    sizes = [_size(points[:, plane]) for plane in planes]
    heights = [height for _, height in sizes]
    width = max(width for width, _ in sizes)
    figure = Figure(figsize=(width, 0.8 + sum(heights)), layout="constrained")
    rows = figure.subplots(len(planes), squeeze=False, height_ratios=heights)[:, 0]
    colours = dict(zip(wanted, series.line_colours(len(wanted)), strict=True))
    units = run.units
    for axes, plane in zip(rows, planes, strict=True):
        for name in wanted:
            x, y = (movers[name][shown, axis] for axis in plane)
            axes.plot(x, y, color=colours[name], lw=1.2, label=name)
            axes.plot(x[:1], y[:1], "o", color=colours[name], ms=4)
            axes.plot(x[-1:], y[-1:], "o", color=colours[name], ms=6, mfc="white")
        axes.set_aspect("equal", "datalim")
        axes.margins(0.08)
        axis_names = ("x", "r" if run.is_axisymmetric else "y", "z")
        axes.set_xlabel(style.length_label(axis_names[plane[0]], units))
        axes.set_ylabel(style.length_label(axis_names[plane[1]], units))
        axes.ticklabel_format(useOffset=False)
        axes.spines[["top", "right"]].set_visible(False)
    time = run.series["time"][shown]
    figure.suptitle(
        f"{run.case['title']}\npaths from {style.time_text(time[0], units)} (dot) to "
        f"{time[-1]:.4g} (ring)",
        fontsize=style.PARAMETERS["axes.titlesize"],
        wrap=True,
    )
    if len(wanted) > 1:
        series.legend(figure.axes[0])
    return figure


def tracks(columns: Mapping[str, Array]) -> dict[str, Array]:
    """Centres of all bodies and swimmers over time, `(n_rows, 3)`."""
    owners = dict.fromkeys(asked.owner(name) for name in columns if asked.ending(name) == "x")
    none = np.zeros(len(columns["time"]))
    return {
        name: np.stack([columns.get(f"{name}.{axis}", none) for axis in "xyz"], axis=1)
        for name in owners
    }


def _size(points: Array) -> tuple[float, float]:
    """Width and height (inches) of a panel with the shape of what is in it, its labels included."""
    known = points[np.isfinite(points).all(axis=1)]
    across, up = np.ptp(known, axis=0) if len(known) else (1.0, 1.0)
    largest = max(across, up) or 1.0
    across, up = max(across, SLIMMEST * largest), max(up, SLIMMEST * largest)
    scale = min(LARGEST[0] / across, LARGEST[1] / up)
    return max(scale * across, NARROWEST) + 0.9, scale * up + 0.7
