"""Scalars that the flow carries: read, drawn by their names, along lines, on slices, in files."""

from __future__ import annotations

from pathlib import Path

import meshes
import numpy as np
import pytest
from meshes import Array

from alewife_post import Run, figure, gallery, isosurfaces, measures, scenery, slices, style, tables
from alewife_post.cuts import Cut, slice_of
from alewife_post.elements import mirrored
from alewife_post.exports import write_fields
from alewife_post.fields import nodal_values
from alewife_post.periodic import joined
from alewife_post.planes import parsed

FLUID = "[fluid]\nviscosity = 1.0\n"
HEAT = "[[scalar]]\nname = 'heat'\ndiffusivity = 1.0\n"


def warm(nodes: Array) -> Array:
    """Of both signs, exact in quadratic cells."""
    return nodes[:, 0] ** 2 - nodes[:, 1]


def channel(path: Path, geometry: str = "planar") -> Run:
    """A uniform flow in a channel or tube with something warm in it."""
    nodes, cells = meshes.rectangle((7, 5), np.array([0.0, 0.0]), np.array([3.0, 1.0]), 0.2)
    velocity = np.column_stack([1.0 + 0.0 * nodes[:, 1], 0.0 * nodes[:, 1]])
    domain = "channel = { length = 3.0, height = 1.0 }"
    if geometry != "planar":
        domain = "cylinder = { x = [0.0, 3.0], radius = 1.0 }"
    top = meshes.TOP.format(geometry=geometry, domain=domain, time="steady", body="") + FLUID + HEAT
    frame = (0.0, nodes, cells, velocity, 0.0 * nodes[:, 0])
    return meshes.written(path, [frame], top, {"heat": warm})


def block(path: Path) -> Run:
    """The same in a box in space."""
    nodes, cells = meshes.box(3, 0.0, 3.0)
    velocity = np.zeros((len(nodes), 3))
    velocity[:, 0] = 1.0
    domain = "box = { min = [0.0, 0.0, 0.0], max = [3.0, 3.0, 3.0] }"
    top = meshes.TOP.format(geometry="spatial", domain=domain, time="steady", body="") + HEAT
    frame = (0.0, nodes, cells, velocity, 0.0 * nodes[:, 0])
    return meshes.written(path, [frame], top, {"heat": warm})


@pytest.mark.parametrize("geometry", ["planar", "axisymmetric"])
def test_a_scalar_is_drawn_by_its_name_and_known_along_a_line(
    tmp_path: Path, geometry: str
) -> None:
    run = channel(tmp_path / "run", geometry)
    assert run.scalars == ["heat"]
    field = run.field()
    assert field.scalars["heat"] == pytest.approx(warm(field.nodes))
    for drawn in (figure.picture(run, "heat"), gallery.default_picture(run)):
        bar = drawn.axes[-1]
        assert "heat" in (bar.get_xlabel(), bar.get_ylabel())
    found = measures.line(run, [0.3, 0.1], [2.7, 0.9], points=21)
    assert found["heat"] == pytest.approx(found["x"] ** 2 - found["y"], abs=1e-12)
    both = mirrored(field)
    assert both.scalars["heat"] == pytest.approx(both.nodes[:, 0] ** 2 - np.abs(both.nodes[:, 1]))
    assert len(joined([both, both]).scalars["heat"]) == 2 * len(both.nodes)


def test_a_name_that_is_no_quantity_is_answered_with_those_there_are(tmp_path: Path) -> None:
    run = channel(tmp_path / "run")
    with pytest.raises(ValueError, match=r"no quantity heet; there are speed, .*, heat$"):
        figure.picture(run, "heet")
    with pytest.raises(ValueError, match="there are speed, pressure, vorticity, heat"):
        nodal_values(run.field(), "heet")


def test_colours_go_from_the_least_to_the_largest_value() -> None:
    values = np.linspace(2.0, 3.0, 1001)
    colour_map, (low, high) = style.colours("heat", values)
    assert colour_map == "plasma"
    assert (low, high) == pytest.approx((2.0, 3.0), abs=2e-3)
    assert style.colours("heat", np.linspace(-1.0, 0.8, 11))[1] == pytest.approx((-1.0, 1.0))
    assert style.label("heat", "SI") == "heat"


def test_slices_scenes_and_surfaces_in_space_have_scalars(tmp_path: Path) -> None:
    run = block(tmp_path / "run")
    cut = Cut(parsed("z=1.5"), np.array([0.0, 0.0]), np.array([3.0, 3.0]))
    part = slice_of(run.field(), cut, "heat")
    # Below zero, too: it is no magnitude
    assert part.point_data["values"].min() < -2.9
    x, y, _ = np.asarray(part.points).T
    corners = np.isclose(x % 0.25, 0.0) & np.isclose(y % 0.25, 0.0)
    own = np.asarray(part.point_data["values"])[corners]
    assert own == pytest.approx((x**2 - y)[corners], abs=1e-6)
    assert slices.slice_picture(run, "heat", plane="z=1.5").axes[-1].get_ylabel() == "heat"
    assert ("fluid", "heat") in scenery.scenery(run).scales
    box = np.array([[0.0] * 3, [3.0] * 3])
    quantity, level = isosurfaces.parsed("heat=-0.5", run.scalars)
    surface = isosurfaces.isosurface(run.case, run.field(), quantity, level, box)
    x, y, _ = np.asarray(surface.points).T
    assert np.abs(x**2 - y + 0.5).max() < 0.15
    for wrong in ("heat", "heat=warm", "cold=1"):
        with pytest.raises(ValueError, match=r"or heat=0\.5"):
            isosurfaces.parsed(wrong, run.scalars)


def test_scalars_are_in_files_for_other_programs(tmp_path: Path) -> None:
    import pyvista

    run = channel(tmp_path / "run")
    field = run.field()
    assert tables.grid(field).point_data["heat"] == pytest.approx(warm(field.nodes))
    write_fields(run, None, tmp_path / "out")
    again = pyvista.read(tmp_path / "out/fields.vtu")
    assert again.point_data["heat"] == pytest.approx(warm(field.nodes))
