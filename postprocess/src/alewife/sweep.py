"""One case at many points."""

from __future__ import annotations

import csv
import tempfile
import warnings
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from alewife.case import Case, Value, to_toml
from alewife.program import AlewifeWarning, call
from alewife_post import checked

if TYPE_CHECKING:
    import pandas

SUCH_AS = "such as {'fluid.viscosity': [1.0, 2.0]}"


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
    if not isinstance(case, Case):
        raise TypeError(f"{case!r} is no case: alewife.load({str(case)!r}) is one")
    if not isinstance(grid, Mapping):
        raise TypeError(f"grid {grid!r}: keys and their values are accepted, {SUCH_AS}")
    with tempfile.TemporaryDirectory(prefix="alewife-") as scratch:
        directory = Path(scratch) / "sweep" if out is None else Path(out)
        settings = {
            "sweep.grid": {key: _values(key, values) for key, values in grid.items()},
            "sweep.quantities": checked.names(quantities),
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
        table = _table(directory / "sweep.csv")
        warned = np.asarray(table["point"])[np.asarray(table["warnings"]) > 0]
        if len(warned) > 0:
            points = ", ".join(str(int(point)) for point in warned)
            message = f"points that warned, column `warnings`: {points}"
            warnings.warn(message, AlewifeWarning, stacklevel=2)
        return table


def _values(key: str, values: Sequence[Value]) -> list[Value]:
    """The values of a key; TypeError where it is one alone, whose letters or items it would be."""
    is_list = isinstance(values, Iterable) and not isinstance(values, (str, bytes, Mapping))
    if not is_list or (isinstance(values, np.ndarray) and values.ndim == 0):
        raise TypeError(
            f"{key}: {values!r} is one value; a list of values is accepted, {SUCH_AS}; "
            f"one value alone is given by case.set({key!r}, {values!r}), or as [{values!r}]"
        )
    return list(values)


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
