"""Scenes as figures: sides, streamlines, names, colours that a gap does not wash out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import meshes
import numpy as np
import pytest
from conftest import CAN_RENDER, block, ring
from test_space import run as spatial_run

from alewife_post import Run, gallery, recovered, scenery, stills, streams, style, walls
from alewife_post.cli import main
from alewife_post.read import Field
from alewife_post.request import Moment

pytestmark = pytest.mark.skipif(not CAN_RENDER, reason="VTK can have no window here")
run = spatial_run


def flow(nodes: np.ndarray, cells: np.ndarray, velocity: np.ndarray, pressure: np.ndarray) -> Field:
    return Field(0.0, nodes, cells, velocity, pressure, np.zeros(velocity.shape))


def test_a_scene_has_fluid_bodies_sides_and_streamlines(run: Run) -> None:
    shown = scenery.scenery(run)
    names = {part.name for part in shown.parts}
    assert {scenery.FLUID, scenery.BODIES, "sides", scenery.LINES} <= names
    fluid, bodies = shown.parts[:2]
    assert np.ptp(fluid.points[:, 2]) == pytest.approx(0.0, abs=1e-9)
    # The pressure is linear: on bodies it is that of the field
    x, y, z = bodies.points.T
    assert bodies.values["pressure"] == pytest.approx(x + 2 * y - z, abs=1e-5)


def test_a_figure_says_what_its_colours_leave_out(run: Run, tmp_path: Path) -> None:
    drawn = stills.scene_picture(run)
    texts = [text.get_text() for axes in drawn.axes for text in axes.texts]
    assert "% of the area\nbeyond, to" in " ".join(texts)
    assert {"x", "y", "z"} <= set(texts)
    labels = {axes.get_ylabel() for axes in drawn.axes}
    assert {"speed (m/s)", "pressure (Pa) on bodies"} <= labels
    for kind in ("png", "pdf", "svg"):
        out = tmp_path / f"scene.{kind}"
        assert main(["picture", str(run.path), "--scene", "--out", str(out)]) == 0
        assert out.stat().st_size > 10_000
    # Letters of a drawing for papers are letters
    assert "pressure (Pa) on bodies" in (tmp_path / "scene.svg").read_text()


def test_a_scene_has_a_view_of_its_own(
    run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["picture", str(run.path), "--scene", "--out", str(tmp_path / "a.png")]
    assert main([*given, "--slice", "z=1", "--frame", "block"]) == 2
    assert "leave out --slice, --frame" in capsys.readouterr().err
    assert main([*given, "--quantity", "mesh"]) == 2
    assert "no quantity of a scene mesh; there are speed" in capsys.readouterr().err


def test_the_gallery_shows_the_scene(run: Run) -> None:
    assert len(gallery.default_picture(run).axes) == 3


def test_a_scene_is_in_space(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["picture", str(planar_run.path), "--scene", "--out", str(tmp_path / "a.png")]
    assert main(given) == 2
    assert "--scene" in capsys.readouterr().err


def test_walls_of_a_box_are_glass_and_other_sides_are_not(run: Run) -> None:
    run.case["boundary"] = {"left": "no-slip", "right": "do-nothing", "top": "no-slip"}
    try:
        found = [mesh for mesh, look in walls.walls(run, [Moment(0.0, None)], is_whole=True)
                 if look is walls.GLASS]  # fmt: skip
    finally:
        del run.case["boundary"]
    assert [mesh.bounds for mesh in found] == [(0, 0, 0, 3, 0, 3), (0, 3, 3, 3, 0, 3)]


@pytest.mark.parametrize(("nodes", "cells"), [ring(), block()], ids=["plane", "space"])
def test_a_linear_pressure_is_kept_and_scatter_goes(nodes: np.ndarray, cells: np.ndarray) -> None:
    d = nodes.shape[1]
    linear = 3.0 + nodes @ np.arange(1.0, d + 1)
    own = flow(nodes, cells, 0.0 * nodes, linear)
    vertices = np.unique(cells[:, : d + 1])
    kept = recovered.smooth_pressure(own).pressure[vertices]
    assert kept == pytest.approx(linear[vertices], abs=1e-6)
    if d == 2:
        # Of one layer of cells, in which all vertices are at a boundary
        return
    scatter = np.where(np.arange(len(nodes)) % 2 == 0, 1.0, -1.0)
    rough = recovered.smooth_pressure(replace(own, pressure=scatter)).pressure[vertices]
    assert rough.std() < 0.75 * scatter[vertices].std()


def test_streamlines_of_a_turning_flow_are_circles_that_end_once_around() -> None:
    nodes, cells = block()
    middle = nodes - 1.5
    velocity = np.column_stack([-middle[:, 1], middle[:, 0], 0.0 * middle[:, 0]])
    lines = streams.streamlines(
        flow(nodes, cells, velocity, nodes[:, 0]), np.array([np.zeros(3), np.full(3, 3.0)])
    )
    assert len(lines) > 3
    for line in lines:
        distance = np.hypot(*(line[:, :2] - 1.5).T)
        assert np.ptp(distance) < 0.05 * distance.mean()
        assert np.ptp(line[:, 2]) < 1e-3
        steps = np.diff(np.unwrap(np.arctan2(*(line[:, :2] - 1.5).T[::-1])))
        assert np.abs(steps.sum()) < 2.6 * np.pi


def test_limits_say_what_they_leave_out() -> None:
    values = np.append(np.linspace(-1.0, 1.0, 1000), 500.0)
    _, (low, high) = style.colours("pressure", values, np.ones(1001), style.ON_BODIES)
    assert (low, high) == pytest.approx((-0.97, 0.97), abs=0.02)
    said = style.beyond("pressure", (low, high), (-1.0, 500.0), style.ON_BODIES)
    assert said == "limits leave out 2 % of the area at each end, up to -1, 500"
    assert style.beyond("speed", (0.0, 1.0), (0.0, 1.0)) == style.ALL


def test_a_peak_of_the_pressure_is_kept() -> None:
    nodes, cells = meshes.box(10, 0.0, 1.0)
    away = ((nodes - 0.5) ** 2).sum(axis=1)
    peak = np.exp(-20.0 * away)
    own = flow(nodes, cells, 0.0 * nodes, peak)
    middle = int(np.argmin(away))
    assert recovered.smooth_pressure(own).pressure[middle] > 0.85 * peak[middle]
