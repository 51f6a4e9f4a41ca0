"""What is known of a run: the references of its case, by their kind, and what came of them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from alewife_post import quantities
from alewife_post.asked import MINUS
from alewife_post.read import Run

Array = np.ndarray

KINDS = {
    "measured": "measured",
    "literature": "published",
    "exact": "exact",
    "independent": "another code",
    "approximate": "approximation",
    "internal": "own other run",
    "property": "condition",
    "regression": "own earlier run",
}
"""Words for each kind of reference."""

DEFECT = "_defect"
"""Ending of quantities that say how well equations are solved: shown if asked for."""

SAME_UNIT = {"final", "max", "min", "mean", "at", "rms"}
"""Statistics that have the unit of their quantity, and so a place in its panel."""


@dataclass(frozen=True)
class Reference:
    """A value a quantity is compared with, in the unit of the quantity."""

    quantity: str
    """As `asked.Line.name`."""
    statistic: str
    kind: str
    value: float
    half: float
    """Accepted difference."""
    at: float | None
    source: str

    @property
    def is_drawn(self) -> bool:
        """Whether it has a place in a panel of its quantity."""
        return self.statistic in SAME_UNIT

    @property
    def word(self) -> str:
        """Its kind in one or two words."""
        return KINDS.get(self.kind, self.kind or "reference")


def references(case: dict[str, Any]) -> list[Reference]:
    """All references of a case, in its order."""
    found = []
    for given in case.get("reference", []):
        scale = given.get("per", 1.0)
        value = scale * given["value"]
        half = abs(scale * given.get("absolute", 0.0)) or abs(value) * given.get("relative", 0.0)
        minus = given.get("minus")
        found.append(
            Reference(
                given["quantity"] + (MINUS + minus if minus else ""),
                given.get("statistic", "final"),
                given.get("kind", ""),
                value,
                half,
                given.get("at"),
                given.get("source", ""),
            )
        )
    return found


def compared(run: Run) -> list[str]:
    """Quantities of the run that have a reference, but for defects, which ought to be zero."""
    found = (reference.quantity for reference in references(run.case))
    return list(
        dict.fromkeys(
            name
            for name in found
            if all(part in run.series for part in name.split(MINUS)) and not name.endswith(DEFECT)
        )
    )


def comparisons(run: Run) -> list[dict[str, Any]]:
    """What came of each reference, as the run wrote it; empty before its end."""
    path = run.path / "comparison.json"
    if not path.is_file():
        return []
    found = json.loads(path.read_text())
    # Of a soft case a list, of values at the end
    return [of_soft(one) for one in found] if isinstance(found, list) else found["comparisons"]


def of_soft(one: dict[str, Any]) -> dict[str, Any]:
    """A comparison of a soft case as those of flows are."""
    computed = one["computed"]
    return one | {
        "minus": None,
        "statistic": "final",
        "at": None,
        "difference": None if computed is None else computed - one["reference"],
        "is_relative": False,
        "tolerance": one["allowed"],
        "verdict": "within" if one["within"] else "OUTSIDE",
    }


def window(case: dict[str, Any]) -> tuple[float, float] | None:
    """The stretch of time statistics are those of, if the case names one."""
    given = case.get("statistics", {}).get("window")
    return None if given is None else (float(given[0]), float(given[1]))


def cycle(run: Run) -> tuple[float, float, str]:
    """Start and end of the last cycle, and what that is.

    A cycle is a period of what is prescribed, else of the quantity `statistics.phase_of`; where
    there is neither, the window of the statistics, else all of the run.
    """
    time = run.series["time"]
    if len(time) == 0:
        return 0.0, 0.0, "nothing yet"
    start, end = float(time[0]), float(time[-1])
    period = _period(run.case)
    if period is not None and end - start >= period * (1 - 1e-9):
        return end - period, end, f"the last cycle ({period:.4g})"
    phase = run.case.get("statistics", {}).get("phase_of")
    if phase in run.series and len(time) > 2:
        values = run.series[phase]
        late = time > 0.5 * (start + end)
        if np.isfinite(values[late]).all() and late.sum() > 2:
            crossings = quantities.upward_crossings(time[late], values[late])
            if len(crossings) > 1:
                return float(crossings[-2]), float(crossings[-1]), f"the last cycle of {phase}"
    given = window(run.case)
    if given is not None and given[0] <= end:
        return given[0], min(given[1], end), "the window of the case's statistics"
    return start, end, "all of the run"


def _period(case: dict[str, Any]) -> float | None:
    """The longest period of anything prescribed."""
    found: list[float] = []

    def visit(value: object) -> None:
        if isinstance(value, dict):
            for key, inner in value.items():
                if key == "period" and isinstance(inner, int | float):
                    found.append(float(inner))
                elif key == "frequency" and isinstance(inner, int | float) and inner > 0:
                    found.append(1.0 / float(inner))
                else:
                    visit(inner)
        elif isinstance(value, list):
            for inner in value:
                visit(inner)

    for key in ("body", "swimmer", "joint", "boundary"):
        visit(case.get(key, {}))
    return max(found, default=None)
