"""One case at many points."""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from alewife.case import Case, Value, to_toml
from alewife.program import call

if TYPE_CHECKING:
    import pandas


def sweep(
    case: Case,
    grid: Mapping[str, Sequence[Value]],
    *,
    out: str | Path | None = None,
    jobs: int | None = None,
    quantities: Sequence[str] = (),
    progress: bool = False,
) -> pandas.DataFrame | dict[str, np.ndarray]:
    """Run a case with all combinations of some values, several at once.

    The last key of `grid` changes first. `quantities` are collected besides those of references,
    such as `mean swimmer.velocity.x`. The directory `out` is a sweep of the program: the same call
    again makes what is missing; without `out` it is temporary. Returns the table, one row a point:
    a pandas frame if pandas is there, otherwise its columns.
    """
    with tempfile.TemporaryDirectory(prefix="alewife-") as scratch:
        directory = Path(scratch) / "sweep" if out is None else Path(out)
        settings = {
            "sweep.grid": {key: list(values) for key, values in grid.items()},
            "sweep.quantities": list(quantities),
        }
        options: list[str | Path] = ["--out", directory]
        if jobs is not None:
            options += ["--jobs", str(jobs)]
        if not progress:
            options.append("--quiet")
        arguments = [*case.arguments()]
        for key, value in settings.items():
            if value:
                arguments += ["--set", f"{key}={to_toml(value)}"]
        call("sweep", "run", *arguments, *options, progress=progress)
        call("sweep", "collect", directory)
        return _table(directory / "sweep.csv")


def _table(path: Path) -> pandas.DataFrame | dict[str, np.ndarray]:
    try:
        import pandas
    except ImportError:
        with path.open(newline="") as file:
            names, *rows = list(csv.reader(file))
        return {
            name: _column(values)
            for name, values in zip(names, zip(*rows, strict=True), strict=True)
        }
    return pandas.read_csv(path)


def _column(values: Sequence[str]) -> np.ndarray:
    try:
        return np.array([float(value) if value else np.nan for value in values])
    except ValueError:
        return np.array(values)
