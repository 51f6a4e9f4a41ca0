"""Quadratic tetrahedra as straight pieces, and slices through them."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import block

from alewife_post import cuts, tetrahedra
from alewife_post.planes import straight
from alewife_post.read import Field

Array = np.ndarray


def reference() -> Array:
    corners = np.vstack([np.zeros(3), np.eye(3)])
    return np.vstack([corners, corners[tetrahedra.ENDS].mean(axis=1)])


def test_shape_functions_are_those_of_the_nodes() -> None:
    np.testing.assert_allclose(tetrahedra.shape_functions(reference()), np.eye(10), atol=1e-15)
    points = np.random.default_rng(1).dirichlet(np.ones(4), 50)[:, 1:]
    x, y, z = reference().T
    quadratic = 1 + x - 2 * y * z + 3 * x**2 + x * y
    own = 1 + points[:, 0] - 2 * points[:, 1] * points[:, 2] + 3 * points[:, 0] ** 2
    own += points[:, 0] * points[:, 1]
    np.testing.assert_allclose(tetrahedra.shape_functions(points) @ quadratic, own, atol=1e-13)


@pytest.mark.parametrize("halvings", [0, 1, 2, 3])
def test_pieces_fill_their_tetrahedron_and_share_their_points(halvings: int) -> None:
    pieces, weights = tetrahedra.subdivide(halvings)
    assert len(pieces) == 8**halvings
    n = 2**halvings
    assert len(weights) == (n + 1) * (n + 2) * (n + 3) // 6
    points = (weights @ reference())[pieces]
    volumes = np.abs(np.linalg.det(points[:, 1:] - points[:, :1])) / 6
    assert volumes == pytest.approx(1 / 6 / 8**halvings)


def test_bounds_hold_what_goes_beyond_the_nodes() -> None:
    values = np.zeros(10)
    values[[0, 1, 4]] = 0.0, 0.9, 1.0
    low, high = tetrahedra.bounds(values, np.arange(10)[None])
    _, weights = tetrahedra.subdivide(5)
    inner = weights @ values
    assert inner.max() > 1.0
    assert low[0] <= inner.min()
    assert inner.max() <= high[0]


def rounded() -> Field:
    """The block in its box, as a cylinder in a cylinder, whose sides are quadratic."""
    nodes, cells = block()
    away = nodes[:, :2] - 1.5
    length = np.linalg.norm(away, axis=1)
    factor = np.abs(away).max(axis=1) / np.where(length > 0, length, 1.0)
    nodes = np.column_stack([1.5 + away * factor[:, None], nodes[:, 2]])
    zero = np.zeros(len(nodes))
    return Field(0.0, nodes, cells, np.zeros_like(nodes), zero, np.zeros_like(nodes))


def test_a_slice_has_the_curved_sides_of_its_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    field = rounded()
    cut = cuts.Cut(straight(2, 0.37), np.full(2, -1.0), np.full(2, 4.0))
    area = cuts.slice_of(field, cut, "pressure").area
    monkeypatch.setattr(cuts, "HALVINGS", 5)
    exact = cuts.slice_of(field, cut, "pressure").area
    monkeypatch.setattr(cuts, "HALVINGS", 1)
    between_nodes = cuts.slice_of(field, cut, "pressure").area
    assert area == pytest.approx(exact, rel=3e-3)
    assert between_nodes < 0.99 * exact


@pytest.mark.parametrize("end", [0.0, 3.0])
def test_a_plane_that_the_mesh_ends_at_has_its_flow(end: float) -> None:
    # As where a flow is symmetric, and computed on one side only
    field = rounded()
    cut = cuts.Cut(straight(2, end), np.full(2, -1.0), np.full(2, 4.0))
    inner = cuts.Cut(straight(2, abs(end - 0.01)), np.full(2, -1.0), np.full(2, 4.0))
    area = cuts.slice_of(field, inner, "pressure").area
    assert cuts.slice_of(field, cut, "pressure").area == pytest.approx(area, rel=0.01)
    # Planes inside stay where they are
    assert cuts.within(inner.plane, field) is inner.plane


def test_a_magnitude_is_nowhere_negative() -> None:
    field = rounded()
    # A quadratic through 0, 0 and 1 at the nodes of an edge goes below zero beyond them
    velocity = np.zeros_like(field.nodes)
    velocity[field.cells[::3, 2], 0] = 1.0
    shown = Field(0.0, field.nodes, field.cells, velocity, field.pressure, field.vorticity)
    cut = cuts.Cut(straight(2, 1.03), np.zeros(2), np.full(2, 3.0))
    own = np.linalg.norm(velocity, axis=1)
    _, weights = tetrahedra.subdivide(cuts.HALVINGS)
    assert (weights @ own[field.cells].T).min() < -0.05
    values = np.asarray(cuts.slice_of(shown, cut, "speed").point_data["values"])
    assert values.min() >= 0.0
    assert values.max() > 0.5
