"""Options of figures: limits and maps of colours, bands, titles, size of letters."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from alewife_post.style import Scale

TITLE = "title"
"""Mark of a text that is the title of a figure."""


def add_colours(parser: argparse.ArgumentParser, *, has_contours: bool) -> None:
    """Options of colours."""
    parser.add_argument(
        "--limits", type=float, nargs=2, metavar=("LOW", "HIGH"),
        help="of the colours, the same for several pictures; by the values if absent",
    )  # fmt: skip
    parser.add_argument("--colours", metavar="MAP", help="map of colours of matplotlib: magma")
    if has_contours:
        parser.add_argument(
            "--contours", type=int, default=0, metavar="N",
            help="N bands of one colour each: areas, not an image, in PDF and SVG",
        )  # fmt: skip


def scale(options: argparse.Namespace) -> Scale:
    """The colours that are asked for."""
    import matplotlib

    from alewife_post import asked, style

    limits = options.limits and tuple(options.limits)
    if limits and not (limits[0] < limits[1] and all(map(math.isfinite, limits))):
        raise ValueError(f"--limits {limits[0]:g} {limits[1]:g}: the lower one comes first")
    if options.colours and options.colours not in matplotlib.colormaps:
        raise asked.UnknownNameError(
            asked.unknown("map of colours", options.colours, matplotlib.colormaps)
        )
    contours = getattr(options, "contours", 0)
    if contours < 0 or contours > 200:
        raise ValueError(f"--contours {contours}: 1 to 200 bands can be told apart")
    return style.Scale(limits, options.colours, contours)


def add_letters(parser: argparse.ArgumentParser) -> None:
    """Options of titles and letters."""
    parser.add_argument("--no-title", action="store_true", help="leave out the title")
    parser.add_argument(
        "--font-size", type=float, metavar="POINTS", help="of labels; all others go with it (9)"
    )


def finish(figure: Figure, options: argparse.Namespace) -> Figure:
    """A figure with the letters that are asked for."""
    from matplotlib.text import Text

    from alewife_post import style

    if getattr(options, "no_title", False):
        figure.suptitle("")
        for axes in figure.axes:
            axes.set_title("")
        for text in figure.texts:
            if text.get_gid() == TITLE:
                text.set_text("")
    size = getattr(options, "font_size", None)
    if size is not None:
        if not 2.0 <= size <= 40.0:
            raise ValueError(f"--font-size {size:g}: 2 to 40 points can be read")
        share = size / style.PARAMETERS["font.size"]
        for axes in figure.axes:
            axes.tick_params(labelsize=share * style.PARAMETERS["xtick.labelsize"])
        ticks = {
            id(label)
            for axes in figure.axes
            for axis in (axes.xaxis, axes.yaxis)
            for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks())
            for label in (tick.label1, tick.label2)
        }
        for text in figure.findobj(Text):
            if id(text) not in ticks:
                text.set_fontsize(share * text.get_fontsize())
    return figure


VECTORS = (".eps", ".ps")


def check_ending(out: Path) -> None:
    """ValueError where a figure would be written in a format that cannot show it."""
    if out.suffix.lower() in VECTORS:
        instead = " or ".join(str(out.with_suffix(end)) for end in (".pdf", ".svg"))
        raise ValueError(
            f"{out}: PostScript has no transparency, which figures need: write {instead} (pdftops "
            "-eps of Poppler makes an EPS of the former)"
        )
