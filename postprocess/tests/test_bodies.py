"""Bodies: where they are, what joins them, where they swim to; images in periodic domains."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ring, velocity

from alewife_post import Run, bodies, periodic, planes, ways
from alewife_post.read import BodyHistory, Field, Shape, Solid

STILL = np.array([0.0, 0.0, 0.0, 1.0])
QUARTER = np.array([0.0, 0.0, np.sin(np.pi / 4), np.cos(np.pi / 4)])


def history(centers: np.ndarray, rotation: np.ndarray = STILL) -> BodyHistory:
    """A body at given centres `(n, 3)`, at times 0, 1, ..., always turned the same way."""
    n = len(centers)
    zero = np.zeros((n, 3))
    return BodyHistory(
        time=np.arange(n, dtype=float),
        center=np.asarray(centers, dtype=float),
        angle=np.zeros(n),
        rotation=np.tile(rotation, (n, 1)),
        velocity=zero,
        angular_velocity=zero,
        force=zero,
        torque=zero,
        surface_force=zero,
        surface_torque=zero,
        power=np.zeros(n),
    )


def ball(semi_axes: list[float]) -> list[Shape]:
    size = 2 * np.array(semi_axes)
    return [Shape(0.0, [Solid("ellipsoid", np.zeros(3), STILL, size, (1.0, 1.0))], [])]


def made(
    case: dict[str, Any], found: dict[str, BodyHistory], shapes: dict[str, list[Shape]]
) -> Run:
    """A run that is nowhere on disk."""
    run = Run(Path("nowhere"))
    run.__dict__["case"] = {"geometry": "spatial", "domain": {"sphere": {"radius": 9.0}}} | case
    run.__dict__["_bodies_and_shapes"] = (found, shapes)
    return run


def at(*places: list[float]) -> np.ndarray:
    return np.array(places, dtype=float)


def test_a_rotation_is_that_of_its_quaternion() -> None:
    turn = bodies.rotation_matrix(QUARTER)
    np.testing.assert_allclose(turn @ [1, 0, 0], [0, 1, 0], atol=1e-15)
    # Any quaternion gives a rotation, which leaves its own axis
    quaternion = np.array([0.3, -0.4, 0.5, 0.7])
    turn = bodies.rotation_matrix(quaternion)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(turn @ quaternion[:3], quaternion[:3], atol=1e-15)


def linked(axis: np.ndarray) -> Run:
    """Three spheres on arms along an axis, which move by one along it."""
    names = ["s-1", "s-2", "s-3"]
    found = {
        name: history(np.outer([x, x + 1.0], axis))
        for name, x in zip(names, (-5, 0, 7), strict=True)
    }
    shapes = {name: ball([1.0, 1.0, 1.0]) for name in names}
    kind = {"linked-spheres": {"radii": [1.0, 1.0, 1.0], "arms": [5.0, 7.0]}}
    return made({"swimmer": [{"name": "s", "kind": kind}]}, found, shapes)


def test_arms_lead_from_surface_to_surface() -> None:
    axis = np.array([0.48, 0.6, 0.64])
    run = linked(axis)
    assert bodies.groups(run) == {"s": ["s-1", "s-2", "s-3"]}
    found = bodies.rods(run, bodies.poses(run, 0.0), 0.0)
    np.testing.assert_allclose(found[0] @ axis, [-4.0, -1.0])
    np.testing.assert_allclose(found[1] @ axis, [1.0, 6.0])
    assert len(found) == 2


def test_a_swimmer_points_along_its_way_from_before_its_front() -> None:
    axis = np.array([0.48, 0.6, 0.64])
    run = linked(axis)
    (arrow,) = bodies.headings(run, bodies.poses(run, 1.0))
    np.testing.assert_allclose(arrow.vector, 1.6 * axis)
    # The front of the first sphere is at 8 + 1
    assert arrow.start @ axis == pytest.approx(9.0)
    # One that came back points nowhere
    for own in run.bodies.values():
        own.center[1] = own.center[0]
    assert bodies.headings(run, bodies.poses(run, 1.0)) == []


def test_a_squirmer_points_along_its_heading_as_it_is_turned() -> None:
    body = {"name": "a", "center": [0.0, 0.0], "shape": {"disc": {"radius": 2.0}}}
    gait = {"squirmer": {"modes": [1.0], "heading": np.pi / 2}}
    case = {"geometry": "planar", "body": [body | {"gait": gait}]}
    run = made(case, {"a": history(at([3, 4, 0]), QUARTER)}, {})
    (arrow,) = bodies.headings(run, bodies.poses(run, 0.0))
    np.testing.assert_allclose(arrow.vector, [-2.2, 0.0, 0.0], atol=1e-14)
    np.testing.assert_allclose(arrow.start, [4.1, 4.0, 0.0], atol=1e-14)
    assert arrow.is_inside


def test_arrows_are_as_long_as_a_view_needs() -> None:
    before = bodies.Heading(np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.01, 0.0]), False)
    for extent in (0.1, 50.0):
        shown = bodies.fitted(before, extent)
        np.testing.assert_allclose(shown.vector, [0.0, bodies.ARROW * extent, 0.0])
        np.testing.assert_allclose(shown.start, before.start + bodies.CLEAR * shown.vector)
    # One in a body keeps its middle, and never grows
    within = bodies.Heading(np.array([-0.5, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]), True)
    shown = bodies.fitted(within, 2.0)
    np.testing.assert_allclose(shown.vector, [2.0 * bodies.LONGEST_INSIDE, 0.0, 0.0])
    np.testing.assert_allclose(shown.start + 0.5 * shown.vector, [0.0, 1.0, 0.0], atol=1e-14)
    np.testing.assert_allclose(bodies.fitted(within, 100.0).vector, within.vector)


def test_a_swimmer_leaves_the_way_of_its_middle() -> None:
    axis = np.array([0.48, 0.6, 0.64])
    run = linked(axis)
    ((times, way),) = ways.trails(run)
    own = [run.bodies[name].center for name in ("s-1", "s-2", "s-3")]
    np.testing.assert_allclose(way, np.mean(own, axis=0))
    np.testing.assert_array_equal(times, run.bodies["s-1"].time)
    # Arms that only go to and fro leave none
    run.bodies["s-1"].center[1] = run.bodies["s-1"].center[0] + 2.0 * axis
    run.bodies["s-2"].center[1] = run.bodies["s-2"].center[0] - 2.0 * axis
    run.bodies["s-3"].center[1] = run.bodies["s-3"].center[0]
    assert ways.trails(run) == []


def test_copies_of_swimmers_are_told_apart_by_number() -> None:
    names = [f"s-{copy}-{part}" for copy in range(1, 12) for part in (1, 2)]
    kind = {"linked-spheres": {"radii": [1.0, 1.0], "arms": [5.0]}}
    swimmer = {"name": "s", "kind": kind, "copies": {"random": {"count": 11}}}
    alone = {"name": "sphere", "shape": {"sphere": {"radius": 1.0}}}
    found = {name: history(at([0, 0, 0])) for name in [*names, "sphere"]}
    groups = bodies.groups(made({"swimmer": [swimmer], "body": [alone]}, found, {}))
    assert list(groups) == [*(f"s-{copy}" for copy in range(1, 12)), "sphere"]
    assert groups["s-11"] == ["s-11-1", "s-11-2"]
    assert groups["sphere"] == ["sphere"]


def test_links_of_a_chain_are_joined_by_their_pivot() -> None:
    names = ["c-1", "c-2"]
    found = {"c-1": history(at([0, 0, 0])), "c-2": history(at([-1.5, -1.5, 0]), QUARTER)}
    shapes = {name: ball([1.0, 0.2, 0.2]) for name in names}
    kind = {"chain": {"links": [[1.0, 0.2]] * 2, "gap": 0.5, "joints": []}}
    run = made({"swimmer": [{"name": "c", "kind": kind}]}, found, shapes)
    (rod,) = bodies.rods(run, bodies.poses(run, 0.0), 0.0)
    # Back end of the first link, pivot half the gap behind it, front end of the second one
    np.testing.assert_allclose(rod, [[-1, 0, 0], [-1.25, 0, 0], [-1.5, -0.5, 0]], atol=1e-15)


def test_a_joint_is_where_its_bodies_have_it() -> None:
    joint = {
        "parent": "a",
        "child": "b",
        "on_parent": [2.0, 0.0, 0.0],
        "on_child": [0.0, 0.0, 1.0],
        "kind": {"arm": {"length": 3.0}},
    }
    found = {"a": history(at([0, 0, 0]), QUARTER), "b": history(at([5, 5, 5]))}
    run = made({"joint": [joint]}, found, {})
    (rod,) = bodies.rods(run, bodies.poses(run, 0.0), 0.0)
    np.testing.assert_allclose(rod, [[0, 0, 0], [0, 2, 0], [5, 5, 6]], atol=1e-15)


def test_a_turned_body_takes_the_room_of_its_turned_shape() -> None:
    run = made({}, {"a": history(at([1, 1, 0]), QUARTER)}, {"a": ball([3.0, 1.0, 0.5])})
    low, high = bodies.corners(run, "a", bodies.poses(run, 0.0)["a"])
    np.testing.assert_allclose(low, [0, -2, -0.5], atol=1e-15)
    np.testing.assert_allclose(high, [2, 4, 0.5], atol=1e-15)


def test_bodies_that_deform_are_known_by_their_gait() -> None:
    fish = {"name": "fish", "shape": {"fish": {}}, "gait": {"carangiform": {"period": 1.0}}}
    disc = {"name": "disc", "shape": {"disc": {"radius": 1.0}}, "gait": {"squirmer": {"modes": []}}}
    found = {name: history(at([0, 0, 0])) for name in ("fish", "disc")}
    assert bodies.deforming(made({"body": [fish, disc]}, found, {})) == {"fish"}
    # Unless its shape was written again and again
    shapes = {"fish": [*ball([1.0, 1.0, 1.0]), Shape(1.0, [], [])]}
    assert bodies.deforming(made({"body": [fish, disc]}, found, shapes)) == set()


def test_bodies_are_joined_and_swim_as_the_program_wrote(tmp_path: Path) -> None:
    still = {"gait": None, "heading": None, "deforms": False}
    content = {
        "frame": "tail",
        "bodies": [
            {"name": "head", "gait": "squirmer", "heading": [0.0, 1.0, 0.0], "deforms": False},
            {"name": "tail", "gait": "flagellum", "heading": None, "deforms": True},
            {"name": "other"} | still,
        ],
        "swimmers": [{"name": "pair", "bodies": ["head", "tail"]}],
        "joints": [
            {
                "kind": "hinge",
                "parent": "head",
                "child": "tail",
                "on_parent": [-1.25, 0.0, 0.0],
                "on_child": [1.25, 0.0, 0.0],
                "swimmer": "pair",
            }
        ],
    }
    (tmp_path / "bodies.json").write_text(json.dumps(content))
    names = ("other", "tail", "head")
    found = {name: history(at([-2.5 * (name == "tail"), 0, 0])) for name in names}
    run = Run(tmp_path)
    run.__dict__["case"] = {"geometry": "spatial"}
    shapes = {name: ball([1.0, 1.0, 1.0]) for name in found}
    run.__dict__["_bodies_and_shapes"] = (found, shapes)
    assert bodies.groups(run) == {"pair": ["head", "tail"], "other": ["other"]}
    placed = bodies.poses(run, 0.0)
    (rod,) = bodies.rods(run, placed, 0.0)
    np.testing.assert_allclose(rod, [[-1, 0, 0], [-1.25, 0, 0], [-1.5, 0, 0]])
    (arrow,) = bodies.headings(run, placed)
    np.testing.assert_allclose(arrow.start, [0, 1, 0])
    assert bodies.deforming(run) == {"tail"}
    assert bodies.swims(run)
    assert run.members.frame == "tail"
    # A body without messages is in no group
    del found["tail"]
    assert bodies.groups(run) == {"pair": ["head"], "other": ["other"]}


# ---- Periodic domains ----------------------------------------------------------------------------

BOX = {
    "domain": {"box": {"min": [1.0, 0.0], "max": [5.0, 2.0]}},
    "boundary": {"left": {"periodic": "right"}, "bottom": "no-slip"},
}


def test_points_are_wrapped_along_periodic_directions_only() -> None:
    np.testing.assert_allclose(periodic.periods(BOX), [4.0, 0.0, 0.0])
    points = at([0.5, 3.0, 0.0], [13.5, -1.0, 0.0])
    np.testing.assert_allclose(periodic.wrapped(BOX, points), [[4.5, 3, 0], [1.5, -1, 0]])


def test_the_way_of_a_body_is_parted_where_it_crosses_a_side() -> None:
    x = np.linspace(1.5, 11.5, 41)
    pieces = periodic.trail(BOX, np.stack([x, 0 * x + 1, 0 * x], axis=1))
    assert [len(piece) for piece in pieces] == [14, 16, 11]
    for piece in pieces:
        assert (np.diff(piece[:, 0]) > 0).all()
        assert piece[:, 0].min() >= 1.0
        assert piece[:, 0].max() < 5.0


def test_a_body_across_a_side_has_an_image_at_the_other() -> None:
    region = (at([1, 0, 0])[0], at([5, 2, 0])[0])

    def shifts(x: float) -> list[float]:
        center = np.array([x, 1.0, 0.0])
        return sorted(periodic.images(BOX, center - 0.5, center + 0.5, region)[:, 0].tolist())

    assert shifts(3.0) == [0.0]
    assert shifts(1.2) == [0.0, 4.0]
    assert shifts(4.8) == [-4.0, 0.0]
    assert shifts(15.0) == [-12.0]


def test_tiles_fill_a_region_with_the_same_flow() -> None:
    nodes, cells = ring()
    zero = np.zeros(len(nodes))
    field = Field(0.0, nodes, cells, velocity(nodes), pressure=nodes[:, 0], vorticity=zero)
    region = (at([1, 0, 0])[0], at([5, 2, 0])[0])
    tiles = periodic.tiles(BOX, field, region)
    # The ring reaches from -2 to 2: it and its image one period on are in the region
    assert sorted(round(tile.nodes[:, 0].min()) for tile in tiles) == [-2, 2]
    one = periodic.joined(tiles)
    assert one.cells.shape == (2 * len(cells), 6)
    np.testing.assert_allclose(one.pressure[one.cells[len(cells) :]], field.pressure[cells])


# ---- Planes --------------------------------------------------------------------------------------


def test_a_plane_through_bodies_is_across_an_axis_if_that_will_do() -> None:
    pair = {"a": history(at([0, 0, -1.5])), "b": history(at([0, 0, 1.5]))}
    shapes = {name: ball([1.0, 1.0, 1.0]) for name in pair}
    plane = planes.through_bodies(made({}, pair, shapes), np.zeros(1), np.zeros((2, 3)))
    assert (plane.text, plane.names) == ("y = 0", ("x", "z"))


def test_a_plane_through_an_oblique_swimmer_has_it_along_its_first_coordinate() -> None:
    axis = np.array([0.48, 0.6, 0.64])
    run = linked(axis)
    plane = planes.through_bodies(run, np.array([0.0, 1.0]), np.zeros((2, 3)))
    np.testing.assert_allclose(plane.across[0], axis, atol=1e-12)
    np.testing.assert_allclose(plane.across @ plane.across.T, np.eye(2), atol=1e-12)
    for name in run.bodies:
        assert abs(plane.coordinates(run.bodies[name].center)[:, 1]).max() < 1e-12
    back = plane.points(plane.coordinates(run.bodies["s-1"].center))
    np.testing.assert_allclose(back, run.bodies["s-1"].center, atol=1e-12)


@pytest.mark.parametrize("text", ["w=0", "z", "z=1e", "x=y"])
def test_what_is_no_plane_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="is not a plane"):
        planes.parsed(text)


def test_a_plane_through_bodies_has_a_plain_height() -> None:
    case = {"body": [{"name": "a", "shape": {"sphere": {"radius": 1.0}}}]}
    for height, text in ((-2.3e-7, "z = 0"), (1.54123, "z = 1.54"), (0.1025, "z = 0.1025")):
        run = made(case, {"a": history(at([0, 0, height]))}, {})
        assert planes.through_bodies(run, np.zeros(1), np.zeros((2, 3))).text == text


def test_the_height_of_a_body_without_a_radius_is_plain_for_the_domain() -> None:
    run = made({"body": [{"name": "a"}]}, {"a": history(at([0, 0, 2.4e-4]))}, {})
    box = np.array([[0.0, -7.5, -7.5], [90.0, 7.5, 7.5]])
    assert planes.through_bodies(run, np.zeros(1), box).text == "z = 0"
