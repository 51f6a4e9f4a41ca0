"""Commands: `alewife-picture` and `alewife-series`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from alewife_post import figure, style
from alewife_post.read import Run, open_run


def picture(arguments: list[str] | None = None) -> int:
    """Write one picture of a run."""
    parser = argparse.ArgumentParser("alewife-picture", description=picture.__doc__)
    _common(parser)
    parser.add_argument("--quantity", choices=figure.QUANTITIES, default="speed")
    parser.add_argument("--time", type=float, help="time of the frame; the last one if absent")
    parser.add_argument("--view", type=float, nargs=4, metavar=("X0", "X1", "Y0", "Y1"))
    parser.add_argument("--frame", metavar="BODY", help="subtract the velocity of this body")
    parser.add_argument("--lines", choices=("streamlines", "arrows", "none"))
    parser.add_argument("--half", action="store_true", help="one side of the axis only")
    parser.add_argument("--painter", choices=("auto", "vtk", "matplotlib"), default="auto")
    options = parser.parse_args(arguments)
    return _write(
        options,
        lambda run: figure.picture(
            run,
            options.quantity,
            time=options.time,
            view=options.view and tuple(options.view),
            frame=options.frame,
            lines=options.lines,
            mirror=not options.half,
            painter=options.painter,
        ),
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
