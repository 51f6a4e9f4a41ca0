"""Gradients and tractions of flows that are known, and the forces tractions add up to."""

from __future__ import annotations

import json
from pathlib import Path

import meshes
import numpy as np
import pytest
from conftest import CAN_RENDER, ring

from alewife_post import Run, derived, exports, traction
from alewife_post.cli import main

VISCOSITY = 0.7
SPHERE = """
[fluid]
model = "{model}"
viscosity = {viscosity}
[[body]]
name = "ball"
center = [0.0]
shape.sphere = {{ radius = 1.0 }}
"""


def order(errors: list[float]) -> float:
    """Power of the size of cells of the last error, which is halved each time."""
    return float(np.log2(errors[-2] / errors[-1]))


def sphere(path: Path, n: int, model: str = "stokes") -> Run:
    """A sphere that moves along the axis with speed 1, in Stokes flow (Lamb 1932)."""
    nodes, cells = meshes.shell(n, n, (1.0, 4.0), np.pi)
    x, y = nodes.T
    r = np.hypot(x, y)
    radial = (1.5 / r - 0.5 / r**3) * x / r
    around = -(0.75 / r + 0.25 / r**3) * y / r
    e, t = np.stack([x, y], 1) / r[:, None], np.stack([-y, x], 1) / r[:, None]
    velocity = radial[:, None] * e + around[:, None] * t
    velocity[np.abs(y) < 1e-12, 1] = 0.0
    pressure = 1.5 * VISCOSITY * x / r**3
    top = meshes.TOP.format(
        geometry="axisymmetric", domain="half-disc = { radius = 4.0 }", time="unsteady",
        body=SPHERE.format(model=model, viscosity=VISCOSITY),
    )  # fmt: skip
    nodes[np.abs(y) < 1e-12, 1] = 0.0
    return meshes.written(path, [(0.0, nodes, cells, velocity, pressure)], top)


@pytest.mark.parametrize("model", ["stokes", "unsteady-stokes"])
def test_the_traction_on_a_sphere_is_of_second_order(tmp_path: Path, model: str) -> None:
    errors, forces = [], []
    for n in (8, 16, 32):
        run = sphere(tmp_path / f"{model}-{n}", n, model)
        ball, wall = traction.surfaces_of(run, run.field())
        assert (ball.facets.name, wall.facets.name) == ("ball", "wall")
        assert ball.method == ("residual" if model == "stokes" else "recovered")
        assert np.linalg.norm(ball.normal - run.field().nodes[ball.nodes], axis=1).max() < 5 / n**2
        exact = np.array([-1.5 * VISCOSITY, 0.0])
        errors.append(np.abs(ball.traction - exact).max())
        forces.append(abs(ball.force[0] / (-6 * np.pi * VISCOSITY) - 1))
        assert ball.force[1] == 0.0
    assert order(errors) > 1.8
    assert errors[-1] < 0.02
    assert forces[-1] < (1e-5 if model == "stokes" else 2e-4)


def test_gradients_are_of_second_order_and_exact_for_quadratic_flows() -> None:
    errors = []
    for n in (6, 12, 24):
        nodes, cells = meshes.rectangle((n, n), np.zeros(2), np.ones(2), 0.15)
        x, y = nodes.T
        velocity = np.stack([np.sin(2 * x) * np.cos(2 * y), -np.cos(2 * x) * np.sin(2 * y)], 1)
        own = derived.rates(meshes.field(nodes, cells, velocity), is_axisymmetric=False)
        along, mixed = 2 * np.cos(2 * x) * np.cos(2 * y), -2 * np.sin(2 * x) * np.sin(2 * y)
        exact = np.moveaxis(np.array([[along, mixed], [-mixed, -along]]), 2, 0)
        errors.append(np.abs(own.gradient - exact).max())
        assert own.vorticity == pytest.approx(-2 * mixed, abs=2 * errors[-1])
        assert own.q == pytest.approx(mixed**2 - along**2, abs=20 * errors[-1])
    assert order(errors) > 1.8
    nodes, cells = meshes.box(2, 0.0, 1.0)
    x, y, z = nodes.T
    own = derived.rates(
        meshes.field(nodes, cells, np.stack([y * y, z * x, x], 1)), is_axisymmetric=False
    )
    assert own.vorticity == pytest.approx(np.stack([-x, -1 + 0 * x, z - 2 * y], 1))
    assert own.divergence == pytest.approx(0 * x, abs=1e-12)
    shear = (2 * y + z) ** 2 + 1 + x**2
    assert own.shear_rate == pytest.approx(np.sqrt(shear))


def test_a_flow_around_an_axis_has_its_rate_around_it() -> None:
    nodes, cells = meshes.rectangle((4, 4), np.zeros(2), np.ones(2))
    # Extension along the axis
    own = derived.rates(
        meshes.field(nodes, cells, np.stack([2 * nodes[:, 0], -nodes[:, 1]], 1)),
        is_axisymmetric=True,
    )
    assert own.hoop == pytest.approx(-1.0)
    assert own.divergence == pytest.approx(0.0, abs=1e-12)
    assert own.shear_rate == pytest.approx(np.sqrt(12.0))


def test_the_viscosity_follows_the_law_of_the_case() -> None:
    def at(law: object, rate: float) -> float:
        return float(derived.viscosity({"fluid": {"viscosity": law}}, np.array([rate]))[0])

    plateaus = {"zero": 2.0, "infinite": 0.5, "time": 3.0, "index": 0.4}
    assert at(1.5, 7.0) == 1.5
    assert at({"carreau": plateaus}, 0.0) == 2.0
    assert at({"carreau": plateaus}, 1e9) == pytest.approx(0.5, abs=1e-4)
    assert at({"carreau": plateaus}, 2.0) == pytest.approx(0.5 + 1.5 * 37**-0.3)
    assert at({"cross": plateaus}, 2.0) == pytest.approx(0.5 + 1.5 / (1 + 6**0.6))
    power = {"consistency": 2.0, "index": 0.5, "regularised": 1e-9}
    assert at({"power-law": power}, 4.0) == pytest.approx(1.0)
    assert at({"herschel-bulkley": {**power, "yield_stress": 3.0}}, 4.0) == pytest.approx(1.75)


def test_tractions_in_space_add_up_to_the_divergence_of_the_stress(tmp_path: Path) -> None:
    nodes, cells = meshes.box(6, 0.0, 3.0, lambda at: (np.abs(at - 1.5) < 0.5).all(axis=1))
    x, y, _ = nodes.T
    body = SPHERE.format(model="stokes", viscosity=VISCOSITY).replace("[0.0]", "[1.5, 1.5, 1.5]")
    top = meshes.TOP.format(
        geometry="spatial", domain="box = { min = [0.0, 0.0, 0.0], max = [3.0, 3.0, 3.0] }",
        time="steady", body=body,
    )  # fmt: skip
    # Plane Poiseuille flow, whose pressure carries its shear: no force on a cube of fluid
    velocity = np.stack([y**2, 0 * x, 0 * x], 1)
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, velocity, 2 * VISCOSITY * x)], top)
    ball, *sides = traction.surfaces_of(run, run.field())
    assert {side.facets.name for side in sides} == {
        "left", "right", "bottom", "top", "back", "front",
    }  # fmt: skip
    assert len(ball.facets.nodes) == 6 * 2 * 4
    assert ball.force == pytest.approx(np.zeros(3), abs=1e-11)
    # In the middle of the top of the cube
    # A cube has edges: three normals at each corner, two on each edge
    assert len(ball.nodes) == 6 * 25
    away = run.field().nodes[ball.nodes] - [1.5, 2.0, 1.5]
    (top_node,) = np.flatnonzero(np.abs(away).max(axis=1) < 1e-9)
    assert ball.normal[top_node] == pytest.approx([0.0, 1.0, 0.0])


def test_tractions_of_a_computed_flow_add_up_to_its_force(
    computed_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["fields", str(computed_run.path), "--out", str(tmp_path / "out"), "--json"]) == 0
    row, side = json.loads(capsys.readouterr().out)
    largest = max(
        float(np.abs(one.traction).max())
        for one in traction.surfaces_of(computed_run, computed_run.field())
    )
    assert (row["surface"], row["body"], row["is"]) == ("squirmer", "squirmer", "body")
    assert (side["surface"], side["is"], side["method"]) == ("wall", "side", "recovered")
    assert row["method"] == "residual"
    assert abs(row["traction.x"] - row["force.x"]) < 1e-10 * largest


def test_files_have_all_fields(tmp_path: Path) -> None:
    import pyvista

    run = sphere(tmp_path / "run", 8)
    found = exports.write_fields(run, None, tmp_path / "out")
    fluid, surface = (pyvista.read(path) for path in found.paths)
    assert {
        "velocity", "pressure", "vorticity", "strain_rate", "shear_rate", "q", "divergence",
        "viscosity", "stream_function",
    } <= set(fluid.point_data.keys())  # fmt: skip
    assert {
        "traction",
        "traction_recovered",
        "viscous_traction",
        "wall_shear",
        "normal",
        "pressure",
        "body",
    } <= set(surface.point_data.keys())
    assert list(surface.field_data["surfaces"]) == ["ball", "wall"]
    # Stokes's stream function of the moving sphere, across the whole flow
    r = np.linalg.norm(fluid.points[:, :2], axis=1)
    exact = 0.25 * (3 * r - 1 / r) * (fluid.points[:, 1] / r) ** 2
    assert fluid.point_data["stream_function"] == pytest.approx(exact, abs=0.02 * exact.max())


@pytest.mark.skipif(not CAN_RENDER, reason="VTK can have no window here")
def test_pictures_show_derived_quantities(tmp_path: Path) -> None:
    run = sphere(tmp_path / "run", 8)
    for quantity in ("shear-rate", "q"):
        out = tmp_path / f"{quantity}.png"
        given = ["picture", str(run.path), "--quantity", quantity, "--out", str(out)]
        assert main(given) == 0


def test_a_body_periods_away_from_its_mesh_has_its_surface(tmp_path: Path) -> None:
    nodes, cells = ring()
    body = SPHERE.format(model="stokes", viscosity=VISCOSITY).replace("[0.0]", "[20.0, 0.0]")
    top = meshes.TOP.format(
        geometry="planar", domain="channel = { length = 10.0, height = 4.0 }", time="steady",
        body="[boundary]\nleft = { periodic = {} }\n" + body,
    )  # fmt: skip
    run = meshes.written(tmp_path / "run", [(0.0, nodes, cells, 0 * nodes, nodes[:, 0])], top)
    ball, sides = traction.facets_of(run, run.field())
    assert (ball.name, sides.name) == ("ball", traction.SIDES)
    assert np.linalg.norm(nodes[ball.nodes], axis=2) == pytest.approx(1.0, abs=1e-6)
