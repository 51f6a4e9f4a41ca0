"""Films in space: slices, surfaces, bodies from messages, and the camera."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import CAN_RENDER, block
from test_film import colour_at, frames_of

from alewife_post import Run, camera, cli, film, open_run, planes, stage, style
from alewife_post.cast import Cast, _cone
from alewife_post.read import QUADRATIC_TETRAHEDRON

NEEDS_WINDOW = pytest.mark.skipif(not CAN_RENDER, reason="VTK can have no window here")
SMALL = ["--size", "320x240"]

CASE = """
title = "A ball in a box"
geometry = "spatial"
units = "SI"
[domain.box]
min = [0.0, 0.0, 0.0]
max = [3.0, 3.0, 3.0]
[[body]]
name = "ball"
center = [1.5, 1.5, 1.5]
shape.sphere.radius = 0.5
[time.unsteady]
step = 0.1
end = 1.0
"""

SPHERE = {
    "pose": {
        "position": {"x": 0.0, "y": 0.0, "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
    },
    "size": {"x": 1.0, "y": 1.0, "z": 1.0},
}


def report(time: float) -> dict:
    """A body that goes along x."""
    still = {"x": 0.0, "y": 0.0, "z": 0.0}
    load = {"force": still, "torque": still}
    return {
        "time": time,
        "pose": {
            "center": {"x": 1.0 + time, "y": 1.5, "z": 1.5},
            "rotation": {**still, "w": 1.0},
            "angle": 0.0,
        },
        "twist": {"linear": {**still, "x": 1.0}, "angular": still},
        "load": load,
        "surface_load": load,
        "power": 0.0,
    }


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """A run with six fields around a block, and eleven messages of a ball."""
    import pyvista
    from mcap.writer import Writer

    path = tmp_path / "run"
    (path / "fields").mkdir(parents=True)
    nodes, cells = block()
    sets = ""
    for k in range(6):
        grid = pyvista.UnstructuredGrid({QUADRATIC_TETRAHEDRON: cells}, nodes)
        grid.point_data["velocity"] = np.stack(
            [1 + nodes[:, 1] ** 2, *(0 * nodes[:, 1:].T)], axis=1
        )
        grid.point_data["pressure"] = (k + 1.0) * (nodes[:, 0] - 1.5)
        grid.point_data["vorticity"] = 0 * nodes
        grid.field_data["TimeValue"] = [0.2 * k]
        grid.save(path / f"fields/{k:06}.vtu")
        sets += f'<DataSet timestep="{0.2 * k}" part="0" file="fields/{k:06}.vtu"/>'
    (path / "fields.pvd").write_text(
        f'<VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>'
    )
    (path / "case.toml").write_text(CASE)
    with (path / "run.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("any", "jsonschema", b"{}")
        scene, body = (writer.register_channel(t, "json", schema) for t in ("/scene", "/body/ball"))
        entity = {"id": "ball", "spheres": [SPHERE], "cylinders": [], "lines": []}
        writer.add_message(scene, 0, json.dumps({"entities": [entity]}).encode(), 0)
        for k in range(11):
            stamp = k * 10**8
            writer.add_message(body, stamp, json.dumps(report(0.1 * k)).encode(), stamp)
        writer.finish()
    return open_run(path)


def filmed(run: Run, *more: str) -> np.ndarray:
    out = run.path / "film.mp4"
    assert cli.main(["film", str(run.path), "--out", str(out), *SMALL, *more]) == 0
    return frames_of(out)[1]


@NEEDS_WINDOW
def test_a_slice_and_the_bodies_are_in_every_frame(run: Run) -> None:
    shown = filmed(run, "--quantity", "pressure")
    assert len(shown) == 6
    # Colours of a pressure that grows: far from white at the ends of the plane in the last frame
    strong = [(image.max(axis=2).astype(int) - image.min(axis=2) > 60).sum() for image in shown]
    assert strong[-1] > 3 * strong[0] + 100
    for image in shown:
        assert colour_at(image, style.BODY).sum() > 50


@NEEDS_WINDOW
def test_bodies_move_as_their_messages_say_and_stay_if_followed(run: Run) -> None:
    def middles(shown: np.ndarray) -> np.ndarray:
        # Without the legend in the corners, whose colours are blended by the film
        rows = shown[:, 60:170]
        found = [np.flatnonzero(colour_at(one, style.SERIES[0], 60).any(axis=0)) for one in rows]
        return np.array([0.5 * (columns.min() + columns.max()) for columns in found])

    camera_along_y = ("--camera", "-90", "0", "--no-trails", "--quantity", "bodies")
    moving = middles(filmed(run, *camera_along_y))
    assert len(moving) == 11
    steps = np.diff(moving)
    assert steps.min() > 1.0
    assert steps.max() - steps.min() <= 2.0
    assert np.ptp(middles(filmed(run, *camera_along_y, "--follow", "ball"))) <= 1.0


@NEEDS_WINDOW
def test_surfaces_have_the_pressure_on_them(run: Run) -> None:
    shown = filmed(run, "--surface", "--camera", "-90", "0", "--no-trails")
    last = shown[-1].astype(int)
    # The block is seen from the front: low pressure on its left, high on its right
    is_warm, is_cool = (last[..., i] - last[..., j] > 25 for i, j in ((0, 2), (2, 0)))
    assert is_warm.sum() > 100
    assert is_cool.sum() > 100
    assert np.argwhere(is_cool)[:, 1].mean() < np.argwhere(is_warm)[:, 1].mean()


def test_what_is_not_in_space_is_refused(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    def answer(*more: str) -> str:
        out = str(run.path / "film.mp4")
        assert cli.main(["film", str(run.path), "--out", out, *SMALL, *more]) == 2
        return capsys.readouterr().err

    assert "in the plane" in answer("--view", "0", "1", "0", "1")
    assert "speed, pressure, vorticity, bodies" in answer("--quantity", "mesh")
    assert "is not a plane" in answer("--slice", "u=1")
    if CAN_RENDER:
        assert "meets no fluid" in answer("--slice", "z=9")


def test_a_slice_has_the_area_and_the_values_of_the_fluid_in_it(run: Run) -> None:
    field = run.field(0.0)
    plane = planes.straight(2, 1.4)
    cut = stage.Cut(plane, np.array([-9.0, -9.0]), np.array([9.0, 9.0]), moves=False)
    found = stage.slice_of(field, cut, "pressure")
    assert found.area == pytest.approx(8.0, rel=1e-5)
    x = np.asarray(found.points)[:, 0]
    assert found.point_data["values"] == pytest.approx(x - 1.5, abs=1e-5)
    part = stage.Cut(plane, np.array([0.25, 0.5]), np.array([2.0, 0.75]), moves=False)
    assert stage.slice_of(field, part, "pressure").area == pytest.approx(1.75 * 0.25, rel=1e-5)
    # Where the view has moved, another part of the same plane is seen
    moved = part.at(np.array([0.5, 0.0, 7.0]))
    np.testing.assert_allclose(moved.low, [0.75, 0.5])
    assert moved.plane.origin[2] == 1.4


def test_an_oblique_slice_lies_in_its_plane(run: Run) -> None:
    across = np.array([[1.0, 1.0, 0.0], [1.0, -1.0, 1.0]])
    across /= np.linalg.norm(across, axis=1)[:, None]
    plane = planes.Plane(np.array([0.5, 0.5, 0.5]), across, ("a", "b"), "oblique")
    cut = stage.Cut(plane, np.array([-0.3, -0.2]), np.array([0.3, 0.2]), moves=False)
    found = stage.slice_of(run.field(0.0), cut, "speed")
    assert found.area == pytest.approx(0.6 * 0.4, rel=1e-4)
    away = (np.asarray(found.points) - plane.origin) @ plane.normal
    assert abs(away).max() < 1e-6


@pytest.mark.parametrize("angles", [(-50.0, 20.0), (10.0, -35.0), (0.0, 90.0)])
def test_the_camera_has_all_in_view_and_no_more(angles: tuple[float, float]) -> None:
    from alewife_post import scene

    corners = camera.corners_of(np.array([[1.0, -2.0, 0.0], [4.0, 5.0, 1.0]]))
    for aspect in (0.5, 1.0, 2.0):
        found = camera.camera(scene.direction(angles), corners, aspect)
        frame = np.array([found.right, found.up, found.towards])
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        places = (corners - found.middle) @ np.array([found.right, found.up]).T
        used = np.abs(places).max(axis=0) / (found.scale * np.array([aspect, 1.0]))
        assert used.max() == pytest.approx(1 / 1.04)


def test_gravity_points_down(run: Run) -> None:
    for gravity in ([0.0, -9.81, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 2.0], [1.0, 1.0, 0.0]):
        run.__dict__["case"] = run.case | {"fluid": {"gravity": gravity}}
        for plane in (None, planes.straight(0, 0.0), planes.straight(2, 0.0)):
            towards, up = camera.direction(run, film.Request(), plane)
            found = camera.camera((towards, up), camera.corners_of(np.eye(3)[:2]), 1.0)
            assert np.linalg.norm(towards) == pytest.approx(1.0)
            assert found.up @ gravity < 0.0
            assert abs(found.right @ gravity) < 1e-9 * np.linalg.norm(gravity)


def test_a_cone_has_the_area_of_a_cone() -> None:
    import pyvista

    def area(scales: tuple[float, float]) -> float:
        points, faces = _cone(np.array([2.0, 2.0, 4.0]), scales, n=400)
        mesh = pyvista.PolyData.from_regular_faces(points, faces)
        # Outwards everywhere: the volume is positive, and closed
        assert mesh.volume > 0
        return mesh.area

    assert area((1.0, 1.0)) == pytest.approx(2 * np.pi + 2 * np.pi * 4, rel=1e-3)
    slant = np.hypot(4.0, 0.5)
    assert area((1.0, 0.5)) == pytest.approx(np.pi * (1.25 + 1.5 * slant), rel=1e-3)


def test_a_ball_is_where_its_message_has_it(run: Run) -> None:
    points, faces = Cast(run).form("ball", 0.0)
    assert np.linalg.norm(points, axis=1) == pytest.approx(0.5)
    assert faces.max() == len(points) - 1


def test_a_body_that_deforms_is_a_dot_where_no_mesh_shows_it(run: Run) -> None:
    (body,) = run.case["body"]
    gait = {"gait": {"pulsating": {}}}
    run.__dict__["case"] = run.case | {"body": [body | gait]}
    points, _ = Cast(run).form("ball", 0.0)
    assert np.linalg.norm(points, axis=1) == pytest.approx(0.05)


def test_shapes_come_from_the_messages(run: Run) -> None:
    ((solid,),) = [shape.solids for shape in run.shapes["ball"]]
    assert solid.kind == "ellipsoid"
    assert solid.size.tolist() == [1.0, 1.0, 1.0]
