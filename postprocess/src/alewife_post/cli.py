"""The command `alewife-post` and its older names; its commands `picture` and `film`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from alewife_post import (
    cli_calibration,
    cli_fields,
    cli_look,
    cli_picture,
    cli_series,
    cli_surface,
    packages,
)
from alewife_post.read import open_run

if TYPE_CHECKING:
    pass

FAILURES = (OSError, KeyError, ValueError, ImportError)


def main(arguments: list[str] | None = None) -> int:
    """Pictures, films, curves and summaries of runs of alewife."""
    arguments = sys.argv[1:] if arguments is None else arguments
    parser = argparse.ArgumentParser("alewife-post", description=main.__doc__)
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    try:
        for name, add, run in (
            ("picture", cli_picture.add_picture, cli_picture.write_picture),
            ("film", _add_film, _write_film),
            ("plot", cli_series.add_plot, cli_series.write_plot),
            ("compare", cli_series.add_compare, cli_series.write_comparison),
            ("inspect", cli_series.add_inspect, cli_series.write_summary),
            ("calibration", cli_calibration.add_calibration, cli_calibration.write_calibration),
            ("report", cli_fields.add_report, cli_fields.write_report),
            ("line", cli_fields.add_line, cli_fields.write_line),
            ("section", cli_fields.add_section, cli_fields.write_section),
            ("decay", cli_fields.add_decay, cli_fields.write_decay),
            ("surface", cli_surface.add_surface, cli_surface.write_surface),
            ("fields", cli_fields.add_fields, cli_fields.write_fields),
            ("trace", cli_fields.add_trace, cli_fields.write_trace),
            ("gallery", _add_gallery, _write_gallery),
            ("convert", _add_convert, _convert),
            ("series", cli_series.add_plot, cli_series.write_plot),
        ):
            doc = run.__doc__ if name != "series" else "`plot` by its older name."
            summary = (doc or "").removesuffix(".").replace("`", "")
            command = commands.add_parser(name, help=summary, description=doc)
            if arguments[:1] == [name]:
                # What the others need may not be installed.
                add(command)
                command.set_defaults(write=run)
        options, behind = parser.parse_known_args(arguments)
        if behind and (not hasattr(options, "names") or any(one.startswith("-") for one in behind)):
            parser.error(f"unrecognized arguments: {' '.join(behind)}")
        if behind:
            # Quantities may stand behind options, which argparse alone does not know.
            options.names += behind
        return options.write(options) or 0
    except FAILURES as error:
        print(f"alewife-post: {message(error)}", file=sys.stderr)
        return 2


def message(error: BaseException) -> str:
    """One line for a reader."""
    if isinstance(error, ModuleNotFoundError):
        return packages.missing(error.name or str(error))
    # A KeyError shows its message in quotes; errors of the system have theirs in no argument.
    is_plain = isinstance(error, KeyError) and error.args
    return " ".join(str(error.args[0] if is_plain else error).split())


def picture(arguments: list[str] | None = None) -> int:
    """`alewife-post picture` by its older name."""
    return main(["picture", *(sys.argv[1:] if arguments is None else arguments)])


def series(arguments: list[str] | None = None) -> int:
    """`alewife-post plot` by its older name."""
    return main(["plot", *(sys.argv[1:] if arguments is None else arguments)])


def film_command(arguments: list[str] | None = None) -> int:
    """`alewife-post film` in one word."""
    return main(["film", *(sys.argv[1:] if arguments is None else arguments)])


# ---- Galleries -----------------------------------------------------------------------------------


def _add_gallery(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("out", type=Path, metavar="OUT", help="directory of the pictures")
    parser.add_argument(
        "--from", type=Path, default=Path("runs"), dest="runs", metavar="DIR", help="%(default)s"
    )
    parser.add_argument(
        "--published",
        type=Path,
        metavar="CASES",
        help="of each case in this directory with published curves or values: its runs beside them",
    )


def _write_gallery(options: argparse.Namespace) -> int:
    """A small picture of each run in a directory, or of each case beside what is published."""
    from alewife_post import gallery, published

    failures = 0
    if options.published is None:
        drawn = gallery.gallery(options.runs, options.out)
    else:
        drawn = published.pictures(options.published, options.runs, options.out)
    for name, failure in drawn:
        if failure is not None:
            failures += 1
            print(f"alewife-post: {name}: {failure}", file=sys.stderr)
    return int(failures > 0)


# ---- Meshes --------------------------------------------------------------------------------------


def _add_convert(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("source", type=Path, metavar="IN", help="MED, VTU, XDMF, INP, ...")
    parser.add_argument("target", type=Path, metavar="OUT", help="the new file, such as mesh.msh")


def _convert(options: argparse.Namespace) -> None:
    """A mesh of another program as a file of Gmsh, for `domain.mesh`."""
    from alewife_post import convert

    for note in convert.convert(options.source, options.target):
        print(note)
    print(f"written to {options.target}")


# ---- Films ---------------------------------------------------------------------------------------


def _add_film(parser: argparse.ArgumentParser) -> None:
    from alewife_post import film

    cli_picture.add_run(parser)
    cli_picture.add_look(parser, film.QUANTITIES)
    parser.add_argument(
        "--window", type=float, nargs=2, metavar=("START", "END"), help="first and last time"
    )
    parser.add_argument(
        "--frames",
        type=int,
        default=film.MOST_FRAMES,
        metavar="N",
        help="at most so many, evenly over time (%(default)s)",
    )
    parser.add_argument("--fps", type=float, help="frames a second; up to 25 if absent")
    parser.add_argument(
        "--size", type=_size, metavar="WxH", help="pixels, such as 1280x720; by the view if absent"
    )
    parser.add_argument(
        "--lines",
        choices=("streamlines", "arrows", "none"),
        default="none",
        help="in the plane",
    )
    cli_picture.add_particles(parser)
    cli_look.add_colours(parser, has_contours=False)
    parser.add_argument("--no-trails", action="store_true", help="leave out the ways of centres")


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"{text} is no size: write one such as 1280x720")
    return int(width), int(height)


def _write_film(options: argparse.Namespace) -> None:
    """A film of a run, finished or under way: MP4 or GIF."""
    from alewife_post import film

    run = open_run(options.run)
    if run.is_spatial:
        for name, is_given in (
            ("--view", options.view is not None),
            ("--lines", options.lines != "none"),
            ("--half", options.half),
        ):
            if is_given:
                raise ValueError(f"{name} is for films of runs in the plane")
    else:
        cli_picture.refuse_in_the_plane(options)
    request = film.Request(
        quantity=options.quantity,
        follow=options.follow,
        view=options.view and tuple(options.view),
        window=options.window and tuple(options.window),
        frames=options.frames,
        fps=options.fps,
        size=options.size,
        lines=options.lines,
        trails=not options.no_trails,
        mirror=not options.half,
        painter=options.painter,
        plane=options.slice,
        surface=options.surface,
        iso=options.iso,
        camera=options.camera and tuple(options.camera),
        particles=options.particles,
        scale=cli_look.scale(options),
    )
    film.film(run, options.out, request)
