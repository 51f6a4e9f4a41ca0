"""A page of a film: a picture with its title, its time and a bar of colours, always of one size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from alewife_post import style
from alewife_post.drawing import colour_bar

Array = np.ndarray

DPI = 100
SIZE = (960, 720)
"""Pixels from left to right and from top to bottom, at most unless others are asked for."""
MARGINS = (0.65, 0.15, 0.5, 0.38)
"""Left, right, below and above a picture in the plane (inches)."""
WIDE = 2.0
"""Width over height from which on the bar of colours lies below."""


@dataclass(frozen=True)
class Bar:
    """A bar of colours."""

    colour_map: str
    limits: style.Limits
    values: Array
    """What is drawn, or its extremes: the bar has a tip where they are beyond its limits."""
    label: str
    alpha: float = 1.0


def fitting(aspect: float | None, has_bar: bool) -> tuple[int, int]:
    """Even pixels of a frame around a picture of some width over height."""
    if not aspect:
        return SIZE
    left, right, bottom, top = MARGINS
    beside, below = ((0.0, 0.6) if aspect > WIDE else (1.0, 0.0)) if has_bar else (0.0, 0.0)
    room = np.array([left + right + beside, bottom + top + below])
    across = min(SIZE[0] / DPI - room[0], (SIZE[1] / DPI - room[1]) * aspect)
    inches = np.array([across, across / aspect]) + room
    width, height = (2 * round(0.5 * DPI * side) for side in np.maximum(inches, 2.4))
    return width, height


class Page:
    """A figure of fixed size whose axes are drawn again for each frame."""

    def __init__(
        self, size: tuple[int, int] | None, title: str, aspect: float | None, bar: Bar | None
    ) -> None:
        """`aspect` is width over height of the picture."""
        width, height = (pixels / DPI for pixels in size or fitting(aspect, bar is not None))
        self.figure = Figure(figsize=(width, height), dpi=DPI)
        self.canvas = FigureCanvasAgg(self.figure)
        left, right, bottom, top = MARGINS if aspect else (0.05, 0.05, 0.05, MARGINS[3])
        is_wide = bool(aspect) and aspect > WIDE
        room = np.zeros(2) if bar is None else np.array([0.0, 0.6] if is_wide else [1.0, 0.0])
        box = np.array([left, bottom + room[1], width - left - right - room[0], 0.0])
        box[3] = height - top - box[1]
        if aspect:
            # As large as the room allows, in the middle of it.
            fit = np.array([min(box[2], box[3] * aspect), min(box[3], box[2] / aspect)])
            box = np.array([*(box[:2] + 0.5 * (box[2:] - fit)), *fit])
        scale = np.array([width, height, width, height])
        self.axes: Axes = self.figure.add_axes(box / scale)
        self.pixels = tuple(int(side) for side in np.round(box[2:] * DPI))
        if bar is not None:
            self._add_bar(box, scale, is_wide, bar)
        self._add_title(title, width)
        self.stamp = self.axes.text(
            0.012, 0.985, "", transform=self.axes.transAxes, ha="left", va="top", zorder=20
        )
        self.stamp.set_bbox({"facecolor": "white", "alpha": 0.8, "lw": 0, "boxstyle": "round"})

    def _add_bar(self, box: Array, scale: Array, is_wide: bool, bar: Bar) -> None:
        if is_wide:
            place = [box[0] + 0.2 * box[2], box[1] - 0.62, 0.6 * box[2], 0.1]
        else:
            place = [box[0] + box[2] + 0.12, box[1] + 0.1 * box[3], 0.13, 0.8 * box[3]]
        axes = self.figure.add_axes(np.array(place) / scale)
        drawn = colour_bar(
            self.axes, bar.values, bar.colour_map, bar.limits, cax=axes, alpha=bar.alpha
        )
        drawn.set_label(bar.label)

    def _add_title(self, title: str, width: float) -> None:
        text = self.figure.text(
            0.5, 0.985, title, ha="center", va="top", fontsize=10.0, gid="title"
        )
        renderer = self.canvas.get_renderer()
        wide = text.get_window_extent(renderer).width / DPI
        text.set_fontsize(max(6.0, 10.0 * min(1.0, 0.96 * width / wide)))

    def clear(self) -> None:
        """Remove what the last frame has drawn."""
        for found in (
            self.axes.images,
            self.axes.collections,
            self.axes.patches,
            self.axes.lines,
        ):
            for artist in list(found):
                artist.remove()

    def clear_images(self) -> None:
        """Remove the images alone."""
        for artist in list(self.axes.images):
            artist.remove()

    def image(self, stamp: str) -> Array:
        """The pixels `(height, width, 3)`."""
        self.stamp.set_text(stamp)
        self.canvas.draw()
        return np.asarray(self.canvas.buffer_rgba())[..., :3].copy()
