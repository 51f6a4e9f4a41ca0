"""Pictures and films of soft bodies, in the plane, around an axis and in space."""

from pathlib import Path

import numpy as np
import pytest
from conftest import CAN_RENDER
from matplotlib.colors import to_rgb
from PIL import Image

from alewife_post import cli, gallery, open_run, soft, style
from alewife_post.request import Request

TRIANGLE = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]], dtype=float)
OFFSET = np.array([0.0, 0.1])
TETRAHEDRON = np.array(
    [
        [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1],
        [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0], [0, 0, 0.5], [0.5, 0, 0.5], [0, 0.5, 0.5],
    ],
    dtype=float,
)  # fmt: skip


def write_run(place: Path, geometry: str, n_frames: int = 3) -> Path:
    """A run whose body is stretched along x by half its time."""
    import pyvista

    is_spatial = geometry == "spatial"
    rest = TETRAHEDRON if is_spatial else TRIANGLE + OFFSET
    (place / "fields").mkdir(parents=True)
    (place / "case.toml").write_text(
        f"title = 'a {geometry} body'\ngeometry = '{geometry}'\nunits = 'SI'\n"
        "[soft]\nframe = 0.5\nframes = 2\n"
    )
    (place / "status.json").write_text("{}")
    sets = []
    for frame in range(n_frames):
        time = 0.5 * frame
        moved = 0.5 * time * rest[:, :1] * np.eye(rest.shape[1])[0]
        points = np.zeros((len(rest), 3))
        points[:, : rest.shape[1]] = rest + moved
        kind = 24 if is_spatial else 22
        grid = pyvista.UnstructuredGrid({kind: np.arange(len(rest))[None]}, points)
        grid.point_data["displacement"] = moved
        grid.point_data["velocity"] = 2.0 * moved
        grid.cell_data["strain"] = [0.3 * time]
        grid.cell_data["volume-ratio"] = [1.0 + 0.5 * time]
        grid.field_data["TimeValue"] = [time]
        grid.save(place / f"fields/frame-{frame:04}.vtu")
        sets.append(f'<DataSet timestep="{time}" file="fields/frame-{frame:04}.vtu"/>')
    (place / "fields.pvd").write_text(
        '<VTKFile type="Collection"><Collection>' + "".join(sets) + "</Collection></VTKFile>"
    )
    return place


def test_a_body_is_read_with_where_it_was_at_rest(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", "planar"))
    assert [frame.time for frame in run.frames] == [0.0, 0.5, 1.0]
    found = soft.body(run, run.frame_at(0.6), "displacement")
    assert found.time == 0.5
    np.testing.assert_allclose(found.rest, TRIANGLE + OFFSET, atol=1e-15)
    np.testing.assert_allclose(found.values, 0.25 * TRIANGLE[:, 0], atol=1e-15)
    strain = soft.body(run, run.frame_at(None), "strain").values
    np.testing.assert_allclose(strain, 0.3)
    with pytest.raises(ValueError, match=r"poisson = 0\.5"):
        soft.body(run, run.frame_at(None), "pressure")
    with pytest.raises(ValueError, match="displacement, strain"):
        soft.body(run, run.frame_at(None), "vorticity")


def test_values_at_nodes_are_means_of_the_cells_around() -> None:
    cells = np.array([[0, 1, 2], [1, 2, 3]])
    np.testing.assert_allclose(soft._at_nodes(np.array([1.0, 3.0]), cells, 4), [1, 2, 2, 3])


def test_the_skin_of_a_cell_in_space_is_closed_and_has_its_area() -> None:
    skin = soft.skin(np.arange(10)[None])
    corners = TETRAHEDRON[skin]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.linalg.norm(normals, axis=1).sum()
    assert len(skin) == 16
    assert area == pytest.approx(1.5 + np.sqrt(3.0) / 2.0)
    outwards = corners.mean(axis=1) - TETRAHEDRON[:4].mean(axis=0)
    assert ((normals * outwards).sum(axis=1) > 0).all()


def test_colours_of_a_picture_are_those_of_the_displacement(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", "planar"))
    figure = soft.picture(run, view=(0.0, 1.5, 0.1, 1.1))
    figure.savefig(tmp_path / "a.png", dpi=100)
    image = np.asarray(Image.open(tmp_path / "a.png").convert("RGB")) / 255.0
    box = figure.axes[0].get_position()
    height, width = image.shape[:2]

    def colour(x: float, y: float) -> np.ndarray:
        across = box.x0 + box.width * x / 1.5
        up = box.y0 + box.height * (y - 0.1)
        return image[round(height * (1.0 - up)), round(width * across)]

    # Below the middle, at 0.15 of 0.5 of the largest displacement, and beside the body
    assert np.abs(colour(0.45, 0.2) - to_rgb("#3b528b")).max() < 0.15
    assert np.abs(colour(1.4, 1.0) - 1.0).max() < 0.05


@pytest.mark.parametrize("geometry", ["planar", "axisymmetric", "spatial"])
def test_the_commands_draw_a_soft_run(geometry: str, tmp_path: Path) -> None:
    if geometry == "spatial" and not CAN_RENDER:
        pytest.skip("VTK can have no window here")
    run = str(write_run(tmp_path / "runs" / geometry, geometry))
    for quantity in ("displacement", "strain", "speed", "volume-ratio", "mesh"):
        out = tmp_path / f"{quantity}.png"
        assert cli.main(["picture", run, "--quantity", quantity, "--out", str(out)]) == 0
        assert np.asarray(Image.open(out)).std() > 10
    out = tmp_path / "a.gif"
    assert cli.main(["film", run, "--out", str(out)]) == 0
    assert Image.open(out).n_frames == 3
    assert [name for name, failure in gallery.gallery(tmp_path / "runs", tmp_path) if not failure]


def test_frames_of_a_film_are_even_and_share_a_scale(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", "axisymmetric"))
    bodies = [soft.body(run, frame, "displacement") for frame in run.frames]
    look = soft._look(run, bodies, "displacement", Request())
    assert look.limits == pytest.approx((0.0, 0.5))
    assert look.view[2] == pytest.approx(-look.view[3])
    shapes = {image.shape for image in soft._images(run, bodies, look)}
    assert len(shapes) == 1
    assert all(side % 2 == 0 for side in shapes.pop()[:2])


def test_what_is_asked_of_a_flow_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = str(write_run(tmp_path / "run", "planar"))
    out = ["--out", str(tmp_path / "a.png")]
    for arguments, cure in (
        (["--quantity", "vorticity"], "displacement, strain"),
        (["--slice", "z=0"], "--slice: of runs with a flow"),
        (["--camera", "1", "2"], "--camera is for runs in space"),
        (["--time", "9"], "t = 9 is not in"),
        ([run], "draw one by one"),
    ):
        assert cli.main(["picture", run, *arguments, *out]) == 2
        error = capsys.readouterr().err
        assert cure in error
        assert error.count("\n") == 1
    one = str(write_run(tmp_path / "one", "planar", 1))
    assert cli.main(["film", one, "--out", str(tmp_path / "a.gif")]) == 2
    assert "alewife-post picture draws it" in capsys.readouterr().err
    assert style.look_of("strain").label == "equivalent strain"


def test_a_soft_run_is_inspected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = write_run(tmp_path / "run", "planar")
    (run / "series.csv").write_text("time,tip.x\n0.0,0.0\n0.5,0.1\n1.0,0.3\n")
    (run / "status.json").write_text('{"state": "finished", "fidelity": "soft"}')
    (run / "comparison.json").write_text(
        '[{"quantity": "tip.x", "reference": 0.2, "allowed": 0.01, "kind": "exact", '
        '"source": "nobody", "computed": 0.3, "within": false}]'
    )
    assert cli.main(["inspect", str(run)]) == 0
    text = capsys.readouterr().out
    assert "planar, soft, unsteady" in text
    assert "1 references: 1 OUTSIDE" in text
    assert "fields    3 files, t = 0 to 1" in text
