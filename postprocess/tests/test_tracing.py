"""Traced lines follow the flow, lie evenly, and are as symmetric as it is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from alewife_post import tracing

Array = np.ndarray
VIEW = (-3.0, 3.0, -2.0, 2.0)
SPACING = tracing.SPACING * np.sqrt(24.0)


def grid_of(flow: Callable[[Array], Array], view: tuple = VIEW, hole: float = 0.0) -> tracing.Grid:
    """A flow on a grid, masked within a circle."""
    x, y = np.linspace(*view[:2], 151), np.linspace(*view[2:], 101)
    points = np.stack(np.meshgrid(x, y), axis=-1)
    velocity = flow(points.reshape(-1, 2)).reshape(points.shape)
    is_hole = (points**2).sum(axis=2) < hole**2
    return tracing.Grid.of(x, y, np.ma.masked_array(velocity, np.stack([is_hole] * 2, axis=2)))


def past_disc(points: Array) -> Array:
    """The potential flow past a disc of radius one: its own image in y = 0, reversed in x = 0."""
    z = points @ [1.0, 1j]
    w = 1.0 - 1.0 / np.where(np.abs(z) > 0, z, 1.0) ** 2
    return np.column_stack([w.real, -w.imag])


def psi_of_disc(points: Array) -> Array:
    r2 = (points**2).sum(axis=1)
    return points[:, 1] * (1.0 - 1.0 / r2)


def shaken(points: Array) -> Array:
    """The same, with errors as those of a mesh."""
    noise = np.random.default_rng(3).normal(size=points.shape)
    return past_disc(points) + 0.02 * noise


def distances(points: Array, others: Array) -> Array:
    away = [np.linalg.norm(others - point, axis=1).min() for point in points]
    return np.array(away)


def test_mirrors_of_a_flow_are_found_with_their_signs() -> None:
    grid = grid_of(shaken, hole=1.0)
    assert tracing.found_mirror(grid, 1, 0.0).sign == 1.0
    assert tracing.found_mirror(grid, 0, 0.0).sign == -1.0
    assert tracing.found_mirror(grid, 1, 0.4) is None
    oblique = grid_of(lambda points: past_disc(points @ [[0.8, 0.6], [-0.6, 0.8]]), hole=1.0)
    assert tracing.found_mirror(oblique, 0, 0.0) is None
    assert tracing.found_mirror(oblique, 1, 0.0) is None


@pytest.mark.parametrize("view", [VIEW, (-3.0, 3.0, -1.2, 2.0)])
def test_lines_of_a_symmetric_flow_are_images_of_each_other(view: tuple) -> None:
    # Where the view is not symmetric, the lines are as far as it goes
    grid = grid_of(shaken, hole=1.0)
    found = tracing.traced(grid, view, [np.zeros(2)])
    assert len(found.lines) >= 20
    points = np.concatenate(found.lines)
    both = np.abs(points[:, 1]) <= min(-view[2], view[3]) - 1e-9
    for flip in ([1.0, -1.0], [-1.0, 1.0]):
        assert distances(points[both][::7] * flip, points).max() < 1e-9
    heads = np.column_stack([found.heads, found.directions])
    inside = np.abs(heads[:, 1]) < -view[2]
    assert len(heads) > 20
    # The flow goes to larger x on both sides of x = 0
    for flip in ([1.0, -1.0, 1.0, -1.0], [-1.0, 1.0, 1.0, -1.0]):
        assert distances(heads[inside] * flip, heads).max() < 1e-9


def test_a_flow_that_is_not_symmetric_is_drawn_as_it_is() -> None:
    def turning(points: Array) -> Array:
        return past_disc(points) + np.column_stack([points[:, 1], 0 * points[:, 0]])

    grid = grid_of(turning, hole=1.0)
    found = tracing.traced(grid, VIEW, [np.zeros(2)])
    flow = turning(found.heads)
    cosine = (flow * found.directions).sum(axis=1) / np.linalg.norm(flow, axis=1)
    assert len(found.heads) > 20
    assert cosine.min() > 0.95
    # Below y = -1 the shear goes back
    assert (found.directions[:, 0] < -0.5).any()
    assert (found.directions[:, 0] > 0.5).any()


def test_the_stream_function_is_constant_along_lines() -> None:
    found = tracing.traced(grid_of(past_disc, hole=1.0), VIEW, [])
    for line in found.lines:
        # But within a cell of the disc, where neighbours stand for what is not fluid
        away = line[np.linalg.norm(line, axis=1) > 1.15]
        if len(away) > 1:
            assert np.ptp(psi_of_disc(away)) < 0.05 * SPACING


def test_lines_lie_evenly_over_the_fluid() -> None:
    grid = grid_of(past_disc, hole=1.0)
    found = tracing.traced(grid, VIEW, [])
    spacing = tracing.SPACING * np.sqrt(grid.area)
    for nth, line in enumerate(found.lines):
        others = np.concatenate(found.lines[:nth] + found.lines[nth + 1 :])
        # Pieces of a line on both sides of a line of symmetry meet there; steps are of some length
        inner = line[(np.abs(line) > spacing).all(axis=1)]
        if len(inner):
            assert distances(inner[::3], others).min() > 0.9 * tracing.CLOSEST * spacing
    every = np.concatenate(found.lines)
    places = np.random.default_rng(5).uniform([-3.0, -2.0], [3.0, 2.0], (400, 2))
    places = places[np.linalg.norm(places, axis=1) > 1.1]
    gaps = distances(places, every)
    assert gaps.max() < 2.0 * spacing
    assert 0.2 * spacing < gaps.mean() < 0.6 * spacing


def test_a_vortex_has_closed_lines() -> None:
    found = tracing.traced(grid_of(lambda points: points @ [[0.0, 1.0], [-1.0, 0.0]]), VIEW, [])
    inner = [line for line in found.lines if np.linalg.norm(line, axis=1).max() < 1.9]
    assert len(inner) > 4
    for line in inner:
        assert np.ptp(np.linalg.norm(line, axis=1)) < 0.02 * SPACING


def test_a_fluid_at_rest_has_no_lines() -> None:
    assert tracing.traced(grid_of(lambda points: 0 * points), VIEW, []).lines == []


def test_lines_end_at_walls_and_not_before() -> None:
    grid = grid_of(past_disc, hole=1.0)
    wide = grid.widened()
    cell = grid.x[1] - grid.x[0]
    edge = np.array([[-1.0 + 0.3 * cell, 0.0], [-1.0 + 2.5 * cell, 0.0]])
    assert np.isnan(grid.at(edge)).all()
    assert np.isfinite(wide.at(edge)).all(axis=1).tolist() == [True, False]
    np.testing.assert_array_equal(np.isfinite(grid.velocity) & ~np.isfinite(wide.velocity), False)


def test_lines_do_not_begin_along_walls() -> None:
    # A narrow channel: all lines are along it, and none lies as near a wall as half a spacing
    def channel(points: Array) -> Array:
        inner = np.abs(points[:, 1]) < 0.6
        return np.column_stack([np.where(inner, 0.36 - points[:, 1] ** 2, 0.0), 0 * points[:, 0]])

    grid = grid_of(channel)
    spacing = tracing.SPACING * np.sqrt(grid.area)
    heights = [line[:, 1] for line in tracing.traced(grid, VIEW, []).lines]
    assert len(heights) >= 4
    assert max(np.abs(height).max() for height in heights) < 0.6 - 0.4 * spacing
