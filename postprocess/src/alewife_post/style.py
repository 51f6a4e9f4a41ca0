"""Colours, fonts, labels, figure sizes: the only file that knows them."""

from __future__ import annotations

import re
import textwrap
from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.colors import Colormap, ListedColormap

from alewife_post.quantities import percentile
from alewife_post.units import Given, unit_of, units_of

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
ROD = "#7b8794"
PARTICLE = "#ff6f59"
TRAIL = "#f28e2b"
ARROW = "#e4572e"
ARROW_IN_BODY = "#ffffff"

STREAMTUBE = "#8aa4b8"
ISO = "#4f8fc9"
ISO_OPACITY = 0.4
"""A surface in the fluid, through which bodies are seen."""

SOLID = {"ambient": 0.35, "diffuse": 0.7, "specular": 0.15}
"""How surfaces in space take light."""

LIGHT = 0.6
"""Brightness of colours over which light lines are not seen."""

DPI = 200
LARGEST = (7.2, 5.2)
"""Largest width and height of the axes of a picture (inches)."""

LETTERS = 13.5
"""Letters of a title to the inch, wide ones among them."""

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
    one_sided: str
    """Colour map where values have one sign."""
    two_sided: str
    """Colour map, centred at zero, where they have both."""


LOOKS = {
    "speed": Look("speed", "viridis", "viridis"),
    "pressure": Look("pressure", "cividis", "PuOr_r"),
    "vorticity": Look("vorticity", "Reds", "RdBu_r"),
    "shear-rate": Look("rate of shear", "magma", "magma"),
    "q": Look("Q", "Reds", "PiYG_r"),
    "traction": Look("traction", "magma", "magma"),
    "wall-shear": Look("wall shear stress", "magma", "magma"),
    "displacement": Look("displacement", "viridis", "viridis"),
    "strain": Look("equivalent strain", "magma", "magma"),
}


def look_of(quantity: str) -> Look:
    """How a quantity is shown; a scalar by its own name."""
    return LOOKS.get(quantity) or Look(quantity, "plasma", "PuOr_r")


def use() -> None:
    """Make matplotlib look like this file."""
    matplotlib.rcParams.update(PARAMETERS)


def label(quantity: str, units: Given) -> str:
    """Label of a colour bar, with the unit if it is known."""
    unit = unit_of(quantity, units)
    own = look_of(quantity).label
    return f"{own} ({unit})" if unit else own


def length_label(name: str, units: Given) -> str:
    """Label of a coordinate axis."""
    unit = units_of(units).length
    return f"{name} ({unit})" if unit else name


def time_text(time: float, units: Given) -> str:
    """A time, for a title."""
    unit = units_of(units).time
    return f"t = {time:.4g} {unit}" if unit else f"t = {time:.4g}"


def fitted(text: str, inches: float) -> str:
    """A title in as many lines as it needs on a picture so wide."""
    # Only at plain spaces: a time stays in one piece.
    kept = re.sub(
        r"\b[txyz] = [^\s,]+( [^\s,]+(?=,|$))?", lambda found: found[0].replace(" ", "\u00a0"), text
    )
    lines = textwrap.wrap(kept, max(24, int(LETTERS * inches)))
    return "\n".join(lines).replace("\u00a0", " ")


def rgb(colour: str) -> Array:
    """A colour as three numbers up to 255."""
    return np.round(255 * np.array(matplotlib.colors.to_rgb(colour))).astype(np.uint8)


def round_length(length: float) -> float:
    """The largest of 1, 2, 5, 10, ... that is not longer."""
    ten = 10.0 ** np.floor(np.log10(length))
    return float(ten * max(step for step in (1.0, 2.0, 5.0) if step * ten <= length * (1 + 1e-9)))


def length_text(length: float, units: Given) -> str:
    """A length with its unit, if it is known."""
    unit = units_of(units).length
    return f"{length:g} {unit}" if unit else f"{length:g}"


ALL = "all values"
"""What a legend says of limits that leave out nothing."""
TAIL = {"speed": 0.1, "pressure": 0.3, "shear-rate": 1.0, "traction": 1.0, "wall-shear": 1.0}
"""Per cent of the area whose values may lie beyond a limit, on each side."""


IN_SCALARS = 0.1
"""The same of scalars, which lie between values of the case, but for overshoot in thin layers."""
ON_BODIES = 2.0
"""The same on bodies: where two nearly touch, the pressure in their gap would wash out all else."""
IN_SCENES = 1.5
"""The same of fluid in a scene, of which most is far from bodies."""
BEYOND = 25.0
"""Per cent of all vorticity, by its magnitude and area, that may lie beyond the limits."""


def colours(
    quantity: str, values: Array, share: Array | None = None, tail: float | None = None
) -> tuple[str, Limits]:
    """Colour map and limits for values `(n,)` that hold shares `(n,)` of the area.

    A few extreme values may lie outside the limits: cells crowd at bodies and in gaps, where values
    are extreme, and hold little of the area: `tail` per cent of it at each end, else `TAIL`.
    """
    look = look_of(quantity)
    share = np.ones(len(values)) if share is None else share
    if quantity in ("vorticity", "q"):
        # It is nowhere but at bodies and in wakes: parts of the area would depend on how much of
        # the fluid at rest is in view.
        size = np.abs(values)
        largest = percentile(size, size * share, 100.0 - BEYOND) if size.any() else 1.0
        if values.min() >= 0.0:
            # Magnitudes, in space
            return look.one_sided, (0.0, largest)
        return look.two_sided, (-largest, largest)
    tail = TAIL.get(quantity, IN_SCALARS) if tail is None else tail
    low, high = (percentile(values, share, wanted) for wanted in (tail, 100.0 - tail))
    if quantity in LOOKS and quantity != "pressure":
        return look.one_sided, (0.0, high or 1.0)
    largest = max(abs(low), abs(high)) or 1.0
    if min(-low, high) > 0.2 * largest:
        return look.two_sided, (-largest, largest)
    return look.one_sided, (low, high if high > low else low + 1.0)


@dataclass(frozen=True)
class Scale:
    """Colours as they are asked for; what is not follows the values."""

    limits: Limits | None = None
    colour_map: str | None = None
    """A name of matplotlib."""
    contours: int = 0
    """Bands of one colour each between the limits, drawn as lines and areas; smooth if zero."""

    def colours(
        self, quantity: str, values: Array, share: Array | None = None, tail: float | None = None
    ) -> tuple[str, Limits]:
        """Colour map and limits, likewise."""
        colour_map, limits = colours(quantity, values, share, tail)
        return self.colour_map or colour_map, self.limits or limits


FREE = Scale()


def line_colour(quantity: str, colour_map: str) -> str:
    """Of lines over a field: light ones over speed, unless its colours are a light map."""
    if quantity != "speed":
        return STREAMLINE_ON_LIGHT
    looks = look_of(quantity)
    if colour_map in (looks.one_sided, looks.two_sided):
        return STREAMLINE
    # Most of a fluid is slow, and lines are seen where it is not as well
    shades = matplotlib.colormaps[colour_map]([0.1, 0.35])[:, :3] @ [0.299, 0.587, 0.114]
    return STREAMLINE_ON_LIGHT if shades.mean() > LIGHT else STREAMLINE


def beyond(quantity: str, limits: Limits, ends: Limits, tail: float | None = None) -> str:
    """What the limits of colours leave out, for a legend, and how far that goes."""
    low, high = limits
    slack = 1e-6 * (high - low)
    reached = [end for end in ends if not low - slack <= end <= high + slack]
    if not reached:
        return ALL
    if quantity in ("vorticity", "q"):
        left_out = f"limits leave out {BEYOND:g} % of all {quantity}"
    else:
        share = TAIL.get(quantity, IN_SCALARS) if tail is None else tail
        left_out = f"limits leave out {share:g} % of the area at each end"
    return f"{left_out}, up to {', '.join(f'{end:.3g}' for end in reached)}"


def one_colour(colour: str) -> Colormap:
    """A colour map of a single colour."""
    return ListedColormap([colour])
