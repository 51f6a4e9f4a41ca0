"""Bodies of a run: where they are, what they look like, what joins them and where they swim to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from alewife_post import asked
from alewife_post.elements import centroid, smooth_outline
from alewife_post.members import Joint
from alewife_post.messages import BodyHistory, Shape, Solid, rotation_matrix
from alewife_post.read import Run

Array = np.ndarray
Pose = tuple[Array, Array]
"""Centre `(3,)` and rotation matrix `(3, 3)` from the body's frame to the world."""

ARROW = 0.07
"""Length of an arrow before a body over the longer side of a view."""
CLEAR = 0.2
"""Room before it, over its length."""
LONGEST_INSIDE = 0.15
"""That of one in a body, at most."""


def poses(run: Run, time: float) -> dict[str, Pose]:
    """Pose of each body at the message nearest to a time; that of the case if there is none."""
    found = {
        name: (history.center[nearest(history, time)], rotation_matrix(_turn(history, time)))
        for name, history in run.bodies.items()
    }
    for body in run.case.get("body", []):
        center = body.get("center")
        if body["name"] not in found and center is not None:
            angle = body.get("angle", 0.0)
            turn = np.array([0.0, 0.0, np.sin(angle / 2), np.cos(angle / 2)])
            found[body["name"]] = (np.array([*center, 0.0, 0.0])[:3], rotation_matrix(turn))
    return found


def nearest(history: BodyHistory, time: float) -> int:
    """Number of the message nearest to a time."""
    return int(np.argmin(np.abs(history.time - time)))


def is_written(run: Run, time: float) -> bool:
    """Whether there are messages of a time: else bodies are elsewhere than the nearest ones say."""
    span = max([0.0, *(np.ptp(history.time) for history in run.bodies.values())])
    return all(
        np.abs(history.time - time).min() <= 1e-6 * span + 1e-12 for history in run.bodies.values()
    )


def _turn(history: BodyHistory, time: float) -> Array:
    return history.rotation[nearest(history, time)]


def shape(run: Run, name: str, time: float) -> Shape | None:
    """What a body looks like at a time, if that was written or its case says it."""
    found = run.shapes.get(name)
    if found:
        before = [one for one in found if one.time <= time + 1e-12]
        return before[-1] if before else found[0]
    for body in run.case.get("body", []):
        if body["name"] == name and "shape" in body:
            return _simple_shape(body["shape"], body.get("center_of_mass"))
    return None


def _simple_shape(given: dict[str, Any], heavy: list[float] | None) -> Shape | None:
    ((kind, values),) = given.items()
    # The pose is that of the centre of mass, which may be apart from that of the shape
    origin = -np.array([*(heavy or []), 0.0, 0.0, 0.0])[:3]
    match kind:
        case "disc" | "sphere":
            size = np.full(3, 2 * values["radius"])
        case "ellipse" | "spheroid" | "ellipsoid":
            semi_axes = values["semi_axes" if "semi_axes" in values else "semi-axes"]
            size = 2 * np.array([*semi_axes, semi_axes[-1]])[:3]
        case "spline":
            # The pose is that of the centre of mass, the points have an origin of their own.
            outline = smooth_outline(np.array(values["points"]))
            away = centroid(outline) if heavy is None else -origin[: outline.shape[1]]
            return Shape(0.0, [], [outline - away])
        case "polygon" if "points" in values:
            outline = np.array(values["points"])
            away = centroid(outline) if heavy is None else -origin[: outline.shape[1]]
            return Shape(0.0, [], [outline - away])
        case "box":
            corners_of_box = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
            return Shape(0.0, [], [0.5 * corners_of_box * values["size"] + origin[:2]])
        case _:
            return None
    turn = np.array([0.0, 0.0, 0.0, 1.0])
    return Shape(0.0, [Solid("ellipsoid", origin, turn, size, (1.0, 1.0))], [])


def corners(run: Run, name: str, pose: Pose) -> tuple[Array, Array]:
    """Lowest and highest corner `(3,)` of a body that is placed somewhere, by its first shape."""
    seen = shape(run, name, 0.0)
    if seen is None:
        return pose[0], pose[0]
    low, high = seen.extents()
    middle = pose[0] + pose[1] @ (0.5 * (low + high))
    half = np.abs(pose[1]) @ (0.5 * (high - low))
    return middle - half, middle + half


def surroundings(run: Run, times: Array) -> tuple[Array, Array] | None:
    """Lowest and highest corner `(3,)` of all bodies at some times; none if there is no body."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for time in times:
        for name, pose in poses(run, float(time)).items():
            own_low, own_high = corners(run, name, pose)
            low, high = np.minimum(low, own_low), np.maximum(high, own_high)
    return (low, high) if np.isfinite(low).all() else None


def landmarks(run: Run, time: float) -> Array:
    """Centre and corners of each body at a time, `(n, 3)`: where a picture has something."""
    found = [
        point
        for name, pose in poses(run, time).items()
        for point in (pose[0], *corners(run, name, pose))
    ]
    return np.array(found).reshape(-1, 3)


def radius(run: Run, name: str) -> float:
    """Largest distance of a surface from the centre of a body, at the start."""
    seen = shape(run, name, 0.0)
    if seen is None:
        return 0.0
    corners = np.abs(np.array(seen.extents())).max(axis=0)
    # A ball has no corners
    is_planar = not run.is_spatial
    return float(corners[:2].max() if is_planar else corners.max())


def _thickness(run: Run, name: str) -> float:
    """Half the least extent of a body."""
    seen = shape(run, name, 0.0)
    if seen is None:
        return 0.0
    low, high = seen.extents()
    # In the plane solids are flat.
    return float(0.5 * (high - low)[: 3 if run.is_spatial else 2].min())


def groups(run: Run) -> dict[str, list[str]]:
    """Bodies of each swimmer, and each body that belongs to none."""
    names = list(run.bodies) or [body["name"] for body in run.case.get("body", [])]
    known = set(names)
    found = {
        swimmer: own
        for swimmer, members in run.members.swimmers.items()
        if (own := [name for name in members if name in known])
    }
    grouped = {name for own in found.values() for name in own}
    return found | {name: [name] for name in names if name not in grouped}


def followed(run: Run, name: str) -> list[str]:
    """Bodies of the swimmer, or the body, that a view goes with."""
    known = groups(run)
    if name in known:
        return known[name]
    if name in run.bodies:
        return [name]
    there = ", ".join(dict.fromkeys([*known, *run.bodies])) or "none"
    raise asked.UnknownNameError(f"no body or swimmer {name} to follow; there are {there}")


def middle(run: Run, name: str, time: float) -> Array:
    """The middle `(3,)` of what is followed at a time."""
    placed = poses(run, time)
    return np.mean([placed[member][0] for member in followed(run, name)], axis=0)


def rods(run: Run, placed: dict[str, Pose], time: float) -> list[Array]:
    """Arms and pivots between bodies that are placed somewhere, polylines `(n, 3)`."""
    found = []
    for joint in run.members.joints:
        if joint.parent not in placed or joint.child not in placed:
            continue
        if not joint.is_of_swimmer:
            found.append(_attached(joint, placed))
        elif joint.is_arm:
            found.append(_arm(run, joint, placed))
        else:
            found += _pivot(run, joint, placed, time)
    return found


def _ends(joint: Joint, placed: dict[str, Pose]) -> tuple[Array, Array]:
    """Where a joint is on its parent and on its child, `(3,)`."""
    (center, turn), (other, other_turn) = placed[joint.parent], placed[joint.child]
    return center + turn @ joint.on_parent, other + other_turn @ joint.on_child


def _attached(joint: Joint, placed: dict[str, Pose]) -> Array:
    """From the centre of the parent to the joint, and along an arm."""
    on_parent, on_child = _ends(joint, placed)
    ends = [placed[joint.parent][0], on_parent]
    return np.array([*ends, on_child] if joint.is_arm else ends)


def _arm(run: Run, joint: Joint, placed: dict[str, Pose]) -> Array:
    """From surface to surface of two balls."""
    start, end = placed[joint.parent][0], placed[joint.child][0]
    along = (end - start) / np.linalg.norm(end - start)
    first, last = radius(run, joint.parent), radius(run, joint.child)
    return np.array([start + first * along, end - last * along])


def _pivot(run: Run, joint: Joint, placed: dict[str, Pose], time: float) -> list[Array]:
    """From the end of one link by the pivot to the end of the other one."""
    ends = []
    for name, at in ((joint.parent, joint.on_parent), (joint.child, joint.on_child)):
        seen = shape(run, name, time)
        if seen is None:
            return []
        center, turn = placed[name]
        ends.append(center + turn @ np.clip(at, *seen.extents()))
    pivot, _ = _ends(joint, placed)
    return [np.array([ends[0], pivot, ends[1]])]


@dataclass(frozen=True)
class Heading:
    """An arrow along which something swims."""

    start: Array
    """`(3,)`."""
    vector: Array
    """`(3,)`."""
    is_inside: bool
    """Whether it lies in a body rather than before it."""


def fitted(heading: Heading, extent: float) -> Heading:
    """The same arrow of a length that is seen, and fills nothing, where so much is in view."""
    length = float(np.linalg.norm(heading.vector))
    wanted = ARROW * extent
    if heading.is_inside:
        # No longer than the body has room for, about the same place
        wanted = min(length, LONGEST_INSIDE * extent)
    vector = heading.vector * (wanted / (length or 1.0))
    # One before a body is clear of it.
    shift = 0.5 * (heading.vector - vector) if heading.is_inside else CLEAR * vector
    start = heading.start + shift
    return Heading(start, vector, heading.is_inside)


def headings(run: Run, placed: dict[str, Pose]) -> list[Heading]:
    """Arrows of squirmers, which have a heading, and of swimmers of several bodies.

    Those of swimmers lie before them along their way over the whole run, if they went anywhere.
    """
    found = []
    pointed = set()
    for name, heading in run.members.headings.items():
        if name in placed:
            pointed.add(name)
            center, turn = placed[name]
            found.append(_arrow_of_squirmer(run, name, center, turn @ heading))
    for members in groups(run).values():
        if len(members) < 2 or any(name in pointed or name not in run.bodies for name in members):
            continue
        own = [run.bodies[name].center for name in members]
        way = np.mean([centers[-1] - centers[0] for centers in own], axis=0)
        size = max(_thickness(run, name) for name in members)
        # Less than that is the way of a swimmer that comes back, up to errors.
        if size > 0 and np.linalg.norm(way) > 0.01 * size:
            along = way / np.linalg.norm(way)
            middle = np.mean([placed[name][0] for name in members], axis=0)
            reach = max(
                float((placed[name][0] - middle) @ along) + radius(run, name) for name in members
            )
            found.append(Heading(middle + reach * along, 1.6 * size * along, False))
    return found


def _arrow_of_squirmer(run: Run, name: str, center: Array, along: Array) -> Heading:
    size = radius(run, name)
    if run.is_spatial:
        return Heading(center + size * along, 0.9 * size * along, False)
    return Heading(center - 0.55 * size * along, 1.1 * size * along, True)


def deforming(run: Run) -> set[str]:
    """Bodies whose shape changes in time and was written once only."""
    return {name for name in run.members.deforming if len(run.shapes.get(name, [])) < 2}


def swims(run: Run) -> bool:
    """Whether anything in a run swims."""
    return bool(run.members.swimmers or run.members.gaits)
