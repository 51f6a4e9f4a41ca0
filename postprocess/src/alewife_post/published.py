"""Cases beside what others have published: curves on curves, and values by their differences."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from alewife_post import compare, curves, evidence, gallery, style
from alewife_post.compare import Named
from alewife_post.curves import Curve
from alewife_post.read import Run, open_run, read_case

PUBLISHED = ("measured", "literature")
"""Kinds of references that others have published."""
SEARCHES = ("calibration", "optimisation")
"""Commands of soft cases that find a value, as `of` of a reference names them."""
BEYOND = 1.1
"""A picture ends where this many times the time of the last published point is over."""
FEWEST_POINTS = 3
"""Values of one quantity over time that are shown as points of a curve."""
DATED = re.compile(r"[^;:]*?\b(?:19|20)\d\d\b")
"""A source up to its year."""
LONGEST = 44
"""Letters of a source beside a row."""
LARGEST = 100.0
"""A published value that is less certain (per cent) may be zero, and has no relative difference."""
AROUND = 1.3
"""An axis ends this many times as far out as differences, tolerances and published uncertainties;
the discretisation error may continue beyond it."""


@dataclass(frozen=True)
class Value:
    """A published value and what was computed for it."""

    label: str
    difference: float
    """Computed over published, less one (per cent)."""
    numerical: float
    """Its discretisation error, estimated (per cent); 0 if that is not known."""
    uncertainty: float
    """That of the published value (per cent); 0 if that is not known."""
    tolerance: float
    """Accepted difference (per cent)."""


def pictures(cases: Path, runs: Path, out: Path) -> Iterator[tuple[str, Exception | None]]:
    """Write `out/NAME.png` for each case `cases/NAME` with published curves or values.

    Its runs are `runs/NAME` and `runs/NAME-VARIANT`, as `alewife validate --out` names them. Yields
    names, and what went wrong.
    """
    return gallery.pictures(
        cases, "cases", out, lambda folder: picture(folder, runs) if is_published(folder) else None
    )


def is_published(folder: Path) -> bool:
    """Whether a case has curves, or values of its runs, that others have published."""
    # What a search finds is in no run
    of_runs = (one for one in given_references(folder) if one.get("of") not in SEARCHES)
    kinds = {one.get("kind") for one in of_runs}
    return bool(curves.curves_of(folder)) or not kinds.isdisjoint(PUBLISHED)


def given_references(folder: Path) -> list[dict[str, Any]]:
    """References of a case and its variants as written, in `case.toml` and in its table."""
    case = read_case(folder)
    single = [one for part in (case, *case.get("variant", [])) for one in part.get("reference", [])]
    table = case.get("references", {})
    text = table.get("table", "")
    if "file" in table:
        text = (folder / table["file"]).read_text()
    rows = [line for line in text.splitlines() if line.strip() and line.lstrip()[0] != "#"]
    return single + list(csv.DictReader(rows, skipinitialspace=True))


def picture(folder: Path, runs: Path) -> Figure:
    """The picture of one case: curves where there are any, else its values."""
    members = members_of(folder, runs)
    shipped = curves.curves_of(folder)
    for variant, run in members:
        own = [curve for curve in shipped if curve.variant in (None, variant)]
        drawn = own + points_of(run, variant, {curve.quantity for curve in own})
        if drawn:
            names = list(dict.fromkeys(curve.quantity for curve in drawn))
            last = max(float(curve.time.max()) for curve in drawn)
            window = (0.0, BEYOND * last)
            plain = [replace(curve, variant=None) for curve in drawn]
            return compare.compare_figure([Named("", run)], plain, names, window=window)
    return values_figure(members[0][1], [one for pair in members for one in values_of(*pair)])


def members_of(folder: Path, runs: Path) -> list[tuple[str | None, Run]]:
    """The runs of a case and of its variants that were made, each with the name of its variant."""
    case = read_case(folder)
    variants = [None, *(variant["name"] for variant in case.get("variant", []))]
    places = {
        one: runs / (folder.name if one is None else f"{folder.name}-{one}") for one in variants
    }
    found = [
        (one, open_run(path)) for one, path in places.items() if (path / "series.csv").is_file()
    ]
    if not found:
        raise ValueError(
            f"{runs} holds no run of {folder.name}: alewife validate {folder.name} --out"
        )
    return found


def points_of(run: Run, variant: str | None, known: set[str]) -> list[Curve]:
    """Published values at several times, as curves, but for quantities that have one already."""
    found: dict[tuple[str, str, str], list[tuple[float, float]]] = {}
    for one in evidence.references(run.case):
        if one.kind in PUBLISHED and one.at is not None and one.quantity not in known:
            found.setdefault((one.quantity, one.source, one.kind), []).append((one.at, one.value))
    drawn = []
    for (quantity, source, kind), points in found.items():
        if len(points) >= FEWEST_POINTS:
            time, values = np.array(sorted(points)).T
            drawn.append(Curve(run.path, quantity, source, kind, variant, time, values))
    return drawn


def values_of(variant: str | None, run: Run) -> list[Value]:
    """Published values of a run that were computed and are certainly not zero."""
    found = []
    for one in evidence.comparisons(run):
        if one["kind"] not in PUBLISHED or one["computed"] is None or one["reference"] == 0.0:
            continue
        percent = 100.0 / abs(one["reference"])
        scale = 100.0 if one["is_relative"] else percent
        if scale * (one["uncertainty"] or 0.0) > LARGEST:
            continue
        found.append(
            Value(
                label_of(variant, one),
                percent * (one["computed"] - one["reference"]),
                scale * (one.get("numerical_uncertainty") or 0.0),
                scale * (one["uncertainty"] or 0.0),
                scale * one["tolerance"],
            )
        )
    return found


def label_of(variant: str | None, one: dict[str, Any]) -> str:
    """Variant, quantity and statistic, and below them who published it."""
    quantity = one["quantity"] + (f" - {one['minus']}" if one["minus"] else "")
    statistic = "" if one["statistic"] == "final" else f" ({one['statistic']})"
    at = "" if one["at"] is None else f" at {one['at']:g}"
    return f"{f'{variant}: ' if variant else ''}{quantity}{statistic}{at}\n{who(one['source'])}"


def who(source: str) -> str:
    """The beginning of a source: names and year, or its first clause."""
    found = DATED.match(source)
    clause = found[0] if found else re.split("[;:]", source)[0]
    names = clause.split(", ")
    if found and len(names) > 1:
        clause = f"{names[0]} et al. {clause[-4:]}"
    return clause if len(clause) <= LONGEST else clause[:LONGEST].rpartition(" ")[0] + " ..."


def values_figure(run: Run, values: list[Value]) -> Figure:
    """Each published value as a row: what is accepted, its own uncertainty, the computed one."""
    if not values:
        raise ValueError(f"{run.path} has no comparison.json with a published value")
    style.use()
    figure = Figure(figsize=(6.4, 1.1 + 0.42 * len(values)), layout="constrained")
    axes = figure.subplots()
    rows = np.arange(len(values))
    axes.barh(
        rows, [2 * one.tolerance for one in values], left=[-one.tolerance for one in values],
        height=0.62, color=style.FLUID, label="tolerance",
    )  # fmt: skip
    axes.errorbar(
        np.zeros(len(values)), rows, xerr=[value.uncertainty for value in values], fmt="|", ms=9,
        color=style.REFERENCE, capsize=3, lw=1.0, label="published, with its uncertainty",
    )  # fmt: skip
    axes.errorbar(
        [value.difference for value in values], rows, xerr=[value.numerical for value in values],
        fmt="o", ms=4, color=style.SERIES[0], capsize=2, lw=1.0,
        label="computed, with its discretisation error",
    )  # fmt: skip
    axes.set_yticks(rows, [value.label for value in values])
    axes.invert_yaxis()
    far = max(max(abs(one.difference), one.uncertainty, one.tolerance) for one in values)
    axes.set_xlim(-AROUND * far, AROUND * far)
    axes.set_xlabel("difference from the published value (%)")
    axes.spines[["top", "right", "left"]].set_visible(False)
    figure.suptitle(run.title, fontsize=style.PARAMETERS["axes.titlesize"])
    figure.legend(loc="outside lower center", ncols=2, frameon=False, fontsize=7)
    return figure
