"""Sides have names, and curves of what acts on them and on bodies are those of known flows."""

from __future__ import annotations

from pathlib import Path

import meshes
import numpy as np
import pytest
from conftest import CAN_RENDER
from test_traction import VISCOSITY, sphere

from alewife_post import Run, exports, facets, sides, skins, traction
from alewife_post.cli import main
from alewife_post.planes import parsed

FLUID = '[fluid]\nmodel = "stokes"\nviscosity = 2.0\n'
DISC = FLUID + '[[body]]\nname = "disc"\ncenter = [0.0, 0.0]\nshape.disc = { radius = 1.0 }\n'


def channel(path: Path, geometry: str = "planar", domain: str | None = None) -> Run:
    """Plane Poiseuille flow, whose wall shear is 1, in a channel of 4 by 1."""
    nodes, cells = meshes.rectangle((8, 4), np.zeros(2), np.array([4.0, 1.0]), 0.15)
    x, y = nodes.T
    top = meshes.TOP.format(
        geometry=geometry, domain=domain or "channel = { length = 4.0, height = 1.0 }",
        time="steady", body=FLUID,
    )  # fmt: skip
    velocity = np.stack([0.5 * y * (1 - y), 0 * y], 1)
    return meshes.written(path, [(0.0, nodes, cells, velocity, 8 - 2 * x)], top)


def swirl(path: Path) -> Run:
    """A disc that turns in a fluid: a velocity of 1 / r around it, a shear of two viscosities."""
    nodes, cells = meshes.shell(24, 8, (1.0, 3.0), 2 * np.pi)
    # Both ends of the angle are one
    place, number = np.unique(np.round(nodes, 9), axis=0, return_inverse=True)
    x, y = place.T
    velocity = np.stack([-y, x], 1) / (x * x + y * y)[:, None]
    top = meshes.TOP.format(
        geometry="planar", domain="disc = { radius = 3.0 }", time="steady", body=DISC
    )
    cells = number.ravel()[cells]
    return meshes.written(path, [(0.0, place, cells, velocity, 0 * x)], top)


def test_a_channel_has_its_wall_shear_up_to_the_corners(tmp_path: Path) -> None:
    import pyvista

    run = channel(tmp_path / "run")
    found = exports.write_fields(run, None, tmp_path / "out")
    grid = pyvista.read(found.paths[1])
    names = list(grid.field_data["surfaces"])
    assert sorted(names) == ["bottom", "left", "right", "top"]
    number, data = grid.point_data["surface"], grid.point_data
    for name, normal in (("bottom", [0, 1, 0]), ("top", [0, -1, 0])):
        own = number == names.index(name)
        # All nodes, those at corners as well: each side has nodes of its own there
        assert own.sum() == 17
        assert data["wall_shear"][own] == pytest.approx(1.0, abs=1e-10)
        assert data["normal"][own] == pytest.approx(np.tile(normal, (17, 1)), abs=1e-12)
    rows = {row["surface"]: row for row in found.rows}
    assert rows["bottom"]["traction.x"] == pytest.approx(4.0)
    assert rows["left"]["traction.x"] == pytest.approx(-8.0)
    assert {row["is"] for row in found.rows} == {"side"}


def test_curves_of_sides_go_along_them(tmp_path: Path) -> None:
    run = channel(tmp_path / "run")
    field = run.field()
    found = {one.facets.name: one for one in traction.surfaces_of(run, field)}
    for name, length, along in (("bottom", 4.0, "x"), ("top", 4.0, "x"), ("left", 1.0, "y")):
        columns = skins.curve(field, found[name])
        assert columns["distance"] == pytest.approx(
            np.linspace(0, length, 2 * round(4 * length if length < 2 else 8) + 1)
        )
        assert columns["distance"] == pytest.approx(columns[along])
    assert skins.curve(field, found["top"])["shear"] == pytest.approx(1.0)
    assert skins.curve(field, found["top"])["pressure"][[0, -1]] == pytest.approx([8.0, 0.0])


def test_a_curve_goes_around_a_disc(tmp_path: Path) -> None:
    run = swirl(tmp_path / "run")
    field = run.field()
    disc, wall = traction.surfaces_of(run, field)
    assert (disc.facets.name, wall.facets.name) == ("disc", "wall")
    columns = skins.curve(field, disc)
    assert columns["distance"][-1] == pytest.approx(2 * np.pi, rel=1e-4)
    assert [columns[name][0] for name in "xy"] == pytest.approx([1.0, 0.0], abs=1e-9)
    # Counter-clockwise
    angle = np.unwrap(np.arctan2(columns["y"], columns["x"]))
    assert angle == pytest.approx(columns["distance"], rel=1e-3, abs=1e-3)
    assert columns["shear"] == pytest.approx(-4.0, rel=0.04)
    assert columns["wall_shear"] == pytest.approx(-columns["shear"])


def test_a_curve_about_an_axis_goes_from_pole_to_pole(tmp_path: Path) -> None:
    run = sphere(tmp_path / "run", 32)
    field = run.field()
    ball, wall = traction.surfaces_of(run, field)
    assert wall.facets.name == "wall"
    columns = skins.curve(field, ball)
    assert columns["distance"][-1] == pytest.approx(np.pi, rel=1e-5)
    assert columns["x"][[0, -1]] == pytest.approx([-1.0, 1.0])
    # Stokes's sphere moves along x: the fluid holds it back all over by the same traction
    exact = -1.5 * VISCOSITY * np.sin(columns["distance"])
    assert columns["shear"] == pytest.approx(exact, abs=0.02)


def test_a_duct_has_sides_by_name_and_curves_where_planes_cut_them(tmp_path: Path) -> None:
    nodes, cells = meshes.box(4, 0.0, 1.0)
    x, y, _ = nodes.T
    top = meshes.TOP.format(
        geometry="spatial", domain="box = { min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0] }",
        time="steady", body=FLUID,
    )  # fmt: skip
    velocity = np.stack([0.5 * y * (1 - y), 0 * x, 0 * x], 1)
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, velocity, -2 * x)], top)
    field = run.field()
    found = {one.facets.name: one for one in traction.surfaces_of(run, field)}
    assert set(found) == {"left", "right", "bottom", "top", "back", "front"}
    assert traction.magnitude(found["top"], "wall-shear") == pytest.approx(1.0)
    columns = skins.cut(field, found["bottom"], parsed("x=0.4"))
    assert columns["distance"][-1] == pytest.approx(1.0)
    assert columns["wall_shear"] == pytest.approx(1.0)
    assert columns["x"] == pytest.approx(0.4)
    with pytest.raises(ValueError, match="z = 3 does not cut bottom"):
        skins.cut(field, found["bottom"], parsed("z=3"))


@pytest.mark.parametrize(
    ("geometry", "domain", "names"),
    [
        ("planar", "box = { min = [0.0, 0.0], max = [4.0, 1.0] }", "left right bottom top"),
        ("axisymmetric", "cylinder = { x = [0.0, 4.0], radius = 1.0 }", "left right wall"),
        # Of another size than its mesh: no side is where it should be
        ("planar", "disc = { radius = 9.0 }", "sides"),
    ],
)
def test_sides_of_each_domain(tmp_path: Path, geometry: str, domain: str, names: str) -> None:
    run = channel(tmp_path / "run", geometry, domain)
    found = facets.facets_of(run, run.field())
    assert {one.name for one in found} == set(names.split())
    assert not any(one.is_body for one in found)


def test_sides_of_a_given_mesh_are_its_groups(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    run = channel(tmp_path / "run", domain='mesh = { file = "my.msh", scale = 0.5 }')
    field = run.field()
    edges = facets.boundary_edges(field)
    on_inlet = field.nodes[edges, 0].max(axis=1) < 1e-9
    points = 2.0 * skins.spatial(field.nodes)
    groups = np.where(on_inlet, 1, 2)
    mesh = meshio.Mesh(
        points, [("line3", edges), ("triangle6", field.cells)],
        cell_data={
            "gmsh:physical": [groups, np.full(len(field.cells), 3)],
            "gmsh:geometrical": [groups, np.full(len(field.cells), 3)],
        },
        field_data={"inlet": np.array([1, 1]), "fluid": np.array([3, 2])},
    )  # fmt: skip
    mesh.write(run.path / sides.GIVEN, file_format="gmsh22", binary=False)
    found = {one.name: one for one in facets.facets_of(run, field)}
    # A group without a name has its number
    assert set(found) == {"inlet", "2"}
    assert len(found["inlet"].nodes) == 4


def test_the_command_writes_tables_and_figures_and_says_what_it_takes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = channel(tmp_path / "run")
    given = ["surface", str(run.path)]
    assert main(given) == 0
    assert capsys.readouterr().out.count(" side ") == 4
    out = tmp_path / "bottom.csv"
    assert main([*given, "--on", "bottom", "--out", str(out)]) == 0
    table = np.genfromtxt(out, delimiter=",", names=True)
    assert table["wall_shear"] == pytest.approx(1.0)
    for name, more in (("a.svg", ["--on", "bottom", "--on", "top"]), ("b.pdf", ["--on", "left"])):
        assert main([*given, *more, "--quantity", "shear", "--out", str(tmp_path / name)]) == 0
    assert "<image" not in (tmp_path / "a.svg").read_text()
    capsys.readouterr()
    for wrong, said in (
        (["--out", "x.csv"], "--on says which side or body is written: "),
        (["--on", "wall"], "no side or body wall; there are "),
        (["--on", "top", "--on", "left", "--out", "x.csv"], "a table is of one side or body"),
        (["--on", "top", "--out", "x.eps"], "write x.pdf or x.svg"),
        (["--on", "top", "--slice", "x=1"], "--slice is for runs in space"),
    ):
        assert main([*given, *wrong]) == 2
        assert said in capsys.readouterr().err


@pytest.mark.skipif(not CAN_RENDER, reason="VTK can have no window here")
def test_surfaces_in_space_are_bodies_or_sides(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    nodes, cells = meshes.box(3, 0.0, 1.0)
    top = meshes.TOP.format(
        geometry="spatial", domain="box = { min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0] }",
        time="steady", body=FLUID,
    )  # fmt: skip
    velocity = np.stack([nodes[:, 1] ** 2, 0 * nodes[:, 0], 0 * nodes[:, 0]], 1)
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, velocity, nodes[:, 0])], top)
    given = ["picture", str(run.path), "--out", str(tmp_path / "x.png"), "--quantity", "wall-shear"]
    assert main([*given, "--surface"]) == 0
    assert main([*given, "--surface", "--on", "top"]) == 0
    capsys.readouterr()
    for wrong, said in (
        ([], "--surface draws it on bodies or sides"),
        (["--surface", "--on", "lid"], "no side or body lid; there are "),
        (["--on", "top"], "--on is for --surface"),
    ):
        assert main([*given, *wrong]) == 2
        assert said in capsys.readouterr().err
    # A list in a refusal is true
    for quantity in ("shear-rate", "q"):
        assert main([*given[:-1], quantity, "--slice", "z=0.5"]) == 0
