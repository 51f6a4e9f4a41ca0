"""Films: frames at the times of what was written, one view, one scale of colours, honest errors."""

from __future__ import annotations

import shutil
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from conftest import CAN_RENDER, TIMES, ring, write_vtu
from PIL import Image

from alewife_post import Run, cli, film, movie, open_run, planar, style
from alewife_post.page import Bar, Page, fitting
from alewife_post.request import chosen_moments, offsets

imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")

SMALL = (240, 180)
NEEDS_WINDOW = pytest.mark.skipif(not CAN_RENDER, reason="VTK can have no window here")


def frames_of(path: Path) -> tuple[dict, np.ndarray]:
    """What a film in MP4 says of itself, and its frames `(n, height, width, 3)`."""
    reader = imageio_ffmpeg.read_frames(str(path))
    about = next(reader)
    width, height = about["size"]
    shown = [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in reader]
    return about, np.array(shown)


def colour_at(image: np.ndarray, colour: str, tolerance: int = 40) -> np.ndarray:
    """Which pixels have a colour, about."""
    away = np.abs(image.astype(int) - style.rgb(colour).astype(int))
    return (away < tolerance).all(axis=-1)


@pytest.fixture
def growing(planar_run: Run, tmp_path: Path) -> Run:
    """The run of a disc with six field files, the pressure of each larger than before."""
    path = tmp_path / "growing"
    shutil.copytree(planar_run.path, path)
    nodes, cells = ring()
    sets = ""
    for k in range(6):
        write_vtu(path / f"fields/{k:06}.vtu", nodes, cells, 0.4 * k, scale=k + 1.0)
        sets += f'<DataSet timestep="{0.4 * k}" part="0" file="fields/{k:06}.vtu"/>'
    (path / "fields.pvd").write_text(
        f'<VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>'
    )
    return open_run(path)


# ---- Files ---------------------------------------------------------------------------------------


def moving_square(n: int) -> list[np.ndarray]:
    images = []
    for k in range(n):
        image = np.full((64, 96, 3), 255, dtype=np.uint8)
        image[20:40, 4 * k : 4 * k + 20] = (200, 30, 30)
        images.append(image)
    return images


def test_an_mp4_is_h264_that_browsers_play(tmp_path: Path) -> None:
    out = tmp_path / "film.mp4"
    assert movie.write(out, iter(moving_square(12)), 8.0) == 12
    about, shown = frames_of(out)
    assert about["codec"] == "h264"
    assert about["pix_fmt"].startswith("yuv420p")
    assert about["fps"] == 8.0
    assert about["size"] == (96, 64)
    assert shown.shape == (12, 64, 96, 3)
    for k, image in enumerate(shown):
        columns = np.flatnonzero(colour_at(image[30], "#c81e1e"))
        assert abs(columns.min() - 4 * k) <= 1
        assert abs(columns.max() - (4 * k + 19)) <= 1
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]


def test_a_gif_goes_round_and_leaves_white_white(tmp_path: Path) -> None:
    out = tmp_path / "film.gif"
    assert movie.write(out, iter(moving_square(7)), 10.0) == 7
    shown = Image.open(out)
    assert shown.n_frames == 7
    assert shown.info["duration"] == 100
    assert shown.info["loop"] == 0
    shown.seek(5)
    assert np.asarray(shown.convert("RGB"))[2, 2].tolist() == [255, 255, 255]
    # Beside many other light colours, too
    shades = np.linspace(200, 255, 96).astype(np.uint8)
    light = [np.repeat(np.tile(shades, (64, 1))[..., None], 3, axis=2) for _ in range(2)]
    light = [np.where(np.arange(64)[:, None, None] < 20, np.uint8(255), one) for one in light]
    movie.write(out, iter(light), 10.0)
    shown = np.asarray(Image.open(out).convert("RGB"))
    assert (shown[:20] == 255).all()
    assert np.abs(shown[20:].astype(int) - light[0][20:]).max() <= 12


def test_a_gif_has_colours_its_first_frame_lacks(tmp_path: Path) -> None:
    # A frame of blues and yellows only, as of a speed; then the way of a body
    blues = np.linspace(0, 255, 96).astype(np.uint8)
    first = np.stack([np.tile(blues, (64, 1))] * 2 + [np.full((64, 96), 110, np.uint8)], axis=2)
    second = first.copy()
    second[30:34] = style.rgb(style.TRAIL)
    out = tmp_path / "film.gif"
    movie.write(out, iter([first, second]), 10.0)
    shown = Image.open(out)
    shown.seek(1)
    image = np.asarray(shown.convert("RGB"))
    assert colour_at(image[30:34], style.TRAIL, 12).all()
    assert np.abs(image[:28].astype(int) - first[:28]).max() <= 12


def test_a_gif_that_begins_at_rest_has_all_shades_of_its_bar(tmp_path: Path) -> None:
    # One colour and a narrow bar; then all the colours of the bar
    shades = np.linspace(0, 1, 400)
    colours = (255 * matplotlib.colormaps["RdBu_r"](shades)[:, :3]).astype(np.uint8)
    first = np.full((400, 640, 3), colours[200], np.uint8)
    first[:, -20:-8] = colours[:, None]
    second = first.copy()
    second[:, :600] = np.tile(colours[:, None], (1, 600, 1))
    out = tmp_path / "film.gif"
    movie.write(out, iter([first, second]), 10.0)
    shown = Image.open(out)
    shown.seek(1)
    image = np.asarray(shown.convert("RGB"))
    assert np.abs(image.astype(int) - second).max() <= 6


def test_a_film_that_fails_leaves_nothing_behind(tmp_path: Path) -> None:
    def images():  # noqa: ANN202
        yield moving_square(1)[0]
        raise ValueError("no more")

    for name in ("film.mp4", "film.gif"):
        with pytest.raises(ValueError, match="no more"):
            movie.write(tmp_path / name, images(), 8.0)
    assert list(tmp_path.iterdir()) == []


# ---- Frames --------------------------------------------------------------------------------------


def test_frames_have_times_of_what_was_written(growing: Run) -> None:
    moments = chosen_moments(growing, film.Request(quantity="pressure"))
    assert [moment.time for moment in moments] == pytest.approx([0.4 * k for k in range(6)])
    assert [moment.path for moment in moments] == [frame.path for frame in growing.fields]
    # Fewer frames are spread over all of the time, and none lies between two fields
    moments = chosen_moments(growing, film.Request(quantity="pressure", frames=3))
    assert [moment.time for moment in moments] == pytest.approx([0.0, 0.8, 2.0])
    moments = chosen_moments(growing, film.Request(quantity="bodies", window=(1.0, 2.0)))
    assert [moment.time for moment in moments] == pytest.approx(TIMES[10:21])
    with pytest.raises(ValueError, match="nothing between t = 7 and 8: there is t = 0 to 2"):
        chosen_moments(growing, film.Request(quantity="speed", window=(7.0, 8.0)))


def test_frames_are_evenly_spaced_in_time_though_fields_are_not(growing: Run) -> None:
    frames = growing.fields
    uneven = [0.0, 0.1, 0.2, 0.3, 0.5, 2.0]
    growing.__dict__["fields"] = [
        type(frame)(time, frame.path) for frame, time in zip(frames, uneven, strict=True)
    ]
    moments = chosen_moments(growing, film.Request(quantity="speed"))
    # Nearest to 0, 0.4, 0.8, 1.2, 1.6, 2.0: the flow stays as long as it was not written
    assert [moment.time for moment in moments] == [0.0, 0.5, 0.5, 0.5, 2.0, 2.0]


def test_colours_mean_the_same_in_all_frames(growing: Run, tmp_path: Path) -> None:
    out = tmp_path / "film.mp4"
    request = film.Request(quantity="pressure", size=(360, 270), painter="matplotlib")
    assert film.film(growing, out, request, lambda text: None) == 6
    _, shown = frames_of(out)
    # The pressure on the left, where the disc does not go, is 1 to 6 times that of the first
    # frame: ever farther from white, and strong in the last frame only. A scale of each frame's
    # own would make all frames alike.
    left = shown[:, 160, 80, :].astype(float)
    away = 255 - left.min(axis=1)
    assert (np.diff(away) > 5).all()
    assert away[0] < 0.35 * away[-1]
    # And the view stands still: the outline of the fluid is where it was
    dark = shown[:, :, :, 0] < 90
    columns = [np.flatnonzero(image[135]) for image in dark]
    assert len({(found.min(), found.max()) for found in columns}) == 1


def test_a_run_with_few_fields_is_shown_by_its_bodies(planar_run: Run, tmp_path: Path) -> None:
    messages: list[str] = []
    out = tmp_path / "film.mp4"
    n = film.film(
        planar_run, out, film.Request(size=SMALL, frames=8, trails=False), messages.append
    )
    assert n == 8
    assert "2 field files only" in messages[0]
    assert "output.fields" in messages[0]
    _, shown = frames_of(out)
    middles = [
        np.flatnonzero(colour_at(image, style.SERIES[0]).any(axis=0)).mean() for image in shown
    ]
    # It moves evenly to the right until the view, which is that of the domain, cuts it
    steps = np.diff(middles[:4])
    assert steps.min() > 3
    assert steps.max() - steps.min() <= 1.5


def test_who_is_followed_stays_where_it_is(planar_run: Run, tmp_path: Path) -> None:
    out = tmp_path / "film.mp4"
    request = film.Request(
        quantity="bodies",
        follow="disc",
        size=SMALL,
        frames=6,
        trails=False,
        view=(-1.6, 1.6, -1.2, 1.2),
    )
    film.film(planar_run, out, request, lambda text: None)
    _, shown = frames_of(out)
    places = [np.argwhere(colour_at(image, style.SERIES[0])) for image in shown]
    for place in places[1:]:
        np.testing.assert_allclose(place.min(axis=0), places[0].min(axis=0), atol=1)
        np.testing.assert_allclose(place.max(axis=0), places[0].max(axis=0), atol=1)


def test_a_view_that_follows_stops_at_the_end_of_the_domain(growing: Run) -> None:
    # The disc goes from 0 to 1 along x; a body half as large has a view half as wide
    request = film.Request(quantity="speed", follow="disc", is_asked=True)
    moments = chosen_moments(growing, request)
    moved = 3.0 * offsets(growing, "disc", moments)[:, :2]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planar, "followed_view", lambda *_: (-0.8, 0.8, -0.6, 0.6))
        view, back = planar.views(growing, moments, request, moved)
    ends = view[1] + moved[:, 0] + back[:, 0]
    assert ends == pytest.approx(np.minimum(0.8 + moved[:, 0], 2.0))
    assert np.abs(back[:3]).max() < 1e-12
    assert back[-1, 0] == pytest.approx(2.0 - 0.8 - 3.0)


@pytest.mark.parametrize("quantity", ["speed", "mesh", "vorticity"])
@pytest.mark.parametrize("painter", ["matplotlib", pytest.param("vtk", marks=NEEDS_WINDOW)])
def test_each_quantity_can_be_filmed(
    axisymmetric_run: Run, tmp_path: Path, quantity: str, painter: str
) -> None:
    out = tmp_path / "film.gif"
    arguments = [str(axisymmetric_run.path), "--out", str(out), "--quantity", quantity]
    assert cli.film_command([*arguments, "--painter", painter, "--size", "240x180"]) == 0
    shown = Image.open(out)
    assert shown.n_frames == 2
    assert shown.size == SMALL
    assert np.asarray(shown.convert("RGB")).std() > 20


def test_pages_fit_what_is_seen() -> None:
    for aspect in (0.2, 0.7, 1.0, 1.8, 2.2, 6.0):
        for has_bar in (False, True):
            width, height = fitting(aspect, has_bar)
            assert width % 2 == height % 2 == 0
            assert width <= 960
            assert height <= 720
            bar = Bar("viridis", (0.0, 1.0), np.array([0.0, 1.0]), "speed")
            page = Page(None, "A title", aspect, bar if has_bar else None)
            across, up = page.pixels
            assert abs(across / up / aspect - 1) < 0.03
            image = page.image("t = 1")
            assert image.shape == (height, width, 3)


# ---- Runs that are not whole ---------------------------------------------------------------------


def test_a_killed_run_is_filmed_as_far_as_it_was_written(planar_run: Run, tmp_path: Path) -> None:
    path = tmp_path / "killed"
    shutil.copytree(planar_run.path, path)
    whole = (path / "run.mcap").read_bytes()
    (path / "run.mcap").write_bytes(whole[: 2 * len(whole) // 3])
    (path / "status.json").unlink()
    (path / "fields.pvd").unlink()
    run = open_run(path)
    n = len(run.bodies["disc"].time)
    assert 1 < n < len(TIMES)
    out = tmp_path / "film.mp4"
    assert film.film(run, out, film.Request(size=SMALL), lambda text: None) == n


def test_a_run_with_one_field_and_no_messages_is_one_frame(growing: Run, tmp_path: Path) -> None:
    (growing.path / "run.mcap").unlink()
    for frame in growing.fields[1:]:
        frame.path.unlink()
    run = open_run(growing.path)
    out = tmp_path / "film.mp4"
    with pytest.raises(ValueError, match="one frame only of speed"):
        film.film(run, out, film.Request(size=SMALL), lambda text: None)
    # Unless it is asked for
    assert film.film(run, out, film.Request(size=SMALL, frames=1), lambda text: None) == 1
    assert frames_of(out)[1].shape[0] == 1


def test_what_cannot_be_filmed_is_answered_with_what_can(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bare = tmp_path / "bare"
    shutil.copytree(planar_run.path, bare)
    (bare / "fields.pvd").unlink()
    empty = tmp_path / "empty"
    shutil.copytree(bare, empty)
    (empty / "run.mcap").unlink()

    def answer(path: Path, *more: str) -> str:
        capsys.readouterr()
        arguments = ["film", str(path), "--out", str(tmp_path / "film.mp4"), "--size", "240x180"]
        assert cli.main([*arguments, *more]) == 2
        return capsys.readouterr().err

    assert "bodies can be shown: --quantity bodies" in answer(bare, "--quantity", "pressure")
    assert "nothing to film" in answer(empty)
    assert "quantities of its fields: none" in answer(empty, "--quantity", "bodies")
    assert "there are disc" in answer(bare, "--follow", "fish")
    assert "for runs in space" in answer(bare, "--slice", "z=0")
    assert "its name ends with .mp4 or .gif" in answer(bare, "--out", str(tmp_path / "film.avi"))
    assert "there is no directory" in answer(bare, "--out", str(tmp_path / "no" / "film.mp4"))
    assert "even" in answer(bare, "--size", "241x180")
    assert "between 0.1 and 100" in answer(bare, "--fps", "0")
    assert "no case.toml" in answer(tmp_path)
    assert not (tmp_path / "film.mp4").exists()


def test_a_missing_encoder_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with pytest.raises(ValueError, match="imageio-ffmpeg"):
        movie.check(tmp_path / "film.mp4")
    movie.check(tmp_path / "film.gif")


def test_older_names_of_the_command_do_the_same(planar_run: Run, tmp_path: Path) -> None:
    for command, name, more in (
        (cli.picture, "picture", ["--painter", "matplotlib", "--lines", "none"]),
        (cli.series, "series", ["--quantity", "disc.speed"]),
    ):
        old, new = tmp_path / f"{name}-old.png", tmp_path / f"{name}-new.png"
        assert command([str(planar_run.path), "--out", str(old), *more]) == 0
        assert cli.main([name, str(planar_run.path), "--out", str(new), *more]) == 0
        assert (np.asarray(Image.open(old)) == np.asarray(Image.open(new))).all()


def test_a_picture_is_no_film(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["picture", str(planar_run.path), "--out", str(tmp_path / "film.mp4")]
    assert cli.main([*arguments, "--painter", "matplotlib", "--lines", "none"]) == 2
    assert "alewife-post film" in capsys.readouterr().err


def test_a_followed_body_in_a_periodic_box_goes_on_through_its_sides(
    planar_run: Run, tmp_path: Path
) -> None:
    path = tmp_path / "periodic"
    shutil.copytree(planar_run.path, path)
    text = (path / "case.toml").read_text()
    box = "[domain.box]\nmin = [-1.0, -2.0]\nmax = [1.5, 2.0]\n"
    sides = '[boundary]\nleft = { periodic = "right" }\nbottom = { periodic = "top" }\n'
    (path / "case.toml").write_text(text.replace("[domain.disc]\nradius = 2.0\n", box + sides))
    out = tmp_path / "film.mp4"
    # It goes from 0 to 2, out at 1.5; at rest it is in the middle, with its images beside it
    for follow in (["--follow", "disc"], []):
        arguments = ["film", str(path), "--quantity", "bodies", "--out", str(out), "--no-trails"]
        assert cli.main([*arguments, "--size", "480x360", "--frames", "5", *follow]) == 0
        _, shown = frames_of(out)
        areas = [colour_at(image, style.SERIES[0], 60).sum() for image in shown]
        # The view is one period wide: whatever leaves it on one side comes in on the other
        assert max(areas) < 1.05 * min(areas)


def test_bodies_are_where_the_mesh_has_them_if_no_message_tells(
    growing: Run, tmp_path: Path
) -> None:
    # Fields of t = 0, 0.4, ..., 2 and messages up to 0.8 alone: frames end there
    history = growing.bodies["disc"]
    kept = history.time < 0.85
    for name, values in list(vars(history).items()):
        object.__setattr__(history, name, values[kept])
    moments = chosen_moments(growing, film.Request(quantity="pressure"))
    assert [moment.time for moment in moments] == pytest.approx([0.0, 0.4, 0.8])
    # The hole of the mesh is about the origin, wherever a message of another time has the disc
    out = tmp_path / "film.mp4"
    history.time[:] = np.linspace(0.13, 0.93, kept.sum())
    request = film.Request(quantity="pressure", painter="matplotlib", trails=False)
    film.film(growing, out, request, lambda text: None)
    _, shown = frames_of(out)
    for image in shown:
        is_body = colour_at(image, style.BODY, 12)
        columns = np.flatnonzero(is_body.sum(axis=0) > 100)
        first = np.flatnonzero(colour_at(shown[0], style.BODY, 12).sum(axis=0) > 100)
        # Columns at the rim count or not by the compression; messages have it tens of pixels away.
        assert abs(columns.mean() - first.mean()) < 2.0
