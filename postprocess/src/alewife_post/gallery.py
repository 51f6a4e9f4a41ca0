"""Small pictures of many runs, one PNG each, for pages that show them side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from alewife_post import figure, soft, stills, style
from alewife_post.read import Run, open_run
from alewife_post.whole import replacing

WIDTHS = (640, 560, 480, 400, 320)
"""Pixels, two of them side by side on a page; the first that makes a small enough file is taken."""
LARGEST_FILE = 60_000
"""Bytes: a page of a hundred pictures stays below 10 MB, with room to spare."""
COLOURS = 256
"""As many as a palette has: with fewer of them a smooth field falls into bands."""
REFINEMENTS = 3
"""Passes of k-means over the palette; further ones change no shade that can be seen."""


def gallery(runs: Path, out: Path) -> Iterator[tuple[str, Exception | None]]:
    """Write `out/NAME.png` for each run `runs/NAME`; yields names, and what went wrong."""
    return pictures(runs, "runs", out, lambda path: default_picture(open_run(path)))


def pictures(
    place: Path, what: str, out: Path, draw: Callable[[Path], Figure | None]
) -> Iterator[tuple[str, Exception | None]]:
    """Write `out/NAME.png` for each folder of `place` with a case that `draw` gives a figure of."""
    found = sorted(path.parent for path in place.glob("*/case.toml"))
    if not found:
        raise ValueError(f"{place} holds no directories of {what}")
    out.mkdir(parents=True, exist_ok=True)
    for path in found:
        failure = None
        try:
            drawn = draw(path)
            if drawn is None:
                continue
            content = small_png(drawn)
            with replacing(out / f"{path.name}.png") as unfinished:
                unfinished.write_bytes(content)
        # One run that cannot be drawn keeps none of the others from it.
        except (OSError, KeyError, ValueError) as error:
            failure = error
        yield path.name, failure


def default_picture(run: Run) -> Figure:
    """The scene of a run in space, of any other a picture in the plane; of a soft case its body.

    It shows the first scalar, for whose sake a case has it, or the speed.
    """
    if soft.is_soft(run):
        return soft.picture(run)
    shown = next(iter(run.scalars), "speed")
    if run.is_spatial:
        return stills.scene_picture(run, quantity=shown)
    return figure.picture(run, shown)


def small_png(drawn: Figure) -> bytes:
    """A PNG of at most `WIDTHS[0]` pixels from left to right and `LARGEST_FILE` bytes."""
    large = BytesIO()
    drawn.savefig(large, format="png", dpi=style.DPI, bbox_inches="tight", pad_inches=0.08)
    image = Image.open(large).convert("RGB")
    for width in WIDTHS:
        size = (width, max(1, round(image.height * width / image.width)))
        resized = image.resize(size, Image.Resampling.LANCZOS)
        palette = resized.quantize(COLOURS, kmeans=REFINEMENTS, dither=Image.Dither.NONE)
        small = BytesIO()
        palette.save(small, format="png", optimize=True)
        if small.tell() <= LARGEST_FILE:
            return small.getvalue()
    raise ValueError(f"the picture takes {small.tell()} bytes, more than {LARGEST_FILE}")
