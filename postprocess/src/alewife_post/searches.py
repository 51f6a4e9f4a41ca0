"""Finished searches, calibrations and optimisations: what was written of them, their figure."""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post import style
from alewife_post.series import stacked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = np.ndarray

REPORT, JOURNAL = "report.json", "search.journal"
END = "."
"""What ends a line of a journal that was written whole."""


@dataclass(frozen=True)
class Search:
    """A search that has ended."""

    path: Path
    title: str
    report: dict[str, Any]
    """`report.json`."""
    objectives: Array
    """The loss, or what is made large, of each evaluation, `(n,)`."""
    values: Array
    """The numbers at each evaluation, `(n, parameters)`."""

    @property
    def kind(self) -> str:
        """`calibration` or `optimisation`."""
        return str(self.report["search"])

    @property
    def is_large(self) -> bool:
        """Whether its objective is made large."""
        return self.kind == "optimisation"

    @property
    def parameters(self) -> list[dict[str, Any]]:
        """What is said of each number."""
        return list(self.report["parameters"])


def is_search(path: Path) -> bool:
    """Whether a directory is one of a search that has ended."""
    return (path / REPORT).is_file() and (path / JOURNAL).is_file()


def open_search(path: str | Path) -> Search:
    """Open a directory of `alewife calibrate` or `alewife optimise`, of a soft case or a flow."""
    path = Path(path)
    report = json.loads((path / REPORT).read_text(encoding="utf-8"))
    if "search" not in report or "parameters" not in report:
        raise ValueError(f"{path / REPORT} is not the report of a search of this version")
    count = len(report["parameters"])
    _, *lines = (path / JOURNAL).read_text(encoding="utf-8").splitlines()
    rows = [line.split() for line in lines if line.endswith(f" {END}")]
    numbers = np.array([[float(word) for word in row[: 1 + count]] for row in rows])
    numbers = numbers.reshape(-1, 1 + count)
    # What is made large stands in the journal with its sign turned, as it is made small
    sign = -1.0 if report["search"] == "optimisation" else 1.0
    title = path.resolve().name
    if (path / "case.toml").is_file():
        case = tomllib.loads((path / "case.toml").read_text(encoding="utf-8"))
        title = case.get("title", title)
    return Search(path, title, report, sign * numbers[:, 0], numbers[:, 1:])


def warnings(search: Search) -> list[str]:
    """What is to be known before a number is used."""
    found = []
    if search.report.get("ended") != "converged":
        found.append(f"The search has not converged: {search.report.get('ended')}.")
    for one in search.parameters:
        if not one["determined"]:
            found.append(f"{one['name']} is UNDETERMINED: other values serve nearly as well.")
        elif one["value"] in one["bounds"]:
            found.append(f"{one['name']} is at its bound: beyond it the objective may be better.")
    return found


def search_figure(search: Search) -> Figure:
    """The objective over evaluations with the best so far, and each number with its bounds."""
    style.use()
    figure, rows = stacked(1 + len(search.parameters), search.title)
    number = np.arange(1, len(search.objectives) + 1)
    found = search.objectives
    best = np.maximum.accumulate(found) if search.is_large else np.minimum.accumulate(found)
    rows[0].plot(number, found, "o", ms=3.5, color=style.REFERENCE, label="evaluations")
    rows[0].plot(number, best, color=style.SERIES[0], label="best so far")
    rows[0].set_ylabel("objective" if search.is_large else "loss")
    if (found > 0.0).all() and found.max() > 100.0 * found.min():
        rows[0].set_yscale("log")
    rows[0].legend(loc="best", fontsize="small")
    for axes, one, values in zip(rows[1:], search.parameters, search.values.T, strict=True):
        axes.plot(number, values, "o-", ms=3.5, lw=1.0, color=style.SERIES[0])
        for bound in one["bounds"]:
            axes.axhline(bound, color=style.BOUNDARY, lw=0.8, ls="--")
        low, high = one["bounds"]
        if one.get("scale") is None and low > 0.0 and high > 20.0 * low:
            axes.set_yscale("log")
        axes.set_ylabel(one["name"])
    rows[-1].set_xlabel("evaluation")
    return figure
