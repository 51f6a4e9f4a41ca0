"""Labels have the units that a case names, and none that it does not."""

from pathlib import Path

import pytest
from conftest import CASE

from alewife_post import Run, figure, open_run, series, style, trajectories
from alewife_post.units import DIMENSIONS, unit_of, unit_of_quantity, units_of

LABELS = {"length": "um", "time": "s", "force": "pN"}


def test_labels_typed_without_a_mu_have_one() -> None:
    found = units_of(LABELS)
    assert (found.length, found.time, found.force) == ("µm", "s", "pN")
    assert units_of({"length": "a"}).time is None


@pytest.mark.parametrize(
    ("name", "in_space", "in_plane"),
    [
        ("sperm.x", "µm", "µm"),
        ("sperm.velocity.y", "µm/s", "µm/s"),
        ("flow.minimum_gap", "µm", "µm"),
        ("sperm.angular_velocity", "rad/s", "rad/s"),
        ("sperm.contact_force.x", "pN", "pN/µm"),
        ("sperm.torque", "pN µm", "pN"),
        ("sperm.shape_power", "pN µm/s", "pN/s"),
        ("sperm.cycle.power", "pN µm/s", "pN/s"),
        ("tail.joint.angle", "rad", "rad"),
        ("sperm.cycle.efficiency", None, None),
        ("sperm.drag_coefficient", None, None),
        ("sperm.direction.x", None, None),
    ],
)
def test_quantities_have_the_units_of_their_dimensions(
    name: str, in_space: str | None, in_plane: str | None
) -> None:
    for geometry, unit in (("spatial", in_space), ("planar", in_plane)):
        assert unit_of_quantity(name, {"geometry": geometry, "units": LABELS}) == unit


def test_what_is_not_named_has_no_label() -> None:
    for _, dimension in DIMENSIONS:
        assert unit_of(dimension, "dimensionless") in (None, "rad")
        assert unit_of(dimension, {"time": "s"}) in (None, "rad", "rad/s", "1/s")
    assert unit_of("pressure", "SI") == "Pa"
    assert unit_of("power", "SI", is_planar=True) == "W/m"
    assert unit_of("pressure", LABELS) == "pN/µm²"


def test_every_label_of_a_run_has_them(planar_run: Run, tmp_path: Path) -> None:
    path = tmp_path / "run"
    path.mkdir()
    for name in ("fields", "run.mcap", "fields.pvd", "status.json"):
        (path / name).symlink_to(planar_run.path / name)
    text = CASE.format(geometry="planar", shape="disc", center="[0.0, 0.0]")
    labels = '{ length = "um", time = "ms", force = "pN" }'
    (path / "case.toml").write_text(text.replace('"SI"', labels))
    (path / "series.csv").write_text("time,disc.x,disc.y,disc.speed\n0,0,0,1\n1,1,0,1\n2,2,0,1\n")
    run = open_run(path)
    drawn = figure.picture(run, "speed", lines="none", painter="matplotlib")
    axes, bar = drawn.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (µm)", "y (µm)")
    assert bar.get_ylabel() == "speed (µm/ms)"
    assert axes.get_title().endswith("t = 4 ms")
    assert style.label("pressure", run.case["units"]) == "pressure (pN/µm²)"
    curves = series.series_figure(run, ["disc.speed"])
    assert curves.axes[-1].get_xlabel() == "t (ms)"
    assert curves.axes[0].get_ylabel() == "disc\nspeed (µm/ms)"
    paths = trajectories.trajectory_figure(run, [])
    assert paths.axes[0].get_xlabel() == "x (µm)"
    assert "t = 0 ms" in paths.get_suptitle()
