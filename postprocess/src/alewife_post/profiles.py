"""Figures of numbers over a distance: along a line, or away from bodies."""

from __future__ import annotations

from collections.abc import Mapping

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
    panels = [velocities, ["pressure"], ["vorticity"]]
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
