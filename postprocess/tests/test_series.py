"""Curves over time: quantities by ending, references, transients, energy, paths."""

from pathlib import Path

import numpy as np
import pytest
from conftest import write_run

from alewife_post import Run, asked, cli, evidence, open_run, series, trajectories

SERIES = {
    "time": np.linspace(0.0, 1.0, 3),
    "a.y": np.array([1.0, 2.0, 3.0]),
    "a.velocity.y": np.array([0.0, 1.0, 0.0]),
    "b.y": np.array([0.5, 0.5, 0.5]),
    "b.velocity.y": np.array([2.0, 1.0, 2.0]),
    "flow.mass_defect": np.zeros(3),
}


def test_quantities_are_found_by_name_ending_pattern_and_difference() -> None:
    def names(text: str) -> list[str]:
        return [line.name for line in asked.lines(SERIES, text)]

    assert names("a.y") == ["a.y"]
    assert names("y") == ["a.y", "b.y"]
    assert names("velocity.y") == ["a.velocity.y", "b.velocity.y"]
    assert names("b.*, a.y") == ["b.y", "b.velocity.y", "a.y"]
    (line,) = asked.lines(SERIES, "a.y minus b.y")
    np.testing.assert_array_equal(line.values, [0.5, 1.5, 2.5])


def test_names_that_begin_so_are_suggested_first() -> None:
    columns = dict.fromkeys(["ball.angle", "ball.x", "ball.y", "ball.drag_coefficient"], np.ones(2))
    for part in ("ball.drag", "drag", "DRAG"):
        with pytest.raises(KeyError, match=rf"no quantity {part}; nearest: ball.drag_coefficient$"):
            asked.lines(columns, part)


def test_the_nearest_names_are_suggested() -> None:
    with pytest.raises(KeyError, match=r"no quantity velocty.y; nearest: .*a.velocity.y"):
        asked.lines(SERIES, "velocty.y")
    with pytest.raises(KeyError, match=r"no quantity c\.y"):
        asked.lines(SERIES, "a.y minus c.y")


def test_a_transient_at_the_start_is_cut_off_and_nothing_else() -> None:
    time = np.linspace(0.0, 1.0, 1001)
    steady = np.sin(40 * time)
    assert series.robust_limits([(time, steady)], []) is None
    limits = series.robust_limits([(time, steady + 100 * (time < 0.005))], [])
    assert limits is not None and -1.5 < limits[0] < -1 and 1 < limits[1] < 1.5
    # What comes late is no transient, and a reference is always in sight.
    assert series.robust_limits([(time, steady + 100 * (time > 0.9))], []) is None
    assert series.robust_limits([(time, steady + 100 * (time < 0.005))], [90.0]) is None


def test_a_reference_is_drawn_where_its_window_is_reached(planar_run: Run) -> None:
    for window, n_lines in (((0.0, 1.5), 1), ((0.0, 3.0), 2)):
        (axes,) = series.series_figure(planar_run, ["disc.speed"], window=window).axes
        assert len(axes.lines) == n_lines
        assert (axes.get_legend() is None) == (n_lines == 1)


def run_of(tmp_path: Path, columns: dict[str, np.ndarray]) -> Run:
    """A run with other rows."""
    write_run(tmp_path / "run", is_axisymmetric=False)
    rows = [
        ",".join(repr(float(value)) for value in row) for row in zip(*columns.values(), strict=True)
    ]
    (tmp_path / "run/series.csv").write_text("\n".join([",".join(columns), *rows]) + "\n")
    return open_run(tmp_path / "run")


def test_defects_are_drawn_only_if_asked_for(tmp_path: Path) -> None:
    columns = {"time": SERIES["time"], "flow.mass_defect": np.ones(3), "flow.cells": np.ones(3)}
    run = run_of(tmp_path, columns)
    assert series.suggested(run) == ["flow.cells"]
    assert len(series.series_figure(run, ["mass_defect"]).axes) == 1


def test_no_axis_is_offset(tmp_path: Path) -> None:
    columns = {"time": SERIES["time"], "disc.speed": 1000 + 1e-3 * SERIES["a.y"]}
    (axes,) = series.series_figure(run_of(tmp_path, columns), ["disc.speed"]).axes
    axes.figure.draw_without_rendering()
    assert not axes.yaxis.get_major_formatter().get_offset()


def test_the_last_cycle_is_a_period_of_what_is_prescribed(planar_run: Run, tmp_path: Path) -> None:
    write_run(tmp_path / "run", is_axisymmetric=False)
    run = open_run(tmp_path / "run")
    run.case["body"] = [{"gait": {"period": 1.5}}]
    assert evidence.cycle(run)[:2] == (2.5, 4.0)
    run.case["body"] = [{"gait": {"period": 15.0}}]
    assert evidence.cycle(run)[:2] == evidence.cycle(planar_run)[:2]


def test_paths_have_the_shape_of_what_they_show(tmp_path: Path) -> None:
    time = np.linspace(0.0, 1.0, 5)
    for number, (x, y) in enumerate(((time, 0 * time), (0 * time, 4 * time), (time, time))):
        run = run_of(tmp_path / str(number), {"time": time, "disc.x": x, "disc.y": y})
        drawn = trajectories.trajectory_figure(run)
        drawn.draw_without_rendering()
        (axes,) = drawn.axes
        np.testing.assert_array_equal(axes.lines[0].get_xdata(), x)
        np.testing.assert_array_equal(axes.lines[0].get_ydata(), y)
        box = axes.get_window_extent()
        ratio = (np.diff(axes.get_xlim()) / np.diff(axes.get_ylim()))[0]
        # A unit is as long across as it is upwards.
        assert box.width / box.height == pytest.approx(ratio, rel=1e-6)
        width, height = drawn.get_size_inches()
        assert (width > 2 * height, height > 1.5 * width) == [
            (True, False), (False, True), (False, False)
        ][number]  # fmt: skip
    with pytest.raises(KeyError, match="no body or swimmer disk; nearest: disc"):
        trajectories.trajectory_figure(run, ["disk"])


def test_energy_is_that_of_what_swims(tmp_path: Path) -> None:
    ones, none = np.ones(3), np.full(3, np.nan)
    columns = {"time": SERIES["time"], "fish.power": ones, "fish.shape_power": 2 * ones,
               "rock.power": ones, "flow.dissipation": ones, "fish.cycle.power": none}  # fmt: skip
    drawn = series.energy_figure(run_of(tmp_path, columns))
    (axes,) = drawn.axes
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["fish.power", "fish.shape power", "flow.dissipation"]


@pytest.mark.parametrize("name", ["plot", "series"])
def test_plot_by_both_names(name: str, planar_run: Run, tmp_path: Path) -> None:
    out = tmp_path / "out.svg"
    run = str(planar_run.path)
    assert cli.main([name, run, "speed", "--out", str(out)]) == 0
    again = tmp_path / "again.svg"
    assert cli.main([name, run, "--quantity", "speed", "--out", str(again)]) == 0
    assert out.stat().st_size == again.stat().st_size > 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again.svg", "out.svg"]


def test_what_cannot_be_drawn_is_one_line_and_code_two(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "case").mkdir()
    (tmp_path / "case/case.toml").write_text('title = "a case"\n')
    (tmp_path / "sweep").mkdir()
    (tmp_path / "sweep/sweep.json").write_text("{}")
    run = str(planar_run.path)
    for arguments, message in (
        ([str(tmp_path / "none")], "does not exist"),
        ([str(tmp_path)], "is not a run: it has no case.toml; there is case inside"),
        ([str(tmp_path / "case")], "is a case, not a run"),
        ([str(tmp_path / "sweep")], "is a sweep"),
        ([run, "disc.spede"], "no quantity disc.spede; nearest: disc.speed"),
        ([run, "--window", "7", "8"], "there is t = 0 to 4"),
        ([run, "--energy"], "neither power nor dissipation"),
        ([run, "--out", str(tmp_path / "a.xyz")], "xyz"),
        ([run, "--out", str(tmp_path / "no/a.png")], "no directory"),
        ([run, "--out", str(tmp_path / "a.mp4")], "alewife-post film"),
    ):
        assert cli.main(["plot", *arguments]) == 2
        error = capsys.readouterr().err
        assert message in error and error.count("\n") == 1, error
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case", "sweep"]


def test_quantities_may_stand_behind_options(planar_run: Run, tmp_path: Path) -> None:
    out = tmp_path / "way.png"
    command = ["plot", str(planar_run.path), "--whole", "--out", str(out)]
    assert cli.main([*command, "disc.speed"]) == 0
    assert out.is_file()
    # A name that is none is refused as before, and so are options that are not known
    assert cli.main([*command, "disk.speed"]) == 2
    for unknown in (["--wholly"], ["disc.speed", "--wholly"]):
        with pytest.raises(SystemExit) as ended:
            cli.main([*command, *unknown])
        assert ended.value.code == 2


@pytest.mark.parametrize(
    ("module", "remedy"),
    [
        (
            "matplotlib.figure",
            "matplotlib is not installed: pip install 'alewife[pictures]' (835 MB",
        ),
        ("imageio_ffmpeg", "imageio_ffmpeg is not installed: pip install 'alewife[film]' (903 MB"),
        ("pandas", "pandas is not installed: pip install 'alewife[table]'"),
        ("mcap.reader", "mcap is not installed: pip install alewife"),
    ],
)
def test_a_missing_package_is_named_with_what_brings_it(module: str, remedy: str) -> None:
    error = ModuleNotFoundError(f"No module named {module!r}", name=module)
    assert cli.message(error).startswith(f"the package {remedy}")
