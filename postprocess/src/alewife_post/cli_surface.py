"""Command `surface` of `alewife-post`: what acts on bodies and sides, as tables and curves."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from alewife_post import cli_look
from alewife_post.cli_fields import DRAWN, add_run_and_time, run_at, table, write_text
from alewife_post.cli_series import as_text, plain, save
from alewife_post.read import Field, Run

if TYPE_CHECKING:
    from alewife_post.traction import Surface

QUANTITIES = ("wall-shear", "shear", "traction", "pressure")


def add_surface(parser: argparse.ArgumentParser) -> None:
    """Options of `surface`."""
    add_run_and_time(parser)
    parser.add_argument(
        "--on", action="append", default=[], metavar="NAME",
        help="a side or a body; may be given again; without --out all of them if absent",
    )  # fmt: skip
    parser.add_argument(
        "--quantity", action="append", default=[], choices=QUANTITIES,
        help="of a figure, a panel each: magnitude of the wall shear stress, its part along the "
        "way, magnitude of the traction; wall-shear and pressure if absent",
    )  # fmt: skip
    parser.add_argument(
        "--slice", metavar="PLANE", help="in space: along the curve in which z=0.5 cuts it"
    )
    parser.add_argument(
        "--camera", type=float, nargs=2, metavar=("AZIMUTH", "ELEVATION"),
        help="of a figure in space without --slice",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument(
        "--out", type=Path,
        help="a table (.csv) or a figure (.png, .pdf, .svg) over arc length; in space without "
        "--slice a table of nodes, or the surface in colours",
    )  # fmt: skip
    cli_look.add_letters(parser)


def write_surface(options: argparse.Namespace) -> None:
    """Wall shear, traction and pressure along a side or around a body, as a table or a figure."""
    from alewife_post import exports, traction

    run = run_at(options)
    if options.slice and not run.is_spatial:
        raise ValueError("--slice is for runs in space: in the plane a side is a curve already")
    field = run.field(options.time)
    every = traction.surfaces_of(run, field)
    found = traction.chosen(run, every, options.on) if options.on else every
    if options.json or not options.out:
        rows = [exports.row(run, field, one) for one in found]
        print(json.dumps(plain(rows), indent=2) if options.json else as_text(rows))
    if not options.out:
        return
    if not options.on and len(every) > 1:
        known = ", ".join(one.facets.name for one in every)
        raise ValueError(f"--on says which side or body is written: {known}")
    kind = options.out.suffix.lower()
    if kind == ".csv":
        if len(found) > 1:
            raise ValueError("a table is of one side or body: give --on once, or draw a figure")
        (columns,) = _columns(run, field, found, options).values()
        write_text(options.out, table(columns))
    elif kind in DRAWN:
        _draw(run, field, found, options)
    else:
        cli_look.check_ending(options.out)
        raise ValueError(
            f"{options.out}: a table (.csv) or a figure ({', '.join(DRAWN)}) is written"
        )


def _columns(
    run: Run, field: Field, found: list[Surface], options: argparse.Namespace
) -> dict[str, dict]:
    from alewife_post import planes, skins

    if not run.is_spatial:
        return {one.facets.name: skins.curve(field, one) for one in found}
    if options.slice:
        plane = planes.parsed(options.slice)
        return {one.facets.name: skins.cut(field, one, plane) for one in found}
    return {one.facets.name: skins.nodes(field, one) for one in found}


def _draw(run: Run, field: Field, found: list[Surface], options: argparse.Namespace) -> None:
    from alewife_post import profiles, scene, space

    is_curve = not run.is_spatial or options.slice
    wanted = options.quantity or (["wall-shear", "pressure"] if is_curve else ["wall-shear"])
    if run.is_spatial and "shear" in wanted:
        raise ValueError("shear along the way is of curves in the plane: in space draw wall-shear")
    if is_curve:
        if options.camera:
            raise ValueError("--camera is for surfaces in space without --slice")
        curves = _columns(run, field, found, options)
        drawn = profiles.surface_figure(run, curves, wanted, field.time)
    else:
        if len(wanted) > 1:
            raise ValueError("a surface in space has the colours of one --quantity")
        drawn = space.surface_picture(
            run, wanted[0], time=options.time, on=options.on or [found[0].facets.name],
            camera=tuple(options.camera or scene.CAMERA),
        )  # fmt: skip
    save(cli_look.finish(drawn, options), options.out)
