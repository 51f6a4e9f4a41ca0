"""Command `report` of `alewife-post`."""

from __future__ import annotations

import argparse
from pathlib import Path

from alewife_post.read import open_run
from alewife_post.whole import replacing


def add_report(parser: argparse.ArgumentParser) -> None:
    """Options of `report`."""
    parser.add_argument("run", type=Path, help="run directory, of a finished run or one under way")
    parser.add_argument("--out", type=Path, help="file; NAME.html if absent")
    parser.add_argument("--time", type=float, help="time of the scene; the last one if absent")


def write_report(options: argparse.Namespace) -> None:
    """One HTML file of a run, without a network: a scene to turn, series, verdicts."""
    from alewife_post import report

    run = open_run(options.run)
    out = options.out or Path(f"{run.path.resolve().name}.html")
    if out.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"{out} is no page by its name: a report is .html")
    write_text(out, report.report(run, options.time))


def write_text(out: Path, text: str) -> None:
    """Write a file, whole or not at all, and say so."""
    if not out.parent.is_dir():
        raise FileNotFoundError(f"there is no directory {out.parent} to write {out.name} into")
    with replacing(out) as unfinished:
        unfinished.write_text(text, encoding="utf-8")
    print(f"wrote {out}")
