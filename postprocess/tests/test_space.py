"""Runs in space: tetrahedra read, sampled and drawn."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import CAN_RENDER, block
from matplotlib.figure import Figure

from alewife_post import Run, cuts, domains, open_run, sections, slices, space, surfaces
from alewife_post.cli import picture
from alewife_post.planes import straight
from alewife_post.read import QUADRATIC_TETRAHEDRON, Field

CASE = """
title = "A block in a box"
geometry = "spatial"
units = "SI"
[domain.box]
min = [0.0, 0.0, 0.0]
max = [3.0, 3.0, 3.0]
[[body]]
name = "block"
center = [1.5, 1.5, 1.5]
[time.steady]
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A run in space whose flow is quadratic, so that sampling it is exact."""
    import pyvista

    path = tmp_path_factory.mktemp("spatial")
    nodes, cells = block()
    x, y, z = nodes.T
    grid = pyvista.UnstructuredGrid({QUADRATIC_TETRAHEDRON: cells}, nodes)
    grid.point_data["velocity"] = np.stack([y**2, z * x, 1.0 + x], axis=1)
    grid.point_data["pressure"] = x + 2 * y - z
    grid.point_data["vorticity"] = np.stack([1 - x, -1.0 + 0 * x, z - 2 * y], axis=1)
    grid.field_data["TimeValue"] = [0.0]
    (path / "fields").mkdir()
    grid.save(path / "fields/000000.vtu")
    (path / "fields.pvd").write_text(
        '<VTKFile type="Collection" version="1.0"><Collection>'
        '<DataSet timestep="0.0" part="0" file="fields/000000.vtu"/></Collection></VTKFile>\n'
    )
    (path / "case.toml").write_text(CASE)
    from mcap.writer import Writer

    with (path / "run.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        writer.finish()
    return open_run(path)


def test_fields_are_read_with_three_components(run: Run) -> None:
    field = run.field()
    assert run.is_spatial
    assert field.nodes.shape[1] == field.velocity.shape[1] == field.vorticity.shape[1] == 3
    assert field.cells.shape == (26 * 6, 10)


def test_samples_are_those_of_the_quadratic_flow_and_masked_in_bodies(run: Run) -> None:
    points = np.array([[0.3, 0.4, 0.2], [2.7, 1.1, 0.9], [1.5, 1.5, 1.5]])
    found = sections.sample(run.field(), points, "speed")
    x, y, z = points[:2].T
    velocity = np.stack([y**2, z * x, 1.0 + x], axis=1)
    # A quarter of the second derivative, over pieces half as wide as the cells
    assert found["velocity"].data[:2] == pytest.approx(velocity, abs=0.07)
    nodes = run.field().nodes[::7]
    exact = np.stack([nodes[:, 1] ** 2, nodes[:, 2] * nodes[:, 0], 1.0 + nodes[:, 0]], axis=1)
    assert sections.sample(run.field(), nodes, "speed")["velocity"].data == pytest.approx(
        exact, abs=1e-5
    )
    assert found["values"].mask.tolist() == [False, False, True]


def test_points_just_inside_a_body_are_no_fluid_however_large_the_domain(run: Run) -> None:
    # Of a flow in one corner of a domain that is a million times as large
    field = run.field()
    far = np.vstack([field.nodes, field.nodes[:10] + 1e6])
    grown = Field(
        time=0.0,
        nodes=far,
        cells=np.vstack([field.cells, len(field.nodes) + np.arange(10)[None]]),
        velocity=np.vstack([field.velocity, field.velocity[:10]]),
        pressure=np.append(field.pressure, field.pressure[:10]),
        vorticity=np.vstack([field.vorticity, field.vorticity[:10]]),
    )
    points = np.array([[1.001, 1.5, 1.5], [0.999, 1.5, 1.5]])
    assert sections.sample(grown, points, "speed")["values"].mask.tolist() == [True, False]


def test_the_surface_of_bodies_has_no_sides_of_the_domain(run: Run) -> None:
    surface = surfaces.bodies_surface(run, run.field(), "pressure")
    assert surface.area == pytest.approx(6.0, rel=1e-6)
    x, y, z = np.asarray(surface.points, dtype=float).T
    assert min(x.min(), y.min(), z.min()) == pytest.approx(1.0)
    assert surface.point_data["values"] == pytest.approx(x + 2 * y - z, abs=1e-5)


def in_domain(run: Run, domain: dict[str, object]) -> Run:
    """The same run, whose case names another domain."""
    other = Run(run.path)
    other.__dict__["case"] = {**run.case, "domain": domain}
    return other


def test_the_outer_part_of_an_imported_mesh_is_no_body(run: Run) -> None:
    imported = in_domain(run, {"mesh": {"file": "block.msh"}})
    surface = surfaces.bodies_surface(imported, run.field(), "pressure")
    assert surface.area == pytest.approx(6.0, rel=1e-6)


def test_a_domain_may_have_a_single_side(run: Run) -> None:
    # A sphere that the box is well inside of
    sphere = {"sphere": {"center": [1.5, 1.5, 1.5], "radius": 4.0}}
    surface = surfaces.bodies_surface(in_domain(run, sphere), run.field(), "pressure")
    assert surface.area == pytest.approx(54.0 + 6.0, rel=1e-6)


def test_a_slice_without_a_window_has_the_same_triangles(run: Run) -> None:
    view = (0.2, 2.9, 0.1, 2.5)
    drawn = slices.slice_picture(
        run, "pressure", view=view, plane="z=1.4", painter="matplotlib", lines="none"
    )
    (mesh,) = drawn.axes[0].collections[:1]
    corners = mesh._triangulation.x, mesh._triangulation.y
    x, y = (own[mesh._triangulation.triangles] for own in corners)
    area = 0.5 * np.abs(
        (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
    )
    assert area.sum() == pytest.approx(2.7 * 2.4 - 1.0, rel=1e-5)
    pressure = corners[0] + 2 * corners[1] - 1.4
    np.testing.assert_allclose(np.asarray(mesh.get_array()), pressure, atol=1e-5)
    drawn.canvas.draw()


def test_a_side_of_the_domain_can_be_looked_at(run: Run) -> None:
    drawn = slices.slice_picture(run, plane="z=0", painter="matplotlib")
    assert drawn.axes[0].get_title().endswith("z = 0")


def test_the_sides_of_a_domain_are_outlined(run: Run) -> None:
    plane, region = straight(2, 1.4), (np.zeros(3), np.full(3, 3.0))
    sides = sections.side_sections(run, run.field(), plane, region)
    length = sum(np.linalg.norm(np.diff(side, axis=0), axis=1).sum() for side in sides)
    assert length == pytest.approx(12.0, rel=1e-6)
    # But for where a periodic mesh is cut open
    other, moved = cut_open_elsewhere(run)
    sides = sections.side_sections(other, moved, plane, region)
    assert all(np.ptp(side[:, 1]) < 1e-9 for side in sides)


def test_a_plane_cuts_the_block_in_a_square(run: Run) -> None:
    (square,) = sections.sections(run, run.field(), straight(2, 1.4))
    assert square[:, 2] == pytest.approx(1.4)
    assert np.ptp(square[:, :2], axis=0) == pytest.approx([1.0, 1.0], abs=1e-6)
    assert sections.sections(run, run.field(), straight(2, 0.5)) == []


@pytest.mark.parametrize("domain", ["cylinder", "sphere"])
def test_nodes_on_round_sides_are_found(domain: str) -> None:
    case = {
        "cylinder": {"domain": {"cylinder": {"x": [-1.0, 1.0], "radius": 2.0}}},
        "sphere": {"domain": {"sphere": {"radius": 2.0}}},
    }[domain]
    nodes = np.array([[0.0, 1.2, 1.6], [0.3, 0.4, 0.5]])
    least = np.abs(domains.distances_to_sides(case, nodes)).min(axis=1)
    assert least[0] < 1e-12 < least[1]


@pytest.mark.skipif(not CAN_RENDER, reason="VTK has no window here")
def test_a_slice_is_across_an_axis_within_the_domain(run: Run) -> None:
    drawn = slices.slice_picture(run, plane="y=0.5")
    assert isinstance(drawn, Figure)
    axes = drawn.axes[0]
    assert axes.get_xlabel().startswith("$x$") or "x" in axes.get_xlabel()
    assert "z" in axes.get_ylabel()
    assert (np.asarray(axes.images[0].get_array())[..., 3] == 255).all()
    through = slices.slice_picture(run, "pressure", view=(0.0, 3.0, 0.0, 3.0)).axes[0].images[0]
    # The block is a ninth of the plane
    assert (np.asarray(through.get_array())[..., 3] == 0).mean() == pytest.approx(1 / 9, abs=0.003)
    for plane, reason in [("y=4", "outside"), ("w=0", "not a plane"), ("z", "not a plane")]:
        with pytest.raises(ValueError, match=reason):
            slices.slice_picture(run, plane=plane)


def test_a_picture_is_written_by_the_command(run: Run, tmp_path: Path) -> None:
    out = tmp_path / "slice.png"
    assert picture([str(run.path), "--out", str(out), "--slice", "z=0.5"]) == 0
    assert out.stat().st_size > 10_000
    assert picture([str(run.path), "--out", str(out), "--slice", "z=9"]) == 2


@pytest.mark.skipif(not CAN_RENDER, reason="VTK has no window here")
def test_the_camera_chooses_what_is_seen(run: Run) -> None:
    def image(camera: tuple[float, float]) -> np.ndarray:
        drawn = space.surface_picture(run, camera=camera)
        return np.asarray(drawn.axes[0].images[0].get_array())

    front, above = image((0.0, 0.0)), image((0.0, 89.9))
    assert front.shape[2] == 4
    # A face of the cube is a square from everywhere along an axis, with other pressures on it
    assert abs(front.shape[0] / front.shape[1] - 1) < 0.02
    assert not np.array_equal(front[:200, :200], above[:200, :200])
    corner = image((45.0, 0.0))
    assert corner.shape[1] > 1.3 * corner.shape[0]


@pytest.mark.skipif(not CAN_RENDER, reason="VTK has no window here")
def test_a_steady_flow_has_no_time_in_its_title(run: Run) -> None:
    assert space.surface_picture(run).axes[0].get_title() == "A block in a box"
    sliced = slices.slice_picture(run, plane="y=0.5").axes[0].get_title()
    assert sliced.startswith("A block in a box, ") and "0.5" in sliced and "t =" not in sliced


def test_fields_of_other_cells_are_refused(tmp_path: Path) -> None:
    import pyvista

    from alewife_post.read import read_field

    path = tmp_path / "tetra.vtu"
    pyvista.UnstructuredGrid({10: np.array([[0, 1, 2, 3]])}, np.eye(4)[:, :3]).save(path)
    with pytest.raises(ValueError, match="22 or 24"):
        read_field(path)


def cut_open_elsewhere(run: Run) -> tuple[Run, Field]:
    """The run in a box that is periodic along x, its first layer of cells put behind the last."""
    field = run.field()
    is_first = (field.nodes[field.cells][:, :, 0] <= 1.0).all(axis=1)
    n = len(field.nodes)
    moved = Field(
        time=0.0,
        nodes=np.vstack([field.nodes, field.nodes + np.array([3.0, 0.0, 0.0])]),
        cells=np.where(is_first[:, None], field.cells + n, field.cells),
        velocity=np.vstack([field.velocity] * 2),
        pressure=np.tile(field.pressure, 2),
        vorticity=np.vstack([field.vorticity] * 2),
    )
    used, cells = np.unique(moved.cells, return_inverse=True)
    moved = Field(
        0.0,
        moved.nodes[used],
        cells.reshape(moved.cells.shape),
        velocity=moved.velocity[used],
        pressure=moved.pressure[used],
        vorticity=moved.vorticity[used],
    )
    other = Run(run.path)
    periodic = {"left": {"periodic": "right"}}
    other.__dict__["case"] = {**run.case, "boundary": periodic}
    return other, moved


def test_where_a_periodic_mesh_is_cut_open_is_no_body(run: Run) -> None:
    other, moved = cut_open_elsewhere(run)
    assert moved.nodes[:, 0].min() == 1.0
    surface = surfaces.bodies_surface(other, moved, "pressure")
    # The cut goes along one face of the block, and all but one of its nodes are on both sides of it
    assert surface.area == pytest.approx(6.0, rel=1e-6)


def test_a_periodic_domain_goes_on_beyond_its_mesh(run: Run) -> None:

    other, moved = cut_open_elsewhere(run)
    points = np.array([[0.3, 0.4, 0.2], [2.7, 1.1, 0.9], [1.5, 1.5, 1.5]])
    here = sections.sample(run.field(), points, "pressure")
    there = sections.sample(moved, points, "pressure", other.case)
    assert there["values"].mask.tolist() == [False, False, True]
    assert there["values"].data[:2] == pytest.approx(here["values"].data[:2], abs=1e-6)
    cut = cuts.Cut(straight(2, 1.4), np.zeros(2), np.full(2, 3.0), moves=False)
    found = cuts.whole_slice(other.case, moved, cut, "pressure")
    assert found.area == pytest.approx(8.0, rel=1e-5)
    x, y, z = np.asarray(found.points, dtype=float).T
    assert (x.min(), x.max()) == pytest.approx((0.0, 3.0))
    # This pressure is no periodic one, and has two values where the mesh is cut open
    inner = (x > 0.01) & (x < 2.99)
    assert found.point_data["values"][inner] == pytest.approx((x + 2 * y - z)[inner], abs=1e-5)


def test_bodies_are_whole_wherever_a_view_reaches_beyond_a_periodic_box(run: Run) -> None:
    other, _ = cut_open_elsewhere(run)
    here = sections.sections(other, run.field(), straight(2, 1.4))
    region = (np.array([-1.9, 0.0, 0.0]), np.array([4.9, 3.0, 3.0]))
    found = sections.sections(other, run.field(), straight(2, 1.4), region)
    assert len(here) == 1
    middles = sorted(float(curve[:, 0].min() + curve[:, 0].max()) / 2 for curve in found)
    assert middles == pytest.approx([-1.5, 1.5, 4.5])
    # A slice that reaches there has no hole without its body
    view = (-1.9, 4.9, 0.5, 2.5)
    drawn = slices.slice_picture(other, "pressure", plane="z=1.4", view=view, lines="none")
    assert len(drawn.axes[0].patches) == 3


def test_faces_of_the_boundary_close_it_and_look_outwards(run: Run) -> None:
    field = run.field()
    faces = surfaces.boundary_faces(field)
    a, b, c = (field.nodes[faces[:, k]] for k in range(3))
    # The box of 27 less the block of 1, by the theorem of Gauss; its surface has no resultant
    areas = 0.5 * np.cross(b - a, c - a)
    assert np.einsum("ij,ij->", areas, (a + b + c) / 3) / 3 == pytest.approx(26.0)
    assert areas.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.linalg.norm(areas, axis=1).sum() == pytest.approx(54.0 + 6.0)
    # Nodes in the middles of edges are between the vertices in their order
    for k, (i, j) in enumerate([(0, 1), (1, 2), (2, 0)]):
        middle = 0.5 * (field.nodes[faces[:, i]] + field.nodes[faces[:, j]])
        assert field.nodes[faces[:, 3 + k]] == pytest.approx(middle)


def test_a_missing_quantity_is_named_with_those_there_are(tmp_path: Path) -> None:
    import pyvista

    from alewife_post.read import read_field

    nodes, cells = block()
    grid = pyvista.UnstructuredGrid({QUADRATIC_TETRAHEDRON: cells}, nodes)
    grid.point_data["pressure"] = nodes[:, 0]
    grid.save(tmp_path / "part.vtu")
    with pytest.raises(ValueError, match="no velocity and no vorticity at nodes; it has pressure"):
        read_field(tmp_path / "part.vtu")


def test_faces_at_a_wall_of_a_huge_domain_that_travels_are_told_from_a_body_beside_it() -> None:
    # A ball of radius 1e5 around a body that has moved by 3 along x, and two faces of size 0.1: one
    # on the wall, one a hundredth away from it
    case = {"domain": {"sphere": {"radius": 1e5}}, "frame": "one", "body": []}
    centers = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    turns = np.array([[0.0, 0.0, 0.0, 1.0]] * 2)
    history = SimpleNamespace(time=np.array([0.0, 1.0]), center=centers, rotation=turns)
    members = SimpleNamespace(frame="one")
    run = SimpleNamespace(case=case, bodies={"one": history}, members=members)
    around = np.array([[0, 0], [0.1, 0], [0, 0.1], [0.05, 0], [0.05, 0.05], [0, 0.05]]) * 1e-5
    wall = np.column_stack([np.ones(6), around])
    wall *= 1e5 / np.linalg.norm(wall, axis=1, keepdims=True)
    nodes = np.vstack([wall, wall * (1 - 1e-7)]) + np.array([3.0, 0.0, 0.0])
    field = SimpleNamespace(nodes=nodes, time=1.0)
    faces = np.arange(12).reshape(2, 6)
    assert list(surfaces.on_sides(run, field, faces)) == [True, False]
    field.time = 0.0
    assert list(surfaces.on_sides(run, field, faces)) == [False, False]
