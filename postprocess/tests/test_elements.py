"""Quadratic triangles are drawn as what they are."""

import numpy as np

from alewife_post import Run
from alewife_post.elements import (
    edge_curves,
    edges,
    inside,
    mirrored,
    quarters,
    refine,
    shape_functions,
    subdivide,
)


def area(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    u, v = b - a, c - a
    areas = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    assert (areas > 0).all()
    return float(areas.sum())


def test_each_shape_function_is_one_at_its_own_node_only() -> None:
    nodes = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
    np.testing.assert_allclose(shape_functions(nodes), np.eye(6), atol=1e-15)


def test_finer_triangles_come_nearer_to_the_ring(planar_run: Run) -> None:
    field = planar_run.field()
    errors = []
    for level in (1, 2, 4, 8):
        triangles, weights = subdivide(field.cells, level)
        assert len(triangles) == level**2 * len(field.cells)
        points = refine(field.nodes, field.cells, weights)
        errors.append(abs(area(points, triangles) / (3 * np.pi) - 1))
    # Order 2 towards cells bounded by parabolas, which differ a little from circles themselves.
    ratios = np.array(errors[:-1]) / errors[1:]
    assert (ratios > 3.3).all()


def test_quadratic_values_are_refined_exactly(planar_run: Run) -> None:
    field = planar_run.field()
    _, weights = subdivide(field.cells, 3)
    fine = refine(field.nodes, field.cells, weights)
    np.testing.assert_allclose(refine(3 * field.nodes, field.cells, weights), 3 * fine)


def test_quarters_cover_the_mesh_with_its_own_nodes(planar_run: Run) -> None:
    field = planar_run.field()
    triangles, weights = subdivide(field.cells, 2)
    coarse = area(field.nodes, quarters(field.cells))
    fine = area(refine(field.nodes, field.cells, weights), triangles)
    np.testing.assert_allclose(coarse, fine)


def test_the_boundary_of_a_ring_is_two_circles(planar_run: Run) -> None:
    field = planar_run.field()
    every, is_boundary = edges(field.cells)
    assert len(every) == len(field.nodes) - len(np.unique(field.cells[:, :3]))
    radii = np.linalg.norm(edge_curves(field.nodes, every[is_boundary]), axis=-1)
    assert (np.minimum(abs(radii - 1), abs(radii - 2)) < 1e-3).all()


def test_a_mirror_image_closes_the_half_plane(axisymmetric_run: Run) -> None:
    half = axisymmetric_run.field()
    whole = mirrored(half)
    triangles, weights = subdivide(whole.cells, 4)
    points = refine(whole.nodes, whole.cells, weights)
    assert abs(area(points, triangles) / (3 * np.pi) - 1) < 2e-3
    # The axis is inside now: the boundary is the two circles only.
    every, is_boundary = edges(whole.cells)
    middle = whole.nodes[every[is_boundary][:, 2]]
    radii = np.linalg.norm(middle, axis=1)
    np.testing.assert_allclose(np.minimum(abs(radii - 1), abs(radii - 2)), 0.0, atol=1e-12)
    below = whole.nodes[:, 1] < 0
    np.testing.assert_allclose(whole.vorticity[below], -2 * whole.nodes[below, 1])


def test_cells_out_of_view_are_left_out(planar_run: Run) -> None:
    field = planar_run.field()
    seen = inside(field, (1.0, 2.0, 0.0, 0.5))
    assert 0 < len(seen.cells) < len(field.cells) / 2
