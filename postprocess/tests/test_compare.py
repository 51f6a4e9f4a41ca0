"""Runs, sweeps and published curves beside each other; a run at a glance."""

import json
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import write_run

from alewife_post import Run, cli, compare, comparison_table, grid, open_run, summary, sweep_table
from alewife_post.sweeps import chosen_key

TIME = np.linspace(0.0, 2.0, 21)


def write(path: Path, offset: float, *, scale: float = 1.0) -> Path:
    """A run whose disc falls along a parabola, from a height, on a mesh."""
    write_run(path, is_axisymmetric=False)
    rows = "".join(f"{t!r},{offset - t * t!r}\n" for t in TIME.tolist())
    (path / "series.csv").write_text("time,disc.y\n" + rows)
    case = (path / "case.toml").read_text().replace("[2.0, 4.0]", "[1.0, 2.0]")
    (path / "case.toml").write_text(f"{case}\n[mesh]\nscale = {scale}\n")
    return path


def write_sweep(path: Path) -> Path:
    """Three points, of which the second has not been run."""
    plan = {"swept": ["mesh.scale", "title"], "points": [[1.0, "a"], [2.0, "a"], [4.0, "b"]]}
    for number, (scale, _) in enumerate(plan["points"], 1):
        if number != 2:
            write(path / f"points/{number:04}", 10 * scale, scale=scale)
    (path / "sweep.json").write_text(json.dumps(plan))
    return path


CURVE = "# quantity = disc.y\n# source = Somebody 1999\n# value = 2\nt,y\n0.5,5\n1,4\n3,0\n"


def test_two_runs_are_named_by_what_sets_them_apart(tmp_path: Path) -> None:
    paths = [write(tmp_path / "a", 10.0), write(tmp_path / "b", 10.5, scale=0.5)]
    runs, _, curves = compare.open_all(paths)
    assert [one.label for one in runs] == ["scale = 1", "scale = 0.5"] and not curves
    first, second = compare.differences(runs, [], ["disc.y"])
    assert "rms difference" not in first
    assert second["final"] == 6.5
    # Apart by a constant, everywhere.
    assert second["rms difference"] == pytest.approx(0.5, rel=1e-12)
    assert second["largest"] == pytest.approx(0.5, rel=1e-12)
    same, _, _ = compare.open_all([paths[0], write(tmp_path / "c", 10.0)])
    assert [one.label for one in same] == ["a", "c"]


def test_a_published_curve_is_compared_at_its_own_points(tmp_path: Path) -> None:
    run = write(tmp_path / "a", 10.0)
    (tmp_path / "curve.csv").write_text(CURVE)
    runs, _, curves = compare.open_all([run, tmp_path / "curve.csv"])
    assert compare.chosen_names(runs, curves, []) == ["disc.y"]
    _, row = compare.differences(runs, curves, ["disc.y"])
    # Computed less published: 9.75 - 10 and 9 - 8; the last point lies beyond the run.
    assert row["largest"] == pytest.approx(1.0) and row["at"] == 1.0
    assert row["rms difference"] == pytest.approx(np.sqrt((0.25**2 + 1) / 2))
    (axes,) = compare.compare_figure(runs, curves, ["disc.y"]).axes
    line, points = axes.lines
    np.testing.assert_allclose(line.get_ydata(), 10 - TIME**2)
    np.testing.assert_array_equal(points.get_ydata(), [10, 8, 0])
    assert points.get_linestyle() == "None"


def test_a_case_directory_stands_for_the_curves_it_ships(tmp_path: Path) -> None:
    (tmp_path / "case").mkdir()
    (tmp_path / "case/case.toml").write_text('title = "a case"\n')
    (tmp_path / "case/curve.csv").write_text(CURVE)
    (tmp_path / "case/stroke.csv").write_text("t,x\n0,1\n")
    _, _, curves = compare.open_all([tmp_path / "case"])
    assert [curve.source for curve in curves] == ["Somebody 1999"]


def test_a_sweep_is_drawn_against_what_it_sweeps(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_sweep(tmp_path / "s")
    sweep = compare.open_sweep(path)
    assert chosen_key(sweep, None) == chosen_key(sweep, "scale") == "mesh.scale"
    with pytest.raises(KeyError, match="no swept number viscosity"):
        chosen_key(sweep, "viscosity")
    out = tmp_path / "s.png"
    assert cli.main(["compare", str(path), "--out", str(out), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [(row["point"], row["mesh.scale"], row["disc.y"]) for row in rows] == [
        (1, 1.0, 6.0), (3, 4.0, 36.0),
    ]  # fmt: skip
    # The statistics of the case begin at t = 1.
    table = sweep_table(path, ["y"], "max")
    assert list(table.index) == [1, 3] and list(table["disc.y"]) == [9.0, 39.0]
    assert cli.main(["compare", str(path), "--curves", "--out", str(out)]) == 0
    assert "scale = 4" in capsys.readouterr().out
    assert plt.imread(out).std() > 0.01


def test_what_cannot_be_compared_is_one_line_and_code_two(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    a, b = str(write(tmp_path / "a", 1.0)), str(write(tmp_path / "b", 2.0))
    sweep = str(write_sweep(tmp_path / "s"))
    curve = tmp_path / "curve.csv"
    curve.write_text(CURVE)
    (tmp_path / "other.csv").write_text("t,y\n0,1\n")
    out = ["--out", str(tmp_path / "no.png")]
    for arguments, message in (
        ([a], "one run alone"),
        ([str(curve)], "no run"),
        ([a, str(tmp_path / "other.csv")], "does not say in its head"),
        ([a, sweep], "one sweep is compared by itself"),
        ([a, b, "--against", "mesh.scale"], "for a sweep"),
        ([a, b, "--quantity", "disc.z"], "no quantity disc.z; nearest: disc.y"),
        ([sweep, "--against", "viscosity"], "no swept number viscosity"),
        ([a, str(tmp_path / "none")], "does not exist"),
    ):
        assert cli.main(["compare", *arguments, *out]) == 2
        error = capsys.readouterr().err
        assert message in error and error.count("\n") == 1, error
    assert not (tmp_path / "no.png").exists()


def test_tables_have_a_row_for_each_curve(tmp_path: Path) -> None:
    paths = [write(tmp_path / "a", 10.0), write(tmp_path / "b", 10.5, scale=0.5)]
    table = comparison_table(paths, ["disc.y"])
    assert list(table["curve"]) == ["scale = 1", "scale = 0.5"]
    assert table["rms difference"][1] == pytest.approx(0.5)


def test_a_grid_holds_the_field_of_its_file(planar_run: Run) -> None:
    import pyvista

    field = planar_run.field()
    made, there = grid(field), pyvista.read(planar_run.fields[-1].path)
    np.testing.assert_array_equal(made.points, there.points)
    np.testing.assert_array_equal(made.cells, there.cells)
    for name in ("velocity", "pressure", "vorticity"):
        np.testing.assert_array_equal(made.point_data[name], there.point_data[name])


# ---- Inspect -------------------------------------------------------------------------------------


def test_a_summary_is_text_or_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "a", 10.0)
    assert cli.main(["inspect", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["series"] == {"rows": 21, "from": 0.0, "to": 2.0, "quantities": ["disc.y"]}
    assert found["state"]["state"] == "finished" and found["fields"] == [0.0, 4.0]
    assert cli.main(["inspect", str(path)]) == 0
    text = capsys.readouterr().out
    assert "21 rows of 1 quantities, t = 0 to 2" in text and "finished, step 40" in text


def test_values_are_those_of_the_series_and_of_the_window(tmp_path: Path) -> None:
    run = open_run(write(tmp_path / "a", 10.0))
    run.case["reference"] = []
    found = summary.summary(run)
    (value,) = found["values"]
    # The mean of 10 - t^2 over [1, 2] is 10 - 7/3; the trapezoidal rule has h^2 / 6 less.
    assert value["mean"] == pytest.approx(10 - 7 / 3 - 0.1**2 / 6, abs=1e-12)
    assert (value["final"], value["min"], value["max"]) == (6.0, 6.0, 10.0)


def test_a_run_that_has_written_nothing_is_summed_up(tmp_path: Path) -> None:
    path = write(tmp_path / "a", 10.0)
    for name in ("series.csv", "fields.pvd", "provenance.json", "run.mcap"):
        (path / name).unlink()
    text = summary.as_text(summary.summary(open_run(path)))
    assert "0 rows" in text and "0 files" in text


def test_a_summary_of_a_computed_run_counts_its_references(computed_run: Run) -> None:
    found = summary.summary(computed_run)
    given = computed_run.case["reference"]
    assert len(found["references"]) == len(given) > 0
    assert {one["verdict"] for one in found["references"]} == {"within"}
    assert f"{len(given)} references: {len(given)} within" in summary.as_text(found)
    json.dumps(cli.cli_series.plain(found), allow_nan=False)


def test_a_summary_needs_no_package_that_draws(tmp_path: Path) -> None:
    path = write(tmp_path / "a", 10.0)
    code = (
        "import sys\n"
        "for name in ('matplotlib', 'pyvista', 'vtk', 'pandas'): sys.modules[name] = None\n"
        "from alewife_post import cli\n"
        "code = cli.main(['inspect', sys.argv[1]])\n"
        "sys.exit(10 * code + cli.main(['plot', sys.argv[1]]))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(path)], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 2, done.stderr
    assert "21 rows" in done.stdout
    assert done.stderr.startswith("alewife-post: the package matplotlib is not installed")
