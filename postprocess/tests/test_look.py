"""Limits and maps of colours, bands, titles, letters and panels are as they are asked for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alewife_post import Run, cli_look, figure, style
from alewife_post.cli import main


def test_limits_and_maps_of_colours_are_those_asked_for(planar_run: Run) -> None:
    scale = style.Scale((0.0, 9.0), "magma")
    drawn = figure.picture(planar_run, "speed", painter="matplotlib", scale=scale)
    (mesh,) = [one for one in drawn.axes[0].collections if one.get_array() is not None]
    assert mesh.get_clim() == (0.0, 9.0)
    assert mesh.get_cmap().name == "magma"
    assert drawn.axes[1].get_xlim() == (0.0, 9.0) or drawn.axes[1].get_ylim() == (0.0, 9.0)


def test_lines_are_seen_over_light_colours() -> None:
    assert style.line_colour("speed", "viridis") == style.STREAMLINE
    assert style.line_colour("speed", "Greys") == style.STREAMLINE_ON_LIGHT
    assert style.line_colour("pressure", "cividis") == style.STREAMLINE_ON_LIGHT


def test_panels_have_one_scale(planar_run: Run) -> None:
    wanted = [(planar_run, figure.Shown(time=time, lines="none")) for time in (0.0, 4.0)]
    drawn = figure.panels(wanted, "pressure", style.Scale(contours=6))
    first, second, _ = drawn.axes
    assert first.get_title().startswith("(a) ")
    levels = [one.levels for axes in (first, second) for one in axes.collections
              if hasattr(one, "levels")]  # fmt: skip
    assert len(levels) == 2 and len(levels[0]) == 7
    assert np.array_equal(*levels)


def test_titles_go_and_letters_grow(planar_run: Run) -> None:
    from argparse import Namespace

    drawn = figure.picture(planar_run, "speed", lines="none")
    before = drawn.axes[0].xaxis.label.get_fontsize()
    cli_look.finish(drawn, Namespace(no_title=True, font_size=18.0))
    assert drawn.axes[0].get_title() == ""
    assert drawn.axes[0].xaxis.label.get_fontsize() == pytest.approx(2 * before)
    drawn.canvas.draw()
    tick = drawn.axes[0].xaxis.get_major_ticks()[0].label1
    assert tick.get_fontsize() == pytest.approx(16.0)


def test_what_cannot_be_drawn_is_refused_with_the_way_out(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["picture", str(planar_run.path), "--out", str(tmp_path / "a.png")]
    for wrong, said in (
        (["--out", str(tmp_path / "a.eps")], f"{tmp_path / 'a.pdf'} or {tmp_path / 'a.svg'}"),
        (["--limits", "2", "1"], "the lower one comes first"),
        (["--colours", "virids"], "no map of colours virids; nearest: viridis"),
        (["--font-size", "0"], "2 to 40 points"),
        (["--contours", "-3"], "1 to 200"),
        (["--surface"], "alewife-post surface has curves along them"),
    ):
        assert main([*given, *wrong]) == 2
        assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
