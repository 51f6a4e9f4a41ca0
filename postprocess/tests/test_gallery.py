"""Small pictures of many runs."""

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from alewife_post import gallery


def drawn(cells: int) -> Figure:
    figure = Figure(figsize=(6, 4))
    noise = np.random.default_rng(1).random((cells, cells))
    figure.add_subplot().imshow(noise, aspect="auto", interpolation="bilinear")
    return figure


def width(content: bytes) -> int:
    return Image.open(BytesIO(content)).width


def test_a_plain_picture_has_the_full_width() -> None:
    assert width(gallery.small_png(drawn(1))) == gallery.WIDTHS[0]


def test_a_picture_full_of_detail_is_made_smaller() -> None:
    content = gallery.small_png(drawn(100))
    assert len(content) <= gallery.LARGEST_FILE
    assert width(content) < gallery.WIDTHS[0]


def test_a_run_that_cannot_be_drawn_is_named_and_leaves_no_file(tmp_path: Path) -> None:
    broken = tmp_path / "runs" / "broken"
    broken.mkdir(parents=True)
    (broken / "case.toml").write_text("")
    found = list(gallery.gallery(tmp_path / "runs", tmp_path / "out"))
    assert [name for name, _ in found] == ["broken"]
    assert found[0][1] is not None
    assert not list((tmp_path / "out").iterdir())


def test_a_directory_without_runs_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no directories of runs"):
        list(gallery.gallery(tmp_path, tmp_path / "out"))
