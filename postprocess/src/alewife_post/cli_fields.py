"""Commands of `alewife-post` on fields: report, line, section, decay, fields, trace."""

from __future__ import annotations

import argparse
import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from alewife_post import cli_look
from alewife_post.cli_series import plain, save
from alewife_post.read import Run, open_run
from alewife_post.whole import replacing

if TYPE_CHECKING:
    import numpy as np

    Columns = Mapping[str, np.ndarray]

DRAWN = (".png", ".pdf", ".svg")
"""Endings of figures; `.csv` is a table."""


def add_report(parser: argparse.ArgumentParser) -> None:
    """Options of `report`."""
    parser.add_argument("run", type=Path, help="directory of a run, or of a finished search")
    parser.add_argument("--out", type=Path, help="file; NAME.html if absent")
    parser.add_argument("--time", type=float, help="time of the scene; the last one if absent")


def write_report(options: argparse.Namespace) -> None:
    """One HTML file of a run or a search, without a network: a scene to turn, series, verdicts."""
    from alewife_post import report

    out = options.out or Path(f"{options.run.resolve().name}.html")
    if out.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"{out} is no page by its name: a report is .html")
    write_text(out, report.report_of(options.run, options.time))


# ---- Numbers of a flow ---------------------------------------------------------------------------


def add_line(parser: argparse.ArgumentParser) -> None:
    """Options of `line`."""
    add_run_and_time(parser)
    for name, what in (("from", "first"), ("to", "last")):
        parser.add_argument(
            f"--{name}", type=float, nargs="+", required=True, dest=what, metavar="X",
            help=f"coordinates of the {what} point",
        )  # fmt: skip
    parser.add_argument("--points", type=int, default=201, metavar="N", help="%(default)s")
    parser.add_argument("--frame", metavar="BODY", help="subtract the velocity of this body")
    parser.add_argument(
        "--out", type=Path, help="a table (.csv) or a figure (.png, .pdf, .svg); NAME-line.csv"
    )
    cli_look.add_letters(parser)


def write_line(options: argparse.Namespace) -> None:
    """Velocity, pressure and vorticity along a straight line, as a table or a figure."""
    from alewife_post import measures

    run = run_at(options)
    columns = measures.line(
        run, options.first, options.last,
        points=options.points, time=options.time, frame=options.frame,
    )  # fmt: skip
    _write(run, options, options.out or Path(f"{run.path.resolve().name}-line.csv"), columns)


def add_section(parser: argparse.ArgumentParser) -> None:
    """Options of `section`."""
    add_run_and_time(parser)
    parser.add_argument(
        "plane", nargs="+", metavar="PLANE", help="such as x=0.5; several have a row each"
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def write_section(options: argparse.Namespace) -> None:
    """Flux, area and mean pressure of sections across the fluid."""
    from alewife_post import fields, measures, planes
    from alewife_post.cli_series import as_text

    run = run_at(options)
    wanted = [planes.parsed_axis(text) for text in options.plane]
    flow = fields.settled(run, run.field(options.time))
    rows = [
        {"section": f"{planes.AXES[axis]} = {height:g}"}
        | measures.section_of(run, flow, axis, height)
        for axis, height in wanted
    ]
    print(json.dumps(plain(rows), indent=2) if options.json else as_text(rows))


def add_decay(parser: argparse.ArgumentParser) -> None:
    """Options of `decay`."""
    add_run_and_time(parser)
    parser.add_argument("--body", metavar="NAME", help="body or swimmer; all of them if absent")
    parser.add_argument("--from", type=float, dest="nearest", metavar="R", help="first distance")
    parser.add_argument("--to", type=float, dest="farthest", metavar="R", help="last distance")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--out", type=Path, help="a table (.csv) or a figure (.png, .pdf, .svg)")
    cli_look.add_letters(parser)


def write_decay(options: argparse.Namespace) -> None:
    """The power of the distance with which the speed decays far from bodies."""
    from alewife_post import measures
    from alewife_post.cli_series import as_text

    run = run_at(options)
    found = measures.decay(
        run, around=options.body, nearest=options.nearest, farthest=options.farthest,
        time=options.time,
    )  # fmt: skip
    row = {
        "exponent": found.exponent,
        "coefficient": found.coefficient,
        "misfit": found.misfit,
        "from": float(found.distance[0]),
        "to": float(found.distance[-1]),
    }
    print(json.dumps(plain(row), indent=2) if options.json else as_text([row]))
    if options.out:
        fit = found.coefficient * found.distance**found.exponent
        columns = {"distance": found.distance, "speed": found.speed, "fit": fit}
        _write(run, options, options.out, columns)


def add_run_and_time(parser: argparse.ArgumentParser) -> None:
    """The run, and the time of one of its frames."""
    parser.add_argument("run", type=Path, help="run directory")
    parser.add_argument("--time", type=float, help="time of the frame; the last one if absent")


def run_at(options: argparse.Namespace) -> Run:
    """The run, which is to have the time asked for."""
    run = open_run(options.run)
    if options.time is not None:
        run.check_time(options.time)
    return run


def _write(run: Run, options: argparse.Namespace, out: Path, columns: Columns) -> None:
    """Columns as a table or as a figure, by the ending of the file."""
    if out.suffix.lower() in DRAWN:
        from alewife_post import profiles

        time = run.frame(options.time).time
        save(cli_look.finish(profiles.profile_figure(run, columns, time), options), out)
    elif out.suffix.lower() == ".csv":
        write_text(out, table(columns))
    else:
        cli_look.check_ending(out)
        raise ValueError(f"{out}: a table (.csv) or a figure ({', '.join(DRAWN)}) is written")


def table(columns: Columns) -> str:
    """Columns as CSV; blank where there is no value."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(columns)
    for row in zip(*columns.values(), strict=True):
        rows.writerow("" if value != value else f"{value:.10g}" for value in row)
    return text.getvalue()


# ---- Derived fields ------------------------------------------------------------------------------


def add_fields(parser: argparse.ArgumentParser) -> None:
    """Options of `fields`."""
    add_run_and_time(parser)
    parser.add_argument(
        "--out", type=Path, help="directory of two VTU files; NAME-fields if absent"
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def write_fields(options: argparse.Namespace) -> None:
    """Vorticity, strain rate, Q, stream function as VTU, and tractions on surfaces."""
    from alewife_post import exports
    from alewife_post.cli_series import as_text

    run = run_at(options)
    out = options.out or Path(f"{run.path.resolve().name}-fields")
    found = exports.write_fields(run, options.time, out)
    if options.json:
        # `body` is what `surface` was called when there were bodies alone
        rows = [{"body": row["surface"], **row} for row in found.rows]
        print(json.dumps(plain(rows), indent=2))
        return
    if found.rows:
        print(as_text(found.rows))
    for path in found.paths:
        print(f"wrote {path}")


# ---- Particles -----------------------------------------------------------------------------------


def add_trace(parser: argparse.ArgumentParser) -> None:
    """Options of `trace`."""
    parser.add_argument("run", type=Path, help="run directory")
    parser.add_argument(
        "--seed", required=True, metavar="PLACES",
        help="box=x0,x1,y0,y1 or line=x0,y0,x1,y1 (in space with z), or a CSV file with x, y (, z)",
    )  # fmt: skip
    parser.add_argument("--count", type=int, default=100, metavar="N", help="%(default)s")
    parser.add_argument(
        "--from", type=float, dest="start", metavar="T", help="first file if absent"
    )
    parser.add_argument(
        "--to", type=float, dest="end", metavar="T", help="last file if absent; may be earlier"
    )
    parser.add_argument(
        "--release", type=float, metavar="DT", help="again so much time apart: streak lines"
    )
    parser.add_argument("--outputs", type=int, default=100, metavar="N", help="%(default)s")
    parser.add_argument("--step", type=float, metavar="DT", help="a quarter of a cell if absent")
    parser.add_argument("--out", type=Path, help="directory; NAME-paths if absent")


def write_trace(options: argparse.Namespace) -> None:
    """Particles that the stored flow carries: paths, residence, stretching."""
    from alewife_post import carried, tracers

    run = open_run(options.run)
    first, last = run.frame(run.fields[0].time if run.fields else None).time, run.frame().time
    start = first if options.start is None else options.start
    end = last if options.end is None else options.end
    if run.is_unsteady:
        for time in (start, end):
            run.check_time(time)
    if start == end:
        raise ValueError(f"particles begin and end at t = {start:g}: --to says how long they go")
    if options.outputs < 1 or options.count < 1 or (options.release or 1.0) <= 0.0:
        raise ValueError("--outputs and --count are 1 at least, --release is positive")
    seeds = carried.seeds(options.seed, options.count, 3 if run.is_spatial else 2)
    seeds = carried.in_fluid(run, seeds, start)
    found = carried.carried(
        run, seeds, start=start, end=end, outputs=options.outputs, step=options.step,
        release=options.release,
    )  # fmt: skip
    out = options.out or Path(f"{run.path.resolve().name}-paths")
    left = int((found.left == found.left).sum())
    print(f"{len(found.seed)} particles, t = {start:g} to {end:g}; {left} left the fluid")
    for path in tracers.write_paths(run, found, out):
        print(f"wrote {path}")


# ---- Files ---------------------------------------------------------------------------------------


def write_text(out: Path, text: str) -> None:
    """Write a file, whole or not at all, and say so."""
    if not out.parent.is_dir():
        raise FileNotFoundError(f"there is no directory {out.parent} to write {out.name} into")
    with replacing(out) as unfinished:
        unfinished.write_text(text, encoding="utf-8")
    print(f"wrote {out}")
