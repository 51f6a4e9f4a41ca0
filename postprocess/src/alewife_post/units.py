"""Units of a run, as its case names them, and those of its quantities."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

Given = str | dict[str, str]
"""`units` of a case: a text, or labels by `length`, `time` and `force`."""

WORDS = {
    "SI": ("m", "s"),
    "cm g s": ("cm", "s"),
    "mm mg s": ("mm", "s"),
    "micrometres": ("µm", None),
    "millimetres": ("mm", None),
    "centimetres": ("cm", None),
    "metres": ("m", None),
    "seconds": (None, "s"),
    "minutes": (None, "min"),
}
"""Units of length and time by what a case may say of its units."""
WRITTEN = {"um": "µm", "us": "µs", "uN": "µN"}
"""How labels that are typed without a mu are drawn."""

DIMENSIONS = (
    (r"(cycle\.)?[xyz]|minimum_gap|joint\.length", "length"),
    (r"angle|cycle\.angle|joint\.angle", "angle"),
    (r"velocity\.[xyz]|speed|cycle\.speed", "speed"),
    (r"(body_)?angular_velocity(\.[xyz])?", "turn"),
    (r"acceleration\.[xyz]", "acceleration"),
    (r"(surface_|contact_)?force\.[xyz]|joint\.force|thrust|drag", "force"),
    (r"cycle\.cost_of_transport", "force"),
    (r"(surface_|contact_)?torque(\.[xyz])?|joint\.torque", "torque"),
    (r"((shape|expended|cycle|joint)[._])?power|dissipation", "power"),
    (r"pressure", "pressure"),
    (r"vorticity(\.[xyz])?", "vorticity"),
)
"""What quantities are by their names, after that of a body, of a probe or of the flow."""


@dataclass(frozen=True)
class Units:
    """Labels, each if it is known."""

    length: str | None = None
    time: str | None = None
    force: str | None = None
    is_si: bool = False


def units_of(given: Given) -> Units:
    """Units that a case names."""
    if isinstance(given, dict):
        found = {key: WRITTEN.get(unit, unit) for key, unit in given.items()}
        return Units(**{key: found.get(key) for key in ("length", "time", "force")})
    length, time = None, None
    for words, (own_length, own_time) in WORDS.items():
        if re.search(rf"(?<!\w){re.escape(words)}(?!\w)", given, re.IGNORECASE):
            length, time = length or own_length, time or own_time
    is_si = given.upper() == "SI"
    return Units(length, time, "N" if is_si else None, is_si)


def unit_of(dimension: str, given: Given, *, is_planar: bool = False) -> str | None:
    """The unit of a dimension; forces of planar runs are those of a unit of depth."""
    own = units_of(given)
    length, time, force = own.length, own.time, own.force
    stress = ("Pa" if own.is_si else f"{force}/{length}²", force and length)
    per_depth = f"/{length}" if is_planar else ""
    found = {
        "length": (length, length),
        "displacement": (length, length),
        "angle": ("rad", "rad"),
        "speed": (f"{length}/{time}", length and time),
        "turn": (f"rad/{time}", time),
        "vorticity": (f"1/{time}", time),
        "shear-rate": (f"1/{time}", time),
        "q": (f"1/{time}²", time),
        "acceleration": (f"{length}/{time}²", length and time),
        "force": (f"{force}{per_depth}", force and (length or not is_planar)),
        "torque": (force if is_planar else f"{force} {length}", force and length),
        "pressure": stress,
        "traction": stress,
        "wall-shear": stress,
        "power": (_power(own, is_planar=is_planar), force and length and time),
    }
    # Cases give no units of scalars
    text, is_known = found.get(dimension, (None, None))
    return text if is_known else None


def _power(own: Units, *, is_planar: bool) -> str:
    if own.is_si:
        return "W/m" if is_planar else "W"
    return f"{own.force}/{own.time}" if is_planar else f"{own.force} {own.length}/{own.time}"


def unit_of_quantity(name: str, case: dict[str, Any]) -> str | None:
    """The unit of a column of the series."""
    for pattern, dimension in DIMENSIONS:
        if re.fullmatch(rf"[^.]+\.({pattern})", name):
            is_planar = case.get("geometry") == "planar"
            return unit_of(dimension, case.get("units", ""), is_planar=is_planar)
    return None
