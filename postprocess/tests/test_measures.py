"""Lines, sections and decay of flows that are known: Poiseuille's, a Stokeslet's, polynomials."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import meshes
import numpy as np
import pytest

from alewife_post import Run, measures
from alewife_post.cells import Cells, weights
from alewife_post.cli import main
from alewife_post.cutting import cut


def channel(path: Path, geometry: str = "planar") -> Run:
    """The parabolic flow of a channel, or of a tube of radius 1."""
    nodes, cells = meshes.rectangle((7, 5), np.array([0.0, 0.0]), np.array([3.0, 1.0]), 0.2)
    x, y = nodes.T
    speed = 4 * y * (1 - y) if geometry == "planar" else 1 - y**2
    velocity = np.column_stack([speed, 0 * y])
    domain = "channel = { length = 3.0, height = 1.0 }"
    if geometry != "planar":
        domain = "cylinder = { x = [0.0, 3.0], radius = 1.0 }"
    top = meshes.TOP.format(geometry=geometry, domain=domain, time="steady", body="")
    return meshes.written(path, [(0.0, nodes, cells, velocity, 6.0 - 2 * x)], top)


def test_a_line_across_a_channel_is_a_parabola_and_ends_at_its_walls(tmp_path: Path) -> None:
    run = channel(tmp_path / "run")
    found = measures.line(run, [1.1, -0.25], [1.1, 1.0], points=51)
    y = found["y"]
    outside = y < -1e-12
    assert np.isnan(found["velocity.x"][outside]).all()
    assert outside.sum() == 10
    exact = 4 * y * (1 - y)
    assert found["velocity.x"][~outside] == pytest.approx(exact[~outside], abs=1e-12)
    assert found["pressure"][~outside] == pytest.approx(6.0 - 2.2, abs=1e-12)
    assert found["distance"][-1] == pytest.approx(1.25)


@pytest.mark.parametrize(("geometry", "flux", "area"), [
    ("planar", 2 / 3, 1.0), ("axisymmetric", np.pi / 2, np.pi),
])  # fmt: skip
def test_the_flux_of_a_parabola_is_exact(
    tmp_path: Path, geometry: str, flux: float, area: float
) -> None:
    run = channel(tmp_path / "run", geometry)
    for x in (0.0, 3 / 7, 1.234, 3.0):
        found = measures.section(run, 0, x)
        assert found["flux"] == pytest.approx(flux, rel=1e-12)
        assert found["area"] == pytest.approx(area, rel=1e-8)
        assert found["mean_pressure"] == pytest.approx(6.0 - 2 * x, abs=1e-8)
    assert measures.section(run, 1, 0.4)["flux"] == pytest.approx(0.0, abs=1e-14)
    with pytest.raises(ValueError, match=r"x = 3\.1 cuts no fluid"):
        measures.section(run, 0, 3.1)
    with pytest.raises(ValueError, match="write x or y"):
        measures.section(run, 2, 0.0)


def test_sections_in_space_are_exact_for_quadratic_flows() -> None:
    nodes, cells = meshes.box(3, 0.0, 1.0)
    x, y, z = nodes.T
    own = meshes.field(nodes, cells, np.column_stack([y * y + z, x * z, 1 + x * y]))
    mesh = Cells(own)
    # Also where faces of cells lie in it
    for height in (0.1, 1 / 3, 0.77):
        found = cut(mesh, np.array([0.0, 0.0, height]), np.array([0.0, 0.0, 1.0]))
        assert found.weight.sum() == pytest.approx(1.0)
        assert found.weight @ found.at(mesh, own.velocity)[:, 2] == pytest.approx(1.25)
    askew = np.array([1.0, 1.0, 1.0]) / np.sqrt(3)
    found = cut(mesh, 0.5 * np.ones(3), askew)
    # The regular hexagon across the diagonal of a cube
    assert found.weight.sum() == pytest.approx(np.sqrt(27) / 4)


def test_a_periodic_domain_is_cut_once(tmp_path: Path) -> None:
    nodes, cells = meshes.rectangle((6, 4), np.array([0.5, 0.0]), np.array([3.5, 1.0]))
    velocity = np.column_stack([1 + nodes[:, 1], 0 * nodes[:, 0]])
    top = meshes.TOP.format(
        geometry="planar", domain="channel = { length = 3.0, height = 1.0 }", time="steady",
        body='[boundary]\nleft = { periodic = {} }\n',
    )  # fmt: skip
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, velocity, nodes[:, 0])], top)
    for x in (0.0, 0.2, 0.5, 3.0, 3.5):
        assert measures.section(run, 0, x)["flux"] == pytest.approx(1.5)
    # And a line goes on beyond the mesh
    found = measures.line(run, [0.0, 0.5], [3.0, 0.5])
    assert found["velocity.x"] == pytest.approx(1.5)


@pytest.mark.parametrize(("power", "geometry"), [(-1, "axisymmetric"), (-2, "axisymmetric")])
def test_the_exponent_is_that_of_the_singularity(tmp_path: Path, power: int, geometry: str) -> None:
    nodes, cells = meshes.shell(48, 48, (1.0, 100.0), np.pi)
    r = np.linalg.norm(nodes, axis=1)
    e = nodes / r[:, None]
    # A Stokeslet along the axis, and a stresslet
    if power == -1:
        velocity = (np.array([1.0, 0.0]) + e[:, :1] * e) / r[:, None]
    else:
        velocity = (3 * e[:, :1] ** 2 - 1) * e / r[:, None] ** 2
    body = '[[body]]\nname = "ball"\ncenter = [0.0]\nshape.sphere = { radius = 1.0 }\n'
    top = meshes.TOP.format(
        geometry=geometry, domain="half-disc = { radius = 100.0 }", time="steady", body=body
    )
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, velocity, 0 * r)], top)
    found = measures.decay(run)
    assert (found.distance[0], found.distance[-1]) == pytest.approx((4.0, 30.0))
    assert found.exponent == pytest.approx(power, abs=2e-4)
    mean = np.sqrt(2.0) if power == -1 else np.sqrt(0.8)
    assert found.coefficient == pytest.approx(mean, rel=1e-3)
    assert found.misfit < 1e-3
    with pytest.raises(ValueError, match="no distances to fit"):
        measures.decay(run, nearest=50.0)


def test_points_are_found_in_curved_cells_and_not_in_the_hole() -> None:
    nodes, cells = meshes.shell(12, 4, (1.0, 2.0), np.pi)
    own = meshes.field(nodes, cells, nodes**2)
    mesh = Cells(own)
    random = np.random.default_rng(1)
    share = random.dirichlet(np.ones(3), 500)[:, 1:]
    cell = random.integers(len(cells), size=500)
    places = np.einsum("nk,nki->ni", weights(share), mesh.places[cell])
    found = mesh.find(places)
    assert (found.cell == cell).all()
    assert found.local == pytest.approx(share, abs=1e-9)
    assert not mesh.find(np.array([[0.0, 0.5], [0.0, 2.1], [0.7, -0.8]])).is_inside.any()
    slope = mesh.gradient(found, 3.0 * nodes[:, 0] - nodes[:, 1])
    assert slope == pytest.approx(np.tile([3.0, -1.0], (500, 1)), abs=1e-9)


def test_the_commands_write_tables_figures_and_rows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = str(channel(tmp_path / "run").path)
    out = tmp_path / "line.csv"
    ends = ["--from", "1", "-0.5", "--to", "1", "0.5", "--points", "3"]
    assert main(["line", run, *ends, "--out", str(out)]) == 0
    rows = list(csv.DictReader(out.open()))
    assert [row["velocity.x"] for row in rows] == ["", "0", "1"]
    assert main(["line", run, *ends, "--out", str(tmp_path / "line.svg")]) == 0
    capsys.readouterr()
    assert main(["section", run, "x=1", "x=2", "--json"]) == 0
    assert [row["flux"] for row in json.loads(capsys.readouterr().out)] == pytest.approx(
        [2 / 3] * 2
    )
    for wrong, said in (
        (["section", run, "w=1"], "not a plane"),
        (["line", run, "--from", "0", "--to", "1", "1"], "2 numbers for each end"),
        (["line", run, *ends, "--out", "a.txt"], "a table (.csv) or a figure"),
        (["decay", run], "no bodies whose far field"),
    ):
        assert main(wrong) == 2
        assert said in capsys.readouterr().err
