"""Films in space: slices, surfaces, bodies from messages, and the camera."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from conftest import CAN_RENDER, block
from test_film import colour_at, frames_of

from alewife_post import (
    Run,
    bodies,
    camera,
    cli,
    cuts,
    domains,
    film,
    isosurfaces,
    open_run,
    planes,
    space,
    style,
)
from alewife_post.cast import Cast, _cone
from alewife_post.read import QUADRATIC_TETRAHEDRON, Field
from alewife_post.request import chosen_moments

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
    cut = cuts.Cut(plane, np.array([-9.0, -9.0]), np.array([9.0, 9.0]), moves=False)
    found = cuts.slice_of(field, cut, "pressure")
    assert found.area == pytest.approx(8.0, rel=1e-5)
    x = np.asarray(found.points)[:, 0]
    assert found.point_data["values"] == pytest.approx(x - 1.5, abs=1e-5)
    part = cuts.Cut(plane, np.array([0.25, 0.5]), np.array([2.0, 0.75]), moves=False)
    assert cuts.slice_of(field, part, "pressure").area == pytest.approx(1.75 * 0.25, rel=1e-5)
    # Where the view has moved, another part of the same plane is seen
    moved = part.at(np.array([0.5, 0.0, 7.0]))
    np.testing.assert_allclose(moved.low, [0.75, 0.5])
    assert moved.plane.origin[2] == 1.4


def test_an_oblique_slice_lies_in_its_plane(run: Run) -> None:
    across = np.array([[1.0, 1.0, 0.0], [1.0, -1.0, 1.0]])
    across /= np.linalg.norm(across, axis=1)[:, None]
    plane = planes.Plane(np.array([0.5, 0.5, 0.5]), across, ("a", "b"), "oblique")
    cut = cuts.Cut(plane, np.array([-0.3, -0.2]), np.array([0.3, 0.2]), moves=False)
    found = cuts.slice_of(run.field(0.0), cut, "speed")
    assert found.area == pytest.approx(0.6 * 0.4, rel=1e-4)
    away = (np.asarray(found.points) - plane.origin) @ plane.normal
    assert abs(away).max() < 1e-6


@pytest.mark.parametrize("angles", [(-50.0, 20.0), (10.0, -35.0), (0.0, 90.0)])
def test_the_camera_has_all_in_view_and_no_more(angles: tuple[float, float]) -> None:
    from alewife_post import scene

    corners = domains.corners_of(np.array([[1.0, -2.0, 0.0], [4.0, 5.0, 1.0]]))
    for aspect in (0.5, 1.0, 2.0):
        found = camera.camera(scene.direction(angles), corners, aspect)
        frame = np.array([found.right, found.up, found.towards])
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        places = (corners - found.middle) @ np.array([found.right, found.up]).T
        used = np.abs(places).max(axis=0) / (found.scale * np.array([aspect, 1.0]))
        assert used.max() == pytest.approx(1 / 1.04)


def test_a_body_that_only_the_mesh_knows_is_in_view(run: Run) -> None:
    other = Run(run.path)
    other.__dict__["case"] = {
        **run.case,
        "body": [{"name": "ball", "center": [1.5, 1.5, 1.5]}],
        "domain": {"sphere": {"radius": 100.0}},
    }
    other.__dict__["_bodies_and_shapes"] = (run.bodies, {})
    moments = [film.Moment(frame.time, frame.path) for frame in run.fields]
    request = film.Request(quantity="pressure", surface=True)
    # Faces of the box of 3 are no sides of this domain
    seen = camera.seen(other, moments, request, np.zeros((6, 3)))
    assert (seen.box[0] <= 0.0).all()
    assert (seen.box[1] >= 3.0).all()


def test_gravity_points_down(run: Run) -> None:
    for gravity in ([0.0, -9.81, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 2.0], [1.0, 1.0, 0.0]):
        run.__dict__["case"] = run.case | {"fluid": {"gravity": gravity}}
        for plane in (None, planes.straight(0, 0.0), planes.straight(2, 0.0)):
            towards, up = camera.direction(run, film.Request(), plane)
            found = camera.camera((towards, up), domains.corners_of(np.eye(3)[:2]), 1.0)
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


# ---- Surfaces of equal vorticity, and stills -----------------------------------------------------


def growing(run: Run, axis: int) -> Field:
    """The first field with a vorticity that grows along an axis."""
    field = run.field(0.0)
    return replace(field, vorticity=field.nodes[:, [axis]] * [0.0, 0.6, 0.8])


def test_a_surface_of_equal_vorticity_is_where_it_has_that_value(run: Run) -> None:
    whole = np.array([[0.0, 0.0, 0.0], [3.0, 3.0, 3.0]])
    field = growing(run, 0)
    for level, area in ((0.4, 9.0), (1.4, 8.0)):
        found = isosurfaces.isosurface(run.case, field, "vorticity", level, whole)
        assert found.area == pytest.approx(area, rel=1e-5)
        np.testing.assert_allclose(np.asarray(found.points)[:, 0], level, atol=1e-5)
    half = np.array([[0.0, 0.0, 0.0], [3.0, 1.5, 3.0]])
    found = isosurfaces.isosurface(run.case, field, "vorticity", 0.4, half)
    assert found.area == pytest.approx(4.5, rel=1e-5)
    beyond = isosurfaces.isosurface(run.case, field, "vorticity", 9.0, whole)
    assert beyond.n_cells == 0


def test_a_surface_goes_on_beyond_a_periodic_mesh(run: Run) -> None:
    case = {**run.case, "boundary": {"left": {"periodic": "right"}}}
    field = growing(run, 2)
    moved = replace(field, nodes=field.nodes + np.array([1.0, 0.0, 0.0]))
    whole = np.array([[0.0, 0.0, 0.0], [3.0, 3.0, 3.0]])
    found = isosurfaces.isosurface(case, moved, "vorticity", 0.4, whole)
    assert found.area == pytest.approx(9.0, rel=1e-5)
    points = np.asarray(found.points)
    assert (points[:, 0].min(), points[:, 0].max()) == pytest.approx((0.0, 3.0))


def test_half_of_all_vorticity_lies_beyond_the_level(run: Run) -> None:
    # Without the block, of x from 0 to 3 half lies beyond the root of 4.5
    field = growing(run, 0)
    box = np.array([[0.0, 0.0, 0.0], [3.0, 1.0, 3.0]])
    found = isosurfaces.samples(field, "vorticity", box)
    assert found[1].sum() == pytest.approx(9.0)
    # Its samples are the corners of cells, a unit apart
    assert isosurfaces.level_of([found]) == pytest.approx(4.5**0.5, abs=0.15)
    with pytest.raises(ValueError, match="zero all over"):
        isosurfaces.level_of([(np.zeros(3), np.ones(3))])


@pytest.mark.parametrize("text", ["pressure", "vorticity=0", "vorticity=-1", "vorticity=a", "=2"])
def test_what_is_no_surface_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"vorticity=2\.5"):
        isosurfaces.parsed(text)
    assert isosurfaces.parsed(" speed = 2e-1") == ("speed", 0.2)
    assert isosurfaces.parsed("vorticity") == ("vorticity", None)


@NEEDS_WINDOW
def test_stills_show_a_surface_and_go_with_who_is_followed(
    run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def still(*more: str) -> np.ndarray:
        out = tmp_path / "still.png"
        assert cli.main(["picture", str(run.path), "--out", str(out), *more]) == 0
        return np.round(255 * matplotlib.image.imread(out)[..., :3])

    # The speed is 1 + y^2
    blue = np.array(style.rgb(style.ISO), dtype=int)
    shown = still("--iso", "speed=3", "--camera", "0", "0")
    is_blue = (shown[..., 2] - shown[..., 0] > 0.3 * (blue[2] - blue[0])) & (
        shown.sum(axis=2) < 740
    )
    assert is_blue.sum() > 500
    columns = []
    for time in ("0", "0.8"):
        picture = still(
            "--follow",
            "ball",
            "--surface",
            "--time",
            time,
            "--camera",
            "-90",
            "0",
            "--quantity",
            "speed",
        )
        dark = picture.sum(axis=2)[200:-300, 200:-500] < 700
        columns.append(np.flatnonzero(dark.any(axis=0)).mean())
    # The block stands still, and goes to the left as seen from the ball
    assert columns[1] < columns[0] - 50
    out = str(tmp_path / "still.png")
    assert cli.main(["picture", str(run.path), "--out", out, "--follow", "nobody"]) == 2
    assert "no body or swimmer nobody to follow; there are ball" in capsys.readouterr().err
    assert cli.main(["picture", str(run.path), "--out", out, "--iso", "pressure"]) == 2


def test_bodies_that_cross_a_periodic_side_have_their_arrows_with_them(run: Run) -> None:
    other = Run(run.path)
    case = {**run.case, "boundary": {"left": {"periodic": "right"}}}
    body = {**case["body"][0], "gait": {"squirmer": {"modes": [1.0]}}}
    other.__dict__["case"] = {**case, "body": [body]}
    history = other.bodies["ball"]
    far = replace(history, center=history.center + np.array([30.0, 0.0, 0.0]))
    other.__dict__["_bodies_and_shapes"] = ({"ball": far}, other.shapes)
    ((arrow, _),) = space.motion(other, 0.0, 10.0)
    start = 1.5 + bodies.CLEAR * bodies.ARROW * 10.0
    assert np.asarray(arrow.points)[:, 0].min() == pytest.approx(start, abs=1e-3)


@pytest.mark.skipif(not CAN_RENDER, reason="VTK has no window here")
def test_bodies_that_only_the_mesh_knows_are_read_once_a_frame(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    read = []
    real = camera.read_field
    monkeypatch.setattr(camera, "read_field", lambda path: read.append(path) or real(path))
    monkeypatch.setattr(camera.bodies, "shape", lambda *_: None)
    history = run.bodies["ball"]
    run.bodies.update({f"ball-{nth}": history for nth in range(3)})
    moments = chosen_moments(run, film.Request(quantity="speed"))
    seen = camera.seen(run, moments, film.Request(quantity="speed"), np.zeros((len(moments), 3)))
    assert read == [moment.path for moment in moments]
    # The block from 1 to 2
    assert seen.points.min(axis=0) == pytest.approx(np.ones(3))
    assert seen.points.max(axis=0) == pytest.approx(2 * np.ones(3))
