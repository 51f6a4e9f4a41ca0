#!/usr/bin/env python3
"""Compare two files written by `alewife validate --json`.

    alewife validate --quick --json > before.json
    (change the program, build it)
    alewife validate --quick --json > after.json
    tests/compare_validation.py before.json after.json

Lists every value that differs by more than 1e-9 of itself or of its tolerance, whichever is larger,
and every value that only one of the files has. Other numbers of unknowns are listed as notes: cost
and meshes are no values. Ends with code 1 if any value differs, is missing or additional, with 2 if
a file cannot be read.
"""

import argparse
import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

# What makes a comparison the same one in both files, besides its number among equal ones.
IDENTITY = ("case", "quantity", "minus", "statistic", "at", "level", "of", "reference")

Row = dict[str, Any]
Key = tuple[Any, ...]


class Report(NamedTuple):
    """What two files differ by."""

    failures: list[str]
    notes: list[str]
    n_compared: int


def label(row: Row) -> str:
    """Name a comparison on one line."""
    details = [f"{name} {row[name]}" for name in ("minus", "at", "level", "of") if row.get(name)]
    return f"{row['case']}: {row['quantity']} ({', '.join([row['statistic'], *details])})"


def by_identity(rows: list[Row]) -> dict[Key, Row]:
    """Find comparisons by what they compare; equal ones are counted."""
    seen: Counter[Key] = Counter()
    found: dict[Key, Row] = {}
    for row in rows:
        key = tuple(row.get(name) for name in IDENTITY)
        found[(*key, seen[key])] = row
        seen[key] += 1
    return found


def allowed(row: Row, tolerance: float) -> float:
    """Largest difference from the value of a comparison: a part of it, or of its tolerance."""
    accepted = (row.get("tolerance") or 0.0) * (abs(row["reference"]) if row["is_relative"] else 1)
    return tolerance * max(abs(row["computed"]), accepted)


def difference(before: Row, after: Row, tolerance: float) -> str | None:
    """Say how two values differ; None if they agree."""
    old, new = before["computed"], after["computed"]
    if old is None and new is None:
        return None
    if old is None or new is None:
        return f"{old} -> {new}: {before.get('reason') or after.get('reason')}"
    limit = allowed(before, tolerance)
    # Written so that a value that is not a number differs, too.
    if abs(new - old) <= limit:
        return None
    return f"{old!r} -> {new!r}: differs by {abs(new - old):.2e}, allowed {limit:.2e}"


def compare(before: list[Row], after: list[Row], tolerance: float = 1e-9) -> Report:
    """Compare two lists of comparisons."""
    old, new = by_identity(before), by_identity(after)
    failures, notes = [], []
    for key, row in old.items():
        if key not in new:
            failures.append(f"missing     {label(row)}")
            continue
        if (found := difference(row, new[key], tolerance)) is not None:
            failures.append(f"different   {label(row)}: {found}")
        if row["dofs"] != new[key]["dofs"]:
            notes.append(f"unknowns    {label(row)}: {row['dofs']} -> {new[key]['dofs']}")
    failures += [f"additional  {label(row)}" for key, row in new.items() if key not in old]
    return Report(failures, notes, len(old.keys() & new.keys()))


def main(arguments: list[str] | None = None) -> int:
    """Compare two files; the exit code."""
    parser = argparse.ArgumentParser(
        description=(__doc__ or "").partition("\n")[0],
        epilog="Ends with code 1 if any value differs, is missing or additional.",
    )
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument(
        "--tolerance",
        type=float,
        default=1e-9,
        help="accepted difference over the value, or over its tolerance (default: %(default)s)",
    )
    options = parser.parse_args(arguments)
    try:
        before, after = (json.loads(path.read_text()) for path in (options.before, options.after))
        report = compare(before["comparisons"], after["comparisons"], options.tolerance)
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f"error: not two files of `alewife validate --json`: {error!r}", file=sys.stderr)
        return 2
    for line in report.failures + report.notes:
        print(line)
    print(f"{report.n_compared} values compared, {len(report.failures)} failures")
    return 1 if report.failures else 0


if __name__ == "__main__":
    sys.exit(main())
