"""Small pictures of many runs, one PNG each, for pages that show them side by side."""

from __future__ import annotations

import os
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from alewife_post import figure, space, style
from alewife_post.read import Run, open_run

WIDTH = 640
"""Pixels: two of them side by side on a page."""
LARGEST_FILE = 60_000
"""Bytes: a page of a hundred pictures stays below 10 MB, with room to spare."""
COLOURS = (256, 128, 64, 48, 32, 24, 16)
"""Fewer colours make smaller files; the first number that is small enough is taken."""


def gallery(runs: Path, out: Path) -> Iterator[tuple[str, Exception | None]]:
    """Write `out/NAME.png` for each run `runs/NAME`; yields names, and what went wrong."""
    found = sorted(path.parent for path in runs.glob("*/case.toml"))
    if not found:
        raise ValueError(f"{runs} holds no directories of runs")
    out.mkdir(parents=True, exist_ok=True)
    for path in found:
        failure = None
        try:
            _write_whole(out / f"{path.name}.png", small_png(default_picture(open_run(path))))
        # One run that cannot be drawn keeps none of the others from it.
        except (OSError, KeyError, ValueError) as error:
            failure = error
        yield path.name, failure


def default_picture(run: Run) -> Figure:
    """The picture of a run that `alewife-post picture` makes without options."""
    return space.slice_picture(run, "speed") if run.is_spatial else figure.picture(run, "speed")


def small_png(drawn: Figure) -> bytes:
    """A PNG of `WIDTH` pixels and at most `LARGEST_FILE` bytes."""
    large = BytesIO()
    drawn.savefig(large, format="png", dpi=style.DPI, bbox_inches="tight", pad_inches=0.08)
    image = Image.open(large).convert("RGB")
    height = round(image.height * WIDTH / image.width)
    image = image.resize((WIDTH, height), Image.Resampling.LANCZOS)
    for colours in COLOURS:
        small = BytesIO()
        image.quantize(colours, dither=Image.Dither.NONE).save(small, format="png", optimize=True)
        if small.tell() <= LARGEST_FILE:
            return small.getvalue()
    raise ValueError(f"the picture takes {small.tell()} bytes, more than {LARGEST_FILE}")


def _write_whole(path: Path, content: bytes) -> None:
    unfinished = path.with_name(f".unfinished-{path.name}")
    unfinished.write_bytes(content)
    os.replace(unfinished, path)  # noqa: PTH105  (atomic)
