"""Published curves: CSV files that say in their head whose they are and what they show.

The head is comments `# key = value`: `quantity` (as in `series.csv`, or one minus another) and
`source` are needed; `time`, `value` are what the two columns are multiplied by to have the units of
the case, `offset` is added to the value after that, `kind` is that of a reference (`literature` if
absent), `variant` the variant of the case it belongs to. Other comments, and a line of names, are
passed over.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from alewife_post import evidence

Array = np.ndarray
KEY = re.compile(r"#\s*(quantity|source|time|value|offset|kind|variant)\s*=\s*(.*?)\s*$")


@dataclass(frozen=True)
class Curve:
    """Points of a curve others have published, in the units of the case."""

    path: Path
    quantity: str
    source: str
    kind: str
    variant: str | None
    time: Array
    values: Array

    @property
    def label(self) -> str:
        """For a legend."""
        kind = evidence.KINDS.get(self.kind, self.kind)
        return f"{self.source} ({kind}{f', {self.variant}' if self.variant else ''})"


def read_curve(path: Path) -> Curve:
    """Read one file."""
    head: dict[str, str] = {}
    rows = []
    names_seen = False
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = KEY.match(line)
        if found:
            head[found[1]] = found[2]
        if not line.strip() or line.startswith("#"):
            continue
        try:
            row = [float(text) for text in line.split(",")]
        except ValueError:
            row = []
        if len(row) != 2:
            if names_seen or rows:
                raise ValueError(f"{path}:{number}: two numbers are wanted, not `{line}`")
            names_seen = True
            continue
        rows.append(row)
    missing = [key for key in ("quantity", "source") if key not in head]
    if missing:
        raise ValueError(
            f"{path} does not say in its head `# {missing[0]} = ...`, so it cannot be drawn "
            "beside a run"
        )
    if not rows:
        raise ValueError(f"{path} has no points")
    factors = {}
    for key, usual in (("time", 1.0), ("value", 1.0), ("offset", 0.0)):
        try:
            factors[key] = float(head.get(key, usual))
        except ValueError:
            raise ValueError(f"{path}: `# {key} = {head[key]}` is no number") from None
    time, values = np.array(sorted(rows)).T
    return Curve(
        path,
        head["quantity"],
        head["source"],
        head.get("kind", "literature"),
        head.get("variant"),
        factors["time"] * time,
        factors["value"] * values + factors["offset"],
    )


def is_curve(path: Path) -> bool:
    """Whether a file says of which quantity it is."""
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    with path.open() as file:
        return any(found and found[1] == "quantity" for found in map(KEY.match, file))


def curves_of(directory: Path) -> list[Curve]:
    """All curves a case ships in its directory."""
    return [read_curve(path) for path in sorted(directory.glob("*.csv")) if is_curve(path)]
