"""What is compared where no quantity is asked for is a column that every run has."""

from pathlib import Path

import numpy as np
import pytest

from alewife_post import compare, open_run, series, sweeps

TIME = np.linspace(0.0, 1.0, 5)


def held(path: Path, columns: dict[str, float]) -> Path:
    """A steady run with columns of one row."""
    write(path, 1.0, "")
    header, row = ",".join(["time", *columns]), ",".join(map(repr, [0.0, *columns.values()]))
    (path / "series.csv").write_text(f"{header}\n{row}\n")
    return path


def test_columns_of_zeros_are_not_drawn_unless_asked_for(tmp_path: Path) -> None:
    zero = {"ball.velocity.x": 0.0, "ball.velocity.y": 1e-20, "ball.lift_coefficient": 3e-15}
    drags = (7.0, 4.0, 3.0)
    runs = [
        open_run(held(tmp_path / f"{drag}", {**zero, "ball.drag_coefficient": drag}))
        for drag in drags
    ]
    points = [([float(n)], run) for n, run in enumerate(runs)]
    sweep = compare.Sweep(tmp_path, ["fluid.viscosity"], points)
    assert series.in_common(runs) == ["ball.drag_coefficient"]
    assert sweeps.chosen_names(sweep, []) == ["ball.drag_coefficient"]
    assert sweeps.chosen_names(sweep, ["lift_coefficient"]) == ["ball.lift_coefficient"]


def test_where_all_that_is_usual_is_zero_what_differs_is_drawn(tmp_path: Path) -> None:
    columns = {"ball.velocity.x": 0.0, "ball.drag_coefficient": 0.0, "flow.mass_defect": 1e-9}
    runs = [
        open_run(held(tmp_path / f"{n}", {**columns, "ball.power": 1.0, "ball.torque": n}))
        for n in (1.0, 2.0)
    ]
    assert series.in_common(runs) == ["ball.torque"]
    # And where nothing differs, what is usual
    assert series.in_common(runs[:1]) == ["ball.drag_coefficient"]


def write(path: Path, viscosity: float, bodies: str) -> Path:
    """A run of some bodies, named by a letter each, without references."""
    path.mkdir(parents=True)
    (path / "case.toml").write_text(
        f'title = "Discs"\ngeometry = "planar"\n[fluid]\nviscosity = {viscosity}\n'
    )
    (path / "status.json").write_text('{"state": "finished"}\n')
    header = ",".join(["time", *(f"{name}.velocity.x" for name in bodies)])
    rows = [
        ",".join(
            repr(float(value)) for value in [t, *(viscosity * t + k for k, _ in enumerate(bodies))]
        )
        for t in TIME
    ]
    (path / "series.csv").write_text("\n".join([header, *rows]) + "\n")
    return path


def test_runs_of_several_bodies_without_references_are_compared(tmp_path: Path) -> None:
    paths = [write(tmp_path / "a", 1.0, "pq"), write(tmp_path / "b", 3.0, "pq")]
    runs, _, _ = compare.open_all(paths)
    names = compare.chosen_names(runs, [], [])
    assert names == ["p.velocity.x", "q.velocity.x"]
    rows = compare.differences(runs, [], names)
    assert [row["curve"] for row in rows[:2]] == ["viscosity = 1", "viscosity = 3"]
    # The second one is twice t above the first one
    assert rows[1]["largest"] == pytest.approx(2.0)
    assert rows[1]["rms difference"] == pytest.approx(2.0 / 3.0**0.5, rel=1e-3)


def test_a_quantity_one_run_lacks_is_left_out(tmp_path: Path) -> None:
    paths = [write(tmp_path / "a", 1.0, "pq"), write(tmp_path / "b", 3.0, "q")]
    runs, _, _ = compare.open_all(paths)
    assert compare.chosen_names(runs, [], []) == ["q.velocity.x"]
    runs, _, _ = compare.open_all([paths[0], write(tmp_path / "c", 1.0, "r")])
    with pytest.raises(ValueError, match="no quantity in common"):
        compare.chosen_names(runs, [], [])


def test_a_sweep_of_several_bodies_has_a_table(tmp_path: Path) -> None:
    runs = [open_run(write(tmp_path / f"{n}", float(n), "pq")) for n in (1, 2)]
    sweep = compare.Sweep(tmp_path, ["fluid.viscosity"], [([1.0], runs[0]), ([2.0], runs[1])])
    names = sweeps.chosen_names(sweep, [])
    rows = sweeps.table(sweep, names)
    assert [row["q.velocity.x"] for row in rows] == [2.0, 3.0]


def test_many_bodies_have_a_few_panels(tmp_path: Path) -> None:
    run = open_run(write(tmp_path / "a", 1.0, "abcdefghij"))
    assert len(series.in_common([run])) == series.MOST_PANELS
