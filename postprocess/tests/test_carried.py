"""Particles in flows that are known: rotation, Poiseuille's, strain, in time, on moving meshes."""

from __future__ import annotations

from pathlib import Path

import meshes
import numpy as np
import pytest
from conftest import CAN_RENDER
from PIL import Image

from alewife_post import Run, carried, tracers
from alewife_post.cli import main

TOP = meshes.TOP.format(
    geometry="planar", domain="channel = {{ length = {0}, height = 1.0 }}", time="{1}", body="{2}"
)
SQUARE = np.array([[-1.0, -1.0], [1.0, 1.0]])


def steady(path: Path, velocity: object, box: np.ndarray = SQUARE, body: str = "") -> Run:
    nodes, cells = meshes.rectangle((6, 5), box[0], box[1], 0.2)
    top = TOP.format(np.ptp(box[:, 0]), "steady", body)
    flow = velocity(*nodes.T)
    return meshes.written(path, [(0.0, nodes, cells, flow, 0 * nodes[:, 0])], top)


def test_a_turning_fluid_turns_particles_by_steps_of_fourth_order(tmp_path: Path) -> None:
    run = steady(tmp_path / "run", lambda x, y: np.stack([-y, x], 1))
    seeds = np.array([[0.5, 0.0], [0.0, 0.7], [-0.2, -0.3]])
    errors = []
    for step in (0.4, 0.2, 0.1):
        found = carried.carried(run, seeds, start=0.0, end=4.0, step=step, outputs=1)
        c, s = np.cos(4.0), np.sin(4.0)
        errors.append(np.abs(found.place[-1] - seeds @ np.array([[c, s], [-s, c]])).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.2)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4.0, abs=0.2)
    assert np.abs(found.stretching).max() < 1e-5
    # And back again
    back = carried.carried(run, found.place[-1], start=4.0, end=0.0, step=0.1, outputs=1)
    assert back.place[-1] == pytest.approx(seeds, abs=1e-5)


def test_a_parabola_carries_particles_out_of_a_channel(tmp_path: Path) -> None:
    box = np.array([[0.0, 0.0], [3.0, 1.0]])
    run = steady(tmp_path / "run", lambda x, y: np.stack([4 * y * (1 - y), 0 * y], 1), box)
    y = np.array([0.0, 0.1, 0.3, 0.5])
    found = carried.carried(
        run, np.column_stack([0.5 + 0 * y, y]), start=0.0, end=10.0, step=0.05, outputs=20
    )
    speed = 4 * y * (1 - y)
    exact = 2.5 / np.maximum(speed, 1e-9)
    assert np.isnan(found.left).tolist() == [True, False, False, False]
    # Up to a step of 0.05 that was halved eight times
    assert found.left[1:] == pytest.approx(exact[1:], abs=3e-4)
    assert found.residence == pytest.approx([10.0, *exact[1:]], abs=3e-4)
    assert np.isnan(found.place[-1, 1:]).all()
    assert found.place[2, :, 0] == pytest.approx(0.5 + speed, abs=1e-12)
    # A line of fluid across a shear is stretched by the shear and the time
    shear = 4 * (1 - 2 * y) * np.minimum(10.0, exact)
    largest = 0.5 * (np.abs(shear) + np.sqrt(shear**2 + 4))
    assert found.stretching * found.residence == pytest.approx(np.log(largest), abs=2e-3)


def test_a_strain_stretches_by_its_rate(tmp_path: Path) -> None:
    run = steady(tmp_path / "run", lambda x, y: np.stack([0.3 * x, -0.3 * y], 1))
    found = carried.carried(run, np.array([[0.1, 0.5]]), start=0.0, end=3.0, step=0.1)
    assert found.stretching == pytest.approx(0.3, abs=1e-6)
    assert found.place[-1, 0] == pytest.approx([0.1 * np.exp(0.9), 0.5 * np.exp(-0.9)], abs=1e-6)


def test_a_periodic_domain_carries_on(tmp_path: Path) -> None:
    box = np.array([[0.0, 0.0], [3.0, 1.0]])
    body = "[boundary]\nleft = { periodic = {} }\n"
    run = steady(tmp_path / "run", lambda x, y: np.stack([1 + 0 * y, 0 * y], 1), box, body)
    found = carried.carried(run, np.array([[0.5, 0.5], [2.9, 0.2]]), start=0.0, end=10.0)
    assert found.place[-1] == pytest.approx(np.array([[10.5, 0.5], [12.9, 0.2]]))
    assert np.isnan(found.left).all()


def unsteady(path: Path, n: int, *, moves: bool, remeshes: bool) -> Run:
    """Uniform flow that turns in time, in a box that may move with it and be meshed anew."""
    frames = []
    for k, time in enumerate(np.linspace(0.0, 2.0, n + 1)):
        cells_across = (6, 5) if not remeshes or k % 2 == 0 else (5, 7)
        nodes, cells = meshes.rectangle(cells_across, 4 * SQUARE[0], 4 * SQUARE[1], 0.2)
        if moves:
            nodes = nodes + np.array([0.3 * time, 0.0])
        velocity = np.tile([np.cos(3 * time), np.sin(3 * time)], (len(nodes), 1))
        frames.append((time, nodes, cells, velocity, 0 * nodes[:, 0]))
    return meshes.written(path, frames, TOP.format(8.0, "unsteady", ""))


@pytest.mark.parametrize(("moves", "remeshes"), [(False, False), (True, False), (True, True)])
def test_flows_in_time_are_of_second_order_in_the_time_between_files(
    tmp_path: Path, *, moves: bool, remeshes: bool
) -> None:
    errors = []
    for n in (10, 20, 40):
        run = unsteady(tmp_path / f"{n}", n, moves=moves, remeshes=remeshes)
        found = carried.carried(run, np.array([[0.1, -0.2]]), start=0.0, end=2.0, step=0.05)
        exact = np.array([0.1 + np.sin(6.0) / 3, -0.2 + (1 - np.cos(6.0)) / 3])
        errors.append(np.abs(found.place[-1, 0] - exact).max())
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1)
    assert errors[-1] < 1e-3


def test_small_cells_count_where_they_are_in_time(tmp_path: Path) -> None:
    frames = []
    for time, size in ((0.0, 1.0), (1.0, 1.0), (2.0, 1e-7), (3.0, 1e-7)):
        nodes, cells = meshes.rectangle((6, 5), size * SQUARE[0], size * SQUARE[1])
        frames.append((time, nodes, cells, np.tile([1.0, 0.0], (len(nodes), 1)), 0 * nodes[:, 0]))
    run = meshes.written(tmp_path / "run", frames, TOP.format(2.0, "unsteady", ""))
    seeds = np.array([[-0.5, 0.0]])
    found = carried.carried(run, seeds, start=0.0, end=0.9)
    assert found.place[-1, 0] == pytest.approx([0.4, 0.0])
    where = r"cells of 3.33e-08 in .*000002.vtu, t = 2: --from and --to"
    with pytest.raises(ValueError, match=r"between t = 1.*" + where):
        carried.carried(run, seeds, start=0.0, end=1.5)
    with pytest.raises(ValueError, match=r"--step sets another one than 1e-06"):
        carried.carried(run, seeds, start=0.0, end=1.5, step=1e-6)


def test_particles_released_again_make_a_streak_line(tmp_path: Path) -> None:
    run = unsteady(tmp_path / "run", 20, moves=False, remeshes=False)
    found = carried.carried(
        run, np.array([[0.0, 0.0]]), start=0.0, end=2.0, step=0.05, release=0.5, outputs=4
    )
    assert found.released.tolist() == [0.0, 0.5, 1.0, 1.5]
    assert np.isnan(found.place[:, :, 0]).sum(axis=0).tolist() == [0, 1, 2, 3]
    assert found.place[1, 1] == pytest.approx([0.0, 0.0])
    # What the flow does from one time on is the same for all of them
    moved = found.place[-1] - found.place[np.arange(4), np.arange(4)]
    assert moved[2] == pytest.approx(found.place[-1, 0] - found.place[2, 0], abs=1e-9)


def test_particles_about_an_axis_stay_on_their_side_of_it(tmp_path: Path) -> None:
    nodes, cells = meshes.rectangle((6, 5), np.array([0.0, 0.0]), np.array([3.0, 1.0]))
    velocity = np.stack([0.1 + 0 * nodes[:, 0], -nodes[:, 1]], 1)
    top = meshes.TOP.format(
        geometry="axisymmetric", domain="cylinder = { x = [0.0, 3.0], radius = 1.0 }",
        time="steady", body="",
    )  # fmt: skip
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, velocity, nodes[:, 0])], top)
    found = carried.carried(run, np.array([[0.1, 0.8], [0.1, 0.0]]), start=0.0, end=4.0)
    assert found.place[-1] == pytest.approx(
        np.array([[0.5, 0.8 * np.exp(-4)], [0.5, 0.0]]), abs=1e-6
    )


def test_particles_in_space_follow_a_helix(tmp_path: Path) -> None:
    nodes, cells = meshes.box(4, -1.0, 1.0)
    x, y, _ = nodes.T
    top = meshes.TOP.format(
        geometry="spatial", domain="box = { min = [-1.0, -1.0, -1.0], max = [1.0, 1.0, 1.0] }",
        time="steady", body="",
    )  # fmt: skip
    velocity = np.stack([-y, x, 0.2 + 0 * x], 1)
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, velocity, 0 * x)], top)
    found = carried.carried(run, np.array([[0.5, 0.0, -0.9]]), start=0.0, end=np.pi, step=0.1)
    assert found.place[-1, 0] == pytest.approx([-0.5, 0.0, -0.9 + 0.2 * np.pi], abs=1e-5)


def test_seeds_are_boxes_lines_and_files(tmp_path: Path) -> None:
    box = carried.seeds("box=0,2,0,1", 200, 2)
    assert len(box) == 200
    assert (box.min(axis=0), box.max(axis=0)) == (
        pytest.approx([0.05, 0.05]),
        pytest.approx([1.95, 0.95]),
    )
    assert len(carried.seeds("box=0,1,0,1,0.5,0.5", 100, 3)) == 100
    line = carried.seeds("line=0,0,1,2", 3, 2)
    assert line.tolist() == [[0, 0], [0.5, 1], [1, 2]]
    (tmp_path / "seeds.csv").write_text("y,x\n1,2\n3,4\n")
    assert carried.seeds(str(tmp_path / "seeds.csv"), 9, 2).tolist() == [[2, 1], [4, 3]]
    with pytest.raises(ValueError, match="box=x0,x1,y0,y1"):
        carried.seeds("box=0,1,0", 9, 2)
    with pytest.raises(ValueError, match="no column z"):
        carried.seeds(str(tmp_path / "seeds.csv"), 9, 3)
    with pytest.raises(FileNotFoundError, match=r"neither box=... nor line="):
        carried.seeds("nowhere", 9, 2)


def test_the_command_writes_paths_that_a_film_shows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import pyvista

    run = unsteady(tmp_path / "run", 8, moves=False, remeshes=False)
    out = tmp_path / "paths"
    given = ["trace", str(run.path), "--seed", "line=-1,0,1,0", "--count", "3", "--out", str(out)]
    assert main([*given, "--release", "0.5", "--outputs", "8"]) == 0
    assert "12 particles, t = 0 to 2; 0 left the fluid" in capsys.readouterr().out
    tracks = tracers.read_paths(out)
    assert len(tracks.seed) == 12
    lines, heads = tracks.shown(run, 1.25)
    # Three places, at each three releases up to then
    assert [len(line) for line in lines] == [3, 3, 3]
    assert len(heads) == 9
    # The last one of the first place was released at t = 1
    moved = [(np.sin(3.75) - np.sin(3.0)) / 3, (np.cos(3.0) - np.cos(3.75)) / 3]
    assert lines[0][-1] == pytest.approx([-1 + moved[0], moved[1], 0.0], abs=0.02)
    mesh = pyvista.read(out / "paths.vtp")
    assert mesh.n_lines == 12
    film = ["film", str(run.path), "--particles", str(out), "--out", str(tmp_path / "a.gif")]
    assert main([*film, "--quantity", "mesh", "--painter", "matplotlib"]) == 0
    assert (tmp_path / "a.gif").stat().st_size > 1000
    capsys.readouterr()
    for wrong, said in (
        ([*given, "--to", "0"], "--to says how long"),
        ([*given, "--to", "9"], "t = 9 is not in"),
        ([*given, "--step", "1e-9"], "--step sets another one"),
        (["trace", str(run.path), "--seed", "line=9,9,9,8"], "none of 100 places is in the fluid"),
        ([*film[:3], str(tmp_path / "none"), *film[4:]], "alewife-post trace writes it"),
    ):
        assert main(wrong) == 2
        assert said in capsys.readouterr().err


def test_a_film_in_space_shows_particles(tmp_path: Path) -> None:
    if not CAN_RENDER:
        pytest.skip("VTK can have no window here")
    nodes, cells = meshes.box(3, -1.0, 1.0)
    top = meshes.TOP.format(
        geometry="spatial", domain="box = { min = [-1.0, -1.0, -1.0], max = [1.0, 1.0, 1.0] }",
        time="unsteady", body="",
    )  # fmt: skip
    velocity = np.tile([0.3, 0.0, 0.0], (len(nodes), 1))
    frames = [(time, nodes, cells, velocity, nodes[:, 0]) for time in (0.0, 1.0, 2.0)]
    run = meshes.written(tmp_path / "run", frames, top)
    out = tmp_path / "paths"
    given = ["trace", str(run.path), "--seed", "box=-0.9,0,-0.9,0.9,0,0", "--count", "9"]
    assert main([*given, "--out", str(out)]) == 0
    images = []
    for extra in ([], ["--particles", str(out)]):
        film = tmp_path / f"{len(extra)}.gif"
        assert main(["film", str(run.path), "--size", "320x240", "--out", str(film), *extra]) == 0
        with Image.open(film) as opened:
            opened.seek(1)
            images.append(np.asarray(opened.convert("RGB")).astype(int))
    red = (np.abs(images[1] - [255, 111, 89]).sum(axis=2) < 60).sum()
    assert red > 20
    assert (np.abs(images[0] - [255, 111, 89]).sum(axis=2) < 60).sum() == 0


def test_pictures_have_whole_paths_and_streak_lines(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    box = np.array([[0.0, 0.0], [3.0, 1.0]])
    run = steady(tmp_path / "run", lambda x, y: np.stack([4 * y * (1 - y), 0 * y], 1), box)
    seeds = np.array([[0.5, 0.1], [0.5, 0.5]])
    found = carried.carried(run, seeds, start=0.0, end=4.0, step=0.05, outputs=20)
    tracers.write_paths(run, found, tmp_path / "paths")
    tracks = tracers.read_paths(tmp_path / "paths")
    lines, heads = tracks.still(run, None)
    # The faster one has left, and its path is there nevertheless
    assert [line[0, 0] for line in lines] == [0.5, 0.5]
    assert lines[1][-1, 0] == pytest.approx(2.9, abs=0.11)
    assert len(heads) == 1
    assert heads[0, :2] == pytest.approx([0.5 + 4 * 0.36, 0.1])
    lines, _ = tracks.still(run, 1.1)
    assert lines[1][-1, 0] == pytest.approx(1.6)
    given = ["picture", str(run.path), "--particles", str(tmp_path / "paths")]
    for name in ("a.png", "a.svg", "a.pdf"):
        assert main([*given, "--out", str(tmp_path / name), "--contours", "8"]) == 0
    assert "<image" not in (tmp_path / "a.svg").read_text()
    capsys.readouterr()
    film = ["film", *given[1:], "--out", str(tmp_path / "a.gif")]
    assert main(film) == 2
    assert f"picture {run.path} --particles {tmp_path / 'paths'}" in capsys.readouterr().err


def test_a_picture_at_a_time_without_particles_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = unsteady(tmp_path / "run", 10, moves=False, remeshes=False)
    found = carried.carried(
        run, np.array([[0.0, 0.0]]), start=0.0, end=1.0, step=0.1, release=0.1, outputs=10
    )
    tracers.write_paths(run, found, tmp_path / "paths")
    given = ["picture", str(run.path), "--particles", str(tmp_path / "paths"), "--out"]
    assert main([*given, str(tmp_path / "a.png"), "--time", "1.0"]) == 0
    assert main([*given, str(tmp_path / "a.png")]) == 2
    assert "known from t = 0 to 1" in capsys.readouterr().err
    (line,), heads = tracers.read_paths(tmp_path / "paths").still(run, 1.0)
    assert len(line) == len(heads) == 10
