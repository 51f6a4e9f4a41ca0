"""Streamlines are contours of the stream function, and as symmetric as the flow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alewife_post import Run, figure, streamlines
from alewife_post.elements import inside, refine, shared_points, subdivide
from alewife_post.read import Field
from alewife_post.streamfunction import stream_function
from alewife_post.streamlines import Piece

Array = np.ndarray
Map = Callable[[Array, Array], tuple[Array, Array]]


def straight(x: Array, y: Array) -> tuple[Array, Array]:
    return x, y


def around(start: float, end: float, outer: float) -> Map:
    """The unit square as what is between two circles and two angles."""

    def mapped(s: Array, t: Array) -> tuple[Array, Array]:
        angle, radius = start + (end - start) * t, outer**s
        return radius * np.cos(angle), radius * np.sin(angle)

    return mapped


def mesh(n: int, m: int, form: Map, velocity: Callable[[Array], Array]) -> Field:
    """Quadratic triangles of n by m quadrilaterals; what meets on itself is joined."""
    s, t = np.meshgrid(np.arange(2 * n + 1), np.arange(2 * m + 1), indexing="ij")
    nodes = np.column_stack(form(s.ravel() / (2 * n), t.ravel() / (2 * m)))
    number = np.arange(len(nodes)).reshape(s.shape)
    if np.allclose(nodes[number[:, 0]], nodes[number[:, -1]]):
        number[:, -1] = number[:, 0]
    cells = []
    for i, j in np.ndindex(n, m):
        a, b, c, d = (2 * i, 2 * j), (2 * i + 2, 2 * j), (2 * i + 2, 2 * j + 2), (2 * i, 2 * j + 2)
        for corners in ((a, b, c), (a, c, d)):
            middles = [
                ((p[0] + q[0]) // 2, (p[1] + q[1]) // 2)
                for p, q in zip(corners, (*corners[1:], corners[0]), strict=True)
            ]
            cells.append([number[at] for at in (*corners, *middles)])
    nodes[np.abs(nodes) < 1e-14] = 0.0
    zero = np.zeros(len(nodes))
    return Field(0.0, nodes, np.array(cells), velocity(nodes), zero, zero)


def polar(nodes: Array) -> tuple[Array, Array]:
    return np.hypot(*nodes.T), np.arctan2(nodes[:, 1], nodes[:, 0])


def cartesian(nodes: Array, radial: Array, angular: Array) -> Array:
    _, angle = polar(nodes)
    along = np.column_stack([np.cos(angle), np.sin(angle)])
    return radial[:, None] * along + angular[:, None] * along[:, ::-1] * [-1.0, 1.0]


def channel_flow(nodes: Array) -> Array:
    y = nodes[:, 1]
    return np.column_stack([y * (1 - y), 0 * y])


def channel_psi(nodes: Array) -> Array:
    y = nodes[:, 1]
    return y**2 / 2 - y**3 / 3


def disc_flow(nodes: Array) -> Array:
    """A circular squirmer: a source dipole, and a stresslet with its quadrupole."""
    r, angle = polar(nodes)
    return cartesian(
        nodes,
        np.cos(angle) / (2 * r**2) + 2 * (r**-3.0 - 1 / r) * np.cos(2 * angle),
        np.sin(angle) / (2 * r**2) + 2 * r**-3.0 * np.sin(2 * angle),
    )


def disc_psi(nodes: Array) -> Array:
    r, angle = polar(nodes)
    return np.sin(angle) / (2 * r) + (r**-2.0 - 1) * np.sin(2 * angle)


def sphere_flow(nodes: Array) -> Array:
    """The squirmer of Blake with B1 = 1.5 and B2 = 3 in the frame of the fluid at rest."""
    r, angle = polar(nodes)
    cos, sin = np.cos(angle), np.sin(angle)
    return cartesian(
        nodes,
        cos / r**3 + 3 * (r**-4.0 - r**-2.0) * 0.5 * (3 * cos**2 - 1),
        0.5 * sin / r**3 + 3 * r**-4.0 * sin * cos,
    )


def sphere_psi(nodes: Array) -> Array:
    r, angle = polar(nodes)
    return (0.5 / r + 1.5 * (r**-2.0 - 1) * np.cos(angle)) * np.sin(angle) ** 2


FLOWS = {
    "channel": (straight, channel_flow, channel_psi, False),
    "disc": (around(0.0, 2 * np.pi, 5.0), disc_flow, disc_psi, False),
    "sphere": (around(0.0, np.pi, 5.0), sphere_flow, sphere_psi, True),
}


@pytest.mark.parametrize("name", FLOWS)
def test_psi_of_known_flows_is_found_with_third_order(name: str) -> None:
    form, velocity, psi, is_axisymmetric = FLOWS[name]
    errors = []
    for n in (6, 12, 24):
        field = mesh(n, 4 * n, form, velocity)
        found = stream_function(field, is_axisymmetric=is_axisymmetric)
        wanted = psi(field.nodes)
        used = np.unique(field.cells)
        difference = (found.values - wanted)[used]
        if not is_axisymmetric:
            difference = difference - difference.mean()
        errors.append(np.abs(difference).max() / np.ptp(wanted))
        assert found.misfit < 0.02
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] < 2e-4
    # A cubic is not in the space of psi; quadratic velocities are of third order as well.
    assert orders.min() > 2.7, (errors, orders)


def test_each_piece_of_an_axis_has_one_value_and_a_source_between_them_its_flux() -> None:
    # Fluid comes out of a sphere: 2 pi psi is the flux through a circle around the axis.
    def source(nodes: Array) -> Array:
        r, _ = polar(nodes)
        return cartesian(nodes, r**-2.0, 0 * r)

    field = mesh(8, 24, around(0.0, np.pi, 3.0), source)
    found = stream_function(field, is_axisymmetric=True)
    x = field.nodes[:, 0]
    used = np.isin(np.arange(len(x)), field.cells) & (field.nodes[:, 1] == 0.0)
    before, behind = (found.values[used & side] for side in (x < 0, x > 0))
    assert np.ptp(before) == 0.0
    assert np.ptp(behind) == 0.0
    assert before[0] == 0.0
    assert behind[0] == pytest.approx(-2.0, rel=1e-3)


def test_a_flow_with_a_source_inside_a_body_has_no_stream_function(planar_run: Run) -> None:
    def source(nodes: Array) -> Array:
        r, _ = polar(nodes)
        return cartesian(nodes, 1 / r, 0 * r)

    field = mesh(6, 24, around(0.0, 2 * np.pi, 2.0), source)
    assert stream_function(field, is_axisymmetric=False).misfit > 0.99
    view = (-2.0, 2.0, -2.0, 2.0)
    assert streamlines.streamlines(planar_run, field, view, mirror=False) is None
    # It is drawn all the same, by lines that follow the velocity.
    drawn = figure.picture(planar_run, lines="streamlines", painter="matplotlib")
    drawn.canvas.draw()


def test_a_fluid_at_rest_has_no_streamlines(planar_run: Run) -> None:
    field = mesh(4, 4, straight, lambda nodes: 0 * nodes)
    assert streamlines.streamlines(planar_run, field, (0.0, 1.0, 0.0, 1.0), mirror=False) is None


def periodic_run(path: Path, geometry: str = "planar") -> Run:
    (path / "case.toml").write_text(
        f'title = "a box"\ngeometry = "{geometry}"\n[time.steady]\n'
        "[domain.box]\nmin = [0.0, 0.0]\nmax = [1.0, 1.0]\n"
        '[boundary]\nleft.periodic = "right"\nbottom.periodic = "top"\n'
    )
    return Run(path)


def test_lines_go_on_through_periodic_sides_with_the_flow_through_them(tmp_path: Path) -> None:
    # A mean flow across the box: psi grows by it from each image to the next.
    field = mesh(6, 6, straight, lambda nodes: np.tile([2.0, 1.0], (len(nodes), 1)))
    view = (-0.5, 1.5, -0.5, 1.5)
    found = streamlines.streamlines(periodic_run(tmp_path), field, view, mirror=False)
    levels = np.concatenate([line @ [-1.0, 2.0] for line in found.lines])
    for line in found.lines:
        np.testing.assert_allclose(line @ [-1.0, 2.0], (line @ [-1.0, 2.0])[0], atol=1e-5)
    # The same levels in all four images, so that lines meet at the sides
    n = 1 + np.count_nonzero(np.diff(np.sort(levels)) > 1e-3)
    assert n <= streamlines.MOST_LINES
    assert len(found.lines) > n


def test_arrow_heads_point_where_the_fluid_goes(tmp_path: Path) -> None:
    run = periodic_run(tmp_path)
    field = mesh(12, 48, around(0.0, 2 * np.pi, 5.0), disc_flow)
    found = streamlines.streamlines(replace_case(run), field, (-3.0, 3.0, -2.0, 2.0), mirror=False)
    flow = disc_flow(found.heads)
    flow = flow / np.linalg.norm(flow, axis=1)[:, None]
    assert len(found.heads) > 20
    # Chords of polylines are not quite along the flow.
    assert (flow * found.directions).sum(axis=1).min() > 0.97


def replace_case(run: Run, geometry: str = "planar") -> Run:
    """The same in a domain without periodic sides."""
    (run.path / "case.toml").write_text(
        f'title = "a disc"\ngeometry = "{geometry}"\n[time.steady]\n[domain.disc]\nradius = 5.0\n'
    )
    return Run(run.path)


def distance(points: Array, lines: list[Array]) -> float:
    """The largest distance of some points from what is drawn by lines."""
    starts = np.concatenate([line[:-1] for line in lines])
    steps = np.concatenate([np.diff(line, axis=0) for line in lines])
    is_long = (steps**2).sum(axis=1) > 0
    starts, steps = starts[is_long], steps[is_long]
    largest = 0.0
    for point in points:
        share = np.clip(((point - starts) * steps).sum(axis=1) / (steps**2).sum(axis=1), 0.0, 1.0)
        away = starts + share[:, None] * steps - point
        largest = max(largest, float(np.sqrt((away**2).sum(axis=1).min())))
    return largest


def test_a_symmetric_flow_has_symmetric_lines_and_heads_on_an_unsymmetric_mesh(
    tmp_path: Path,
) -> None:
    # The flow is symmetric about y = 0; the mesh, turned by an odd angle, is not.
    run = replace_case(periodic_run(tmp_path))
    field = mesh(20, 80, around(0.3, 0.3 + 2 * np.pi, 5.0), disc_flow)
    found = streamlines.streamlines(run, field, (-3.0, 3.0, -2.0, 2.0), mirror=False)
    flipped = [line * [1.0, -1.0] for line in found.lines]
    # Less than a line is wide: 0.6 points on a page of 7 inches
    width = 6.0 * 0.6 / 72 / 7
    assert distance(np.concatenate(flipped)[::5], found.lines) < width
    heads = np.column_stack([found.heads, found.directions])
    images = heads * [1.0, -1.0, 1.0, -1.0]
    gaps = np.linalg.norm(heads[:, None] - images[None], axis=2).min(axis=1)
    assert gaps.max() < 0.05, heads[gaps > 0.05]


def test_levels_of_a_symmetric_flow_are_symmetric_and_others_are_left_alone() -> None:
    view = (0.0, 1.0, 0.0, 1.0)
    field = mesh(10, 10, straight, channel_flow)
    psi = field.nodes[:, 1] - 0.5 + 1e-3 * field.nodes[:, 0]
    levels = streamlines.chosen_levels([Piece.of(field, psi)], view, 11)
    np.testing.assert_allclose(levels + levels[::-1], 2 * levels[5], atol=1e-12)
    # An eleventh of the area lies between one and the next
    np.testing.assert_allclose(np.diff(levels), 1 / 11, rtol=0.1)
    skewed = streamlines.chosen_levels([Piece.of(field, field.nodes[:, 1] ** 2)], view, 11)
    np.testing.assert_allclose(skewed, ((np.arange(11) + 0.5) / 11) ** 2, atol=0.02)


def test_lines_of_both_sides_of_an_axis_are_mirror_images(tmp_path: Path) -> None:
    run = replace_case(periodic_run(tmp_path), "axisymmetric")
    field = mesh(6, 24, around(0.0, np.pi, 5.0), sphere_flow)
    view = (-2.0, 2.0, -2.0, 2.0)
    found = streamlines.streamlines(run, field, view, mirror=True)
    n = len(found.lines) // 2
    assert n > 10
    for line, image in zip(found.lines[:n], found.lines[n:], strict=True):
        np.testing.assert_array_equal(line * [1.0, -1.0], image)
    half = streamlines.streamlines(run, field, (-2.0, 2.0, 0.0, 2.0), mirror=False)
    assert all((line[:, 1] >= 0.0).all() for line in half.lines)


def test_points_that_cells_share_have_one_number_and_one_place() -> None:
    field = mesh(3, 8, around(0.0, 2 * np.pi, 2.0), disc_flow)
    field = inside(field, (-2.0, 2.0, -2.0, 0.5))
    triangles, weights = subdivide(field.cells, 4)
    places = refine(field.nodes, field.cells, weights)
    numbers = shared_points(field.cells, 4)
    rounded = np.unique(np.round(places, 9), axis=0)
    assert len(np.unique(numbers)) == len(rounded)
    order = np.argsort(numbers, kind="stable")
    same = numbers[order][1:] == numbers[order][:-1]
    gap = np.linalg.norm(places[order][1:] - places[order][:-1], axis=1)
    assert gap[same].max() < 1e-12
    assert triangles.max() < len(numbers)


def test_a_contour_goes_on_from_cell_to_cell() -> None:
    field = mesh(7, 5, straight, channel_flow)
    field = replace(field, nodes=field.nodes * [3.0, 1.0])
    lines = streamlines.Piece.of(field, channel_psi(field.nodes)).contours(
        channel_psi(np.array([[0.0, 0.37]]))
    )
    assert len(lines) == 1
    line = lines[0]
    assert line[0, 0] == pytest.approx(0.0, abs=1e-12)
    assert line[-1, 0] == pytest.approx(3.0)
    np.testing.assert_allclose(line[:, 1], 0.37, atol=2e-3)


def test_of_heads_side_by_side_one_stays() -> None:
    heads = np.array([[1.0, 1.0], [1.02, 1.0], [-1.0, 1.0], [-1.02, 1.01], [1.0, 1.04], [1.2, 1.0]])
    kept = streamlines._apart(heads, np.zeros(2), 0.15)
    away = np.linalg.norm(heads[kept][:, None] - heads[kept][None], axis=2)
    assert (away + np.eye(len(kept)) > 0.15).all()
    assert sorted(kept) == [0, 2, 5]
