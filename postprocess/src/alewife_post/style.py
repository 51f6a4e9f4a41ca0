"""Colours, fonts, labels, figure sizes: the only file that knows them."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.colors import Colormap, ListedColormap

Array = np.ndarray
Limits = tuple[float, float]

BODY = "#3b4048"
FLUID = "#eef2f5"
BOUNDARY = "#22262b"
EDGE = "#5b6b7a"
STREAMLINE = "#ffffff"
STREAMLINE_ON_LIGHT = "#30363d"
SERIES = ("#1f5f99", "#3f8f5f", "#8a5a9e", "#b08900", "#4f8a8b")
REFERENCE = "#c8553d"

DPI = 200
LARGEST = (7.2, 5.2)
"""Largest width and height of the axes of a picture (inches)."""

PARAMETERS = {
    "font.family": "sans-serif",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.6,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "figure.dpi": 100,
    "savefig.dpi": DPI,
    "svg.fonttype": "none",
}


@dataclass(frozen=True)
class Look:
    """How one quantity is shown."""

    label: str
    unit: str
    one_sided: str
    """Colour map where values have one sign."""
    two_sided: str
    """Colour map, centred at zero, where they have both."""


LOOKS = {
    "speed": Look("speed", "m/s", "viridis", "viridis"),
    "pressure": Look("pressure", "Pa", "cividis", "PuOr_r"),
    "vorticity": Look("vorticity", "1/s", "RdBu_r", "RdBu_r"),
}


def use() -> None:
    """Make matplotlib look like this file."""
    matplotlib.rcParams.update(PARAMETERS)


def label(quantity: str, units: str) -> str:
    """Label of a colour bar; units are named only where they are those of SI."""
    look = LOOKS[quantity]
    return f"{look.label} ({look.unit})" if units.upper() == "SI" else look.label


def length_label(name: str, units: str) -> str:
    """Label of a coordinate axis."""
    return f"{name} (m)" if units.upper() == "SI" else name


def time_text(time: float, units: str) -> str:
    """A time, for a title."""
    return f"t = {time:.4g} s" if units.upper() == "SI" else f"t = {time:.4g}"


def colours(quantity: str, values: Array) -> tuple[str, Limits]:
    """Colour map and limits for values `(n,)`; a few extreme values may lie outside the limits."""
    look = LOOKS[quantity]
    if quantity == "speed":
        return look.one_sided, (0.0, float(values.max()) or 1.0)
    # Cells, and so nodes, crowd at bodies, where the vorticity is far larger than in a wake.
    share = 3.0 if quantity == "vorticity" else 0.2
    low, high = (float(limit) for limit in np.percentile(values, [share, 100.0 - share]))
    largest = max(abs(low), abs(high)) or 1.0
    if quantity == "vorticity" or min(-low, high) > 0.2 * largest:
        return look.two_sided, (-largest, largest)
    return look.one_sided, (low, high if high > low else low + 1.0)


def one_colour(colour: str) -> Colormap:
    """A colour map of a single colour."""
    return ListedColormap([colour])
