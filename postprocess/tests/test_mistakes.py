"""Calls of a new user that are wrong: what was given, what is accepted and the cure are named."""

from __future__ import annotations

import copy
import pickle
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import alewife
from alewife_post import (
    Run,
    cli,
    comparison_table,
    figure,
    film,
    grid,
    open_run,
    series,
    slices,
    space,
    trajectories,
)

CASE = alewife.Case("squirmer-alone")


def message(kind: type[Exception], call: Callable[[], object]) -> str:
    """What an exception of a kind says."""
    with pytest.raises(kind) as raised:
        call()
    return str(raised.value)


# ---- Names ---------------------------------------------------------------------------------------


def test_names_a_run_has_not_are_told_with_those_that_are_near(planar_run: Run) -> None:
    for found, name, cure in (
        (planar_run.quantities, "disk.speed", "no quantity disk.speed; nearest: disc.speed; list("),
        (planar_run.series, "disc.sped", "no column disc.sped; nearest: disc.speed; list(run.ser"),
        (planar_run.bodies, "fish", "no body fish; there are disc; list(run.bodies) gives all 1"),
        (planar_run.shapes, "fish", "no body fish: there is none"),
        (planar_run.series, 3, "no column 3; there are time, disc.speed"),
    ):
        assert message(KeyError, lambda found=found, name=name: found[name]).startswith(cure)
        # They are dictionaries otherwise
        assert name not in found
        assert found.get(name) is None
        assert isinstance(found, dict)
    assert planar_run.quantities["disc.speed"] == planar_run.series["disc.speed"][-1]
    for again in (copy.copy(planar_run.quantities), pickle.loads(pickle.dumps(planar_run.bodies))):
        assert "list(run." in message(KeyError, lambda again=again: again["fish"])


def test_names_in_pictures_are_told_without_quotes(planar_run: Run) -> None:
    calls = (
        lambda: figure.picture(planar_run, frame="fish", painter="matplotlib"),
        lambda: figure.picture(planar_run, follow="fish", painter="matplotlib"),
        lambda: series.series_figure(planar_run, ["disc.sped"]),
    )
    for call in calls:
        assert message(KeyError, call).startswith("no ")


def test_one_name_is_no_list_of_letters(planar_run: Run, tmp_path: Path) -> None:
    assert len(series.series_figure(planar_run, "disc.speed").axes) == 1
    assert "fish" in message(KeyError, lambda: trajectories.trajectory_figure(planar_run, "fish"))
    path = tmp_path / "none"
    assert (
        message(FileNotFoundError, lambda: comparison_table(str(path))) == f"{path} does not exist"
    )


def test_choices_are_listed(planar_run: Run) -> None:
    def drawn(**options: str) -> str:
        return message(ValueError, lambda: figure.picture(planar_run, **options))

    assert drawn(quantity="velocity") == (
        "no quantity velocity; there are speed, pressure, vorticity, shear-rate, q, mesh, "
        "traction, wall-shear"
    )
    assert drawn(lines="streamline").endswith("there are streamlines, arrows, none")
    assert drawn(painter="mpl") == "no painter mpl; there are auto, vtk, matplotlib"


# ---- Numbers -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("view", "cure"),
    [
        ((1, 2), "view 1 2: four numbers are accepted, xmin xmax ymin ymax"),
        ("all", "view 'all': four numbers are accepted"),
        (3.0, "view 3.0: four numbers are accepted"),
        ((0, np.nan, 0, 1), "four numbers are accepted"),
        ((5, 1, 0, 2), "xmin = 5 is above xmax = 1; the order is xmin xmax ymin ymax, so 1 5 0 2"),
        ((1, 5, 2, 0), "ymin = 2 is above ymax = 0; the order is xmin xmax ymin ymax, so 1 5 0 2"),
        ((1, 1, 0, 2), "view 1 1 0 2: it has no extent in x"),
    ],
)
def test_views_are_four_numbers_in_order(
    planar_run: Run, tmp_path: Path, view: object, cure: str
) -> None:
    out = tmp_path / "film.mp4"
    assert cure in message(ValueError, lambda: figure.picture(planar_run, view=view))
    assert cure in message(ValueError, lambda: film.film(planar_run, out, film.Request(view=view)))


def test_windows_and_times_are_numbers_in_order(planar_run: Run, tmp_path: Path) -> None:
    for window, cure in (
        (3, "window 3: two numbers are accepted"),
        ((3, 1), "window 3 1: its first time is after its last one; write 1 3"),
    ):
        request = film.Request(window=window)
        for call in (
            lambda window=window: series.series_figure(planar_run, window=window),
            lambda request=request: film.film(planar_run, tmp_path / "film.mp4", request),
        ):
            assert cure in message(ValueError, call)
    cure = "time 'last': a number is accepted, or None for the last frame"
    assert message(TypeError, lambda: planar_run.field("last")) == cure


# ---- Runs ----------------------------------------------------------------------------------------


def test_a_directory_is_no_run_and_a_run_no_field(planar_run: Run, tmp_path: Path) -> None:
    path = str(planar_run.path)
    cure = f"{path!r} is no run: alewife_post.open_run({path!r}) is one"
    for call in (
        lambda: figure.picture(path),
        lambda: series.series_figure(path),
        lambda: series.energy_figure(path),
        lambda: trajectories.trajectory_figure(path),
        lambda: film.film(path, tmp_path / "film.mp4", film.Request()),
    ):
        assert message(TypeError, call) == cure
    assert "field(TIME) of a run gives one" in message(TypeError, lambda: grid(planar_run))
    assert list(Run(path).series) == ["time", "disc.speed"]


def test_pictures_name_those_of_the_other_dimension(planar_run: Run, tmp_path: Path) -> None:
    for picture in (slices.slice_picture, space.surface_picture):
        text = message(ValueError, lambda picture=picture: picture(planar_run))
        assert text.endswith("is a run in the plane or about an axis: figure.picture draws it")
    other = tmp_path / "space"
    shutil.copytree(planar_run.path, other)
    case = other / "case.toml"
    case.write_text(case.read_text().replace('"planar"', '"spatial"'))
    run = open_run(other)
    assert "slices.slice_picture" in message(ValueError, lambda: figure.picture(run))
    assert "xmin xmax" in message(ValueError, lambda: slices.slice_picture(run, view=(1, 2)))


@pytest.mark.parametrize("package", ["pandas", "pyvista"])
def test_a_missing_package_is_told_with_its_extra(
    planar_run: Run, monkeypatch: pytest.MonkeyPatch, package: str
) -> None:
    calls = {"pandas": (planar_run.to_dataframe, "table"), "pyvista": (planar_run.field, "picture")}
    call, extra = calls[package]
    monkeypatch.setitem(sys.modules, package, None)
    text = message(ModuleNotFoundError, call)
    assert text.startswith(f"the package {package} is not installed: pip install 'alewife[{extra}")


# ---- Cases and sweeps ----------------------------------------------------------------------------


@pytest.mark.parametrize("value", [2.0, "thick", {"a": 1}, np.array(2.0)])
def test_a_sweep_takes_lists_of_values(value: object) -> None:
    text = message(TypeError, lambda: alewife.sweep(CASE, {"fluid.viscosity": value}))
    assert text.startswith(f"fluid.viscosity: {value!r} is one value; a list of values is accepted")
    assert f"case.set('fluid.viscosity', {value!r})" in text


def test_a_sweep_takes_a_case_and_a_grid(monkeypatch: pytest.MonkeyPatch) -> None:
    text = message(TypeError, lambda: alewife.sweep(CASE, ["fluid.viscosity"]))
    assert "such as {'fluid.viscosity': [1.0, 2.0]}" in text
    text = message(TypeError, lambda: alewife.sweep("squirmer-alone", {}))
    assert text == "'squirmer-alone' is no case: alewife.load('squirmer-alone') is one"
    given: list[str] = []

    def call(*arguments: object, **_: object) -> str:
        given.extend(map(str, arguments))
        raise KeyboardInterrupt

    monkeypatch.setattr(sys.modules["alewife.sweep"], "call", call)
    with pytest.raises(KeyboardInterrupt):
        alewife.sweep(CASE, {"fluid.viscosity": range(2)}, quantities="squirmer.power")
    assert 'sweep.quantities=["squirmer.power"]' in given
    assert 'sweep.grid={ "fluid.viscosity" = [0, 1] }' in given


def test_settings_are_refused_where_they_are_made() -> None:
    for key, value, cure in (
        (3, 4, "3: a key such as 'fluid.viscosity' and its value are accepted, or a dictionary"),
        ([("fluid.viscosity", 2)], None, "a key such as 'fluid.viscosity'"),
        ({3: 4}, None, "3 is no key"),
        ("fluid.viscosity", b"2", "fluid.viscosity: b'2': a number, a text"),
        ("fluid.viscosity", [object()], "fluid.viscosity: <object"),
    ):
        assert cure in message(TypeError, lambda key=key, value=value: CASE.set(key, value))
    given = CASE.set("fluid.viscosity", np.array(2.0)).arguments()
    assert given[-1] == "fluid.viscosity=2.0"


# ---- The command ---------------------------------------------------------------------------------


def steady(run: Run, path: Path) -> Path:
    """A copy of a run that is steady, of one frame."""
    shutil.copytree(run.path, path)
    case = path / "case.toml"
    text = case.read_text()
    case.write_text(text.replace("[time.unsteady]\nstep = 0.1\nend = 4.0", "[time.steady]"))
    (path / "run.mcap").unlink()
    (path / "fields/000040.vtu").unlink()
    return path


def test_one_frame_is_no_film(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = steady(planar_run, tmp_path / "still"), tmp_path / "film.mp4"
    assert cli.main(["film", str(path), "--out", str(out)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    cure = f"alewife-post picture {path} --out {out.with_suffix('.png')}"
    assert f"{path} is steady: it has one frame only, which is no film; draw a picture: {cure}" in (
        error
    )
    # Of a run in time, more can be had
    for options, cure in (
        (["--quantity", "speed", "--window", "3", "4"], "a longer window may have more"),
        (["--quantity", "speed"], "output.fields of the case"),
    ):
        if "--window" not in options:
            run = tmp_path / "short"
            shutil.copytree(planar_run.path, run)
            (run / "fields/000040.vtu").unlink()
        else:
            run = planar_run.path
        assert cli.main(["film", str(run), "--out", str(out), *options]) == 2
        error = capsys.readouterr().err
        assert cure in error
        assert "draw a picture" in error
    assert not out.exists()


def test_the_command_names_what_is_wrong(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = ["--out", str(tmp_path / "a.png")]
    run = str(planar_run.path)
    for arguments, cure in (
        ([run, "--view", "5", "1", "0", "2"], "view 5 1 0 2: xmin = 5 is above xmax = 1"),
        ([str(tmp_path / "no")], "no does not exist"),
        ([str(tmp_path)], "is not a run: it has no case.toml"),
        ([run, "--quantity", "velocity"], ", ".join(figure.QUANTITIES)),
    ):
        assert cli.main(["picture", *arguments, *out]) == 2
        error = capsys.readouterr().err
        assert cure in error
        assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_soft_run_has_no_flow(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "run").mkdir()
    (tmp_path / "run/case.toml").write_text(
        "title = 'a bar'\ngeometry = 'planar'\n[soft]\nframe = 0.1\nframes = 2\n"
    )
    (tmp_path / "run/status.json").write_text("{}")
    run = str(tmp_path / "run")
    line = ["line", run, "--from", "0", "0", "--to", "1", "0", "--out", str(tmp_path / "a.csv")]
    assert cli.main(line) == 2
    assert "alewife-post picture, film and gallery draw its body" in capsys.readouterr().err
