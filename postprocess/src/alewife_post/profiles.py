"""Figures of numbers over a distance: along a line, or away from bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from alewife_post import series, style
from alewife_post.read import Run
from alewife_post.snapshot import title

Array = np.ndarray


def profile_figure(run: Run, columns: Mapping[str, Array], time: float) -> Figure:
    """Columns over `distance`: a fit on logarithmic axes, else velocities above the rest."""
    style.use()
    distance = columns["distance"]
    if "fit" in columns:
        figure = Figure(figsize=(4.6, 3.6), layout="constrained")
        axes = figure.add_subplot()
        axes.loglog(distance, columns["speed"], "o", ms=3.5, color=style.SERIES[0], label="speed")
        power = np.polyfit(np.log(distance), np.log(columns["fit"]), 1)[0]
        axes.loglog(distance, columns["fit"], "--", color=style.REFERENCE, label=f"r^({power:.3f})")
        axes.set_ylabel(style.label("speed", run.units))
        axes.legend()
        axes.set_xlabel(style.length_label("distance", run.units))
        axes.set_title(style.fitted(title(run, time), 4.0))
        return figure
    velocities = [name for name in columns if name.startswith("velocity.")]
    scalars = [[name] for name in run.scalars if name in columns]
    panels = [velocities, ["pressure"], ["vorticity"], *scalars]
    figure, rows = series.stacked(len(panels), title(run, time))
    for axes, names in zip(rows, panels, strict=True):
        for name, colour in zip(names, series.line_colours(len(names)), strict=True):
            axes.plot(distance, columns[name], color=colour, lw=1.2, label=name)
        quantity = "speed" if len(names) > 1 else names[0]
        own = style.label(quantity, run.units)
        axes.set_ylabel(own.replace("speed", "velocity"))
        if len(names) > 1:
            axes.legend()
    rows[-1].set_xlabel(style.length_label("distance", run.units))
    return figure


def surface_figure(
    run: Run, curves: Mapping[str, Mapping[str, Array]], quantities: Sequence[str], time: float
) -> Figure:
    """Quantities over arc length, a panel each, with a curve for each side or body."""
    style.use()
    figure, rows = series.stacked(len(quantities), title(run, time))
    colours = series.line_colours(len(curves))
    for axes, quantity in zip(rows, quantities, strict=True):
        for (name, columns), colour in zip(curves.items(), colours, strict=True):
            part = columns.get("part", np.zeros(len(columns["distance"])))
            for number in np.unique(part):
                own = part == number
                axes.plot(
                    columns["distance"][own], surface_values(columns, quantity)[own], color=colour,
                    lw=1.2, label=name if number == part[0] else None,
                )  # fmt: skip
        label = style.label("wall-shear" if quantity == "shear" else quantity, run.units)
        axes.set_ylabel(label.replace("wall shear stress", "shear along it")
                        if quantity == "shear" else label)  # fmt: skip
        axes.spines[["top", "right"]].set_visible(False)
        axes.margins(x=0.01)
        if len(curves) > 1:
            axes.legend()
    on = f" along {next(iter(curves))}" if len(curves) == 1 else ""
    rows[-1].set_xlabel(style.length_label(f"distance{on}", run.units))
    return figure


def surface_values(columns: Mapping[str, Array], quantity: str) -> Array:
    """A quantity of a surface by its columns, `(n,)`."""
    if quantity == "traction":
        parts = [values for name, values in columns.items() if name.startswith("traction.")]
        return np.linalg.norm(parts, axis=0)
    return columns[quantity.replace("-", "_")]
