"""Images to a film: H.264 in MP4, or GIF, by the ending of its name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from alewife_post import style
from alewife_post.whole import replacing

Array = np.ndarray
ENDINGS = (".mp4", ".gif")
MISSING = "films in MP4 need imageio-ffmpeg: pip install 'alewife[film]', or write a .gif"


def check(out: Path) -> None:
    """Refuse what cannot be written, before anything is drawn."""
    if out.suffix.lower() not in ENDINGS:
        raise ValueError(f"{out} is no film: its name ends with {' or '.join(ENDINGS)}")
    if not out.parent.is_dir():
        raise FileNotFoundError(f"there is no directory {out.parent}")
    if out.suffix.lower() == ".mp4":
        try:
            import imageio_ffmpeg  # noqa: F401
        except ImportError:
            raise ValueError(MISSING) from None


def write(out: Path, images: Iterable[Array], fps: float) -> int:
    """Write images `(height, width, 3)` of equal, even size, as they come; returns how many.

    The film appears under its name when it is whole.
    """
    with replacing(out) as unfinished:
        if out.suffix.lower() == ".mp4":
            return _write_mp4(unfinished, iter(images), fps)
        return _write_gif(unfinished, iter(images), fps)


def _write_mp4(out: Path, images: Iterator[Array], fps: float) -> int:
    import imageio_ffmpeg

    first = next(images)
    writer = imageio_ffmpeg.write_frames(
        str(out),
        (first.shape[1], first.shape[0]),
        fps=fps,
        codec="libx264",
        pix_fmt_out="yuv420p",
        macro_block_size=2,
        quality=None,
        # The index stands first, so that a film begins before all of it has come.
        output_params=["-crf", "20", "-preset", "medium", "-movflags", "+faststart", "-f", "mp4"],
    )
    writer.send(None)
    n = 0
    try:
        for image in _chained(first, images):
            writer.send(np.ascontiguousarray(image))
            n += 1
    finally:
        writer.close()
    return n


LATER = (style.TRAIL, style.ARROW, style.ROD, style.BODY, *style.SERIES)
"""Colours a film may need though its first frame has none of them."""


COMMON = 32
"""A colour that more pixels have than these weighs no more in a palette."""
REFINEMENTS = 3
"""Passes of k-means over a palette."""


def _colours_of(image: Array) -> Array:
    """An image `(1, n, 3)` of the colours of another.

    One that is at rest at first has little but its bar in colours that all later ones are full of.
    """
    found, counts = np.unique(image.reshape(-1, 3), axis=0, return_counts=True)
    return np.repeat(found, np.minimum(counts, COMMON), axis=0)[None]


def _write_gif(out: Path, images: Iterator[Array], fps: float) -> int:
    from PIL import Image

    start = next(images)
    first = Image.fromarray(start)
    # Colours of the first frame for all: those of each frame would flicker.
    n_own = 255 - len(LATER)
    palette = Image.fromarray(_colours_of(start)).quantize(
        n_own, method=Image.Quantize.MEDIANCUT, kmeans=REFINEMENTS
    )
    # White stays white: what is nearest in a palette is found roughly.
    table = np.array(palette.getpalette(), dtype=int).reshape(-1, 3)[:n_own]
    table[(table >= 244).all(axis=1)] = 255
    table = np.vstack([table, [style.rgb(colour) for colour in LATER]])
    palette = Image.new("P", (1, 1))
    palette.putpalette(table.ravel().tolist())
    n = 1

    def others() -> Iterator[Image.Image]:
        nonlocal n
        for image in images:
            n += 1
            yield Image.fromarray(image).quantize(palette=palette, dither=Image.Dither.NONE)

    # Viewers know hundredths of a second, and slow down what is faster than fifty frames a second.
    hundredths = max(2, round(100.0 / fps))
    first.quantize(palette=palette, dither=Image.Dither.NONE).save(
        out,
        format="GIF",
        save_all=True,
        append_images=others(),
        duration=10 * hundredths,
        loop=0,
        optimize=False,
    )
    return n


def _chained(first: Array, others: Iterator[Array]) -> Iterator[Array]:
    yield first
    yield from others
