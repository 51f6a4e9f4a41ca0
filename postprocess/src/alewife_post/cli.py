"""Commands: `alewife-picture` and `alewife-series`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from alewife_post import figure, space, style
from alewife_post.read import Run, open_run


def picture(arguments: list[str] | None = None) -> int:
    """Write one picture of a run."""
    parser = argparse.ArgumentParser("alewife-picture", description=picture.__doc__)
    _common(parser)
    parser.add_argument(
        "--quantity", choices=figure.QUANTITIES, help="speed, on surfaces pressure, if absent"
    )
    parser.add_argument("--time", type=float, help="time of the frame; the last one if absent")
    parser.add_argument("--view", type=float, nargs=4, metavar=("X0", "X1", "Y0", "Y1"))
    parser.add_argument("--frame", metavar="BODY", help="subtract the velocity of this body")
    parser.add_argument("--lines", choices=("streamlines", "arrows", "none"))
    parser.add_argument("--half", action="store_true", help="one side of the axis only")
    parser.add_argument("--slice", metavar="PLANE", help="plane of a run in space, such as z=0.5")
    parser.add_argument("--surface", action="store_true", help="the bodies of a run in space")
    parser.add_argument(
        "--camera",
        type=float,
        nargs=2,
        default=(-50.0, 20.0),
        metavar=("AZIMUTH", "ELEVATION"),
        help="where bodies are looked at from, degrees about z and above the horizon",
    )
    parser.add_argument("--painter", choices=("auto", "vtk", "matplotlib"), default="auto")
    options = parser.parse_args(arguments)
    return _write(options, lambda run: _picture(run, options))


def _picture(run: Run, options: argparse.Namespace) -> Figure:
    view = options.view and tuple(options.view)
    if not run.is_spatial:
        if options.surface or options.slice:
            raise ValueError("--surface and --slice are for runs in space")
        return figure.picture(
            run,
            options.quantity or "speed",
            time=options.time,
            view=view,
            frame=options.frame,
            lines=options.lines,
            mirror=not options.half,
            painter=options.painter,
        )
    if options.surface:
        quantity = options.quantity or "pressure"
        return space.surface_picture(run, quantity, time=options.time, camera=tuple(options.camera))
    return space.slice_picture(
        run,
        options.quantity or "speed",
        time=options.time,
        plane=options.slice,
        view=view,
        lines=options.lines or "streamlines",
    )


def series(arguments: list[str] | None = None) -> int:
    """Write a figure of quantities over time, with the references of the case."""
    parser = argparse.ArgumentParser("alewife-series", description=series.__doc__)
    _common(parser)
    parser.add_argument("--quantity", action="append", required=True, help="may be given again")
    parser.add_argument("--window", type=float, nargs=2, metavar=("START", "END"))
    options = parser.parse_args(arguments)
    window = options.window and tuple(options.window)
    return _write(options, lambda run: figure.series_figure(run, options.quantity, window=window))


def _common(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run", type=Path, help="run directory")
    parser.add_argument("--out", type=Path, required=True, help="file; its ending says the format")


def _write(options: argparse.Namespace, draw: Callable[[Run], Figure]) -> int:
    try:
        drawn = draw(open_run(options.run))
    except (FileNotFoundError, KeyError, ValueError) as error:
        message = error.args[0] if error.args else error
        print(f"{Path(sys.argv[0]).name}: {message}", file=sys.stderr)
        return 1
    drawn.savefig(options.out, dpi=style.DPI, bbox_inches="tight", pad_inches=0.08)
    return 0
