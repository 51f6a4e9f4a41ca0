"""Messages of `run.mcap`: bodies over time, and what they look like."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray


def rotation_matrix(quaternion: Array) -> Array:
    """The matrix `(3, 3)` of a quaternion x, y, z, w."""
    x, y, z, w = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@dataclass(frozen=True)
class BodyHistory:
    """One body over time; vectors are those of the world, `(n, 3)`."""

    time: Array
    """`(n,)`."""
    center: Array
    angle: Array
    """Turn about z (rad), continuous, `(n,)`."""
    rotation: Array
    """Quaternion x, y, z, w, `(n, 4)`."""
    velocity: Array
    angular_velocity: Array
    force: Array
    torque: Array
    surface_force: Array
    surface_torque: Array
    power: Array
    """Work of the surface on the fluid per time, `(n,)`."""


@dataclass(frozen=True)
class Solid:
    """An ellipsoid, or a cylinder or cone along its own z, in the frame of a body."""

    kind: str
    """`ellipsoid` or `cylinder`."""
    position: Array
    """`(3,)`."""
    rotation: Array
    """Quaternion x, y, z, w, `(4,)`."""
    size: Array
    """Lengths along its own axes, `(3,)`."""
    scales: tuple[float, float]
    """Factors of the width of a cylinder at its bottom and its top."""


@dataclass(frozen=True)
class Shape:
    """What a body looks like in its own frame from a time on."""

    time: float
    solids: list[Solid]
    lines: list[Array]
    """Closed outlines in the plane, each `(n_points, 2)`."""

    def extents(self) -> tuple[Array, Array]:
        """Lowest and highest corner `(3,)` in its own frame."""
        low, high = [], []
        for solid in self.solids:
            # Of the box around an ellipsoid or cylinder that is turned
            half = np.abs(rotation_matrix(solid.rotation)) @ (solid.size / 2)
            if solid.kind == "ellipsoid":
                half = np.linalg.norm(rotation_matrix(solid.rotation) * (solid.size / 2), axis=1)
            low.append(solid.position - half)
            high.append(solid.position + half)
        for line in self.lines:
            low.append(np.append(line.min(axis=0), 0.0))
            high.append(np.append(line.max(axis=0), 0.0))
        if not low:
            return np.zeros(3), np.zeros(3)
        return np.min(low, axis=0), np.max(high, axis=0)


@dataclass(frozen=True)
class Message:
    """One message of `run.mcap`."""

    topic: str
    time: float
    content: dict[str, Any]


def shape_of(entity: dict[str, Any], time: float) -> Shape:
    """The shape that an entity of a scene has from a time on."""

    def vector(value: dict[str, float], axes: str = "xyz") -> Array:
        return np.array([value[axis] for axis in axes], dtype=float)

    def solid(kind: str, item: dict[str, Any]) -> Solid:
        pose = item["pose"]
        return Solid(
            kind,
            vector(pose["position"]),
            vector(pose["orientation"], "xyzw"),
            vector(item["size"]),
            (item.get("bottom_scale", 1.0), item.get("top_scale", 1.0)),
        )

    kinds = (("ellipsoid", "spheres"), ("cylinder", "cylinders"))
    return Shape(
        time,
        [solid(kind, item) for kind, key in kinds for item in entity.get(key, [])],
        [
            np.array([vector(point, "xy") for point in line["points"]])
            for line in entity.get("lines", [])
        ],
    )


@dataclass(frozen=True)
class Cloud:
    """Points of a message at a time: particles, or the nodes of a mesh with a scalar there."""

    time: float
    points: Array
    """`(n, 3)`."""
    values: Array
    """A number at each, `(n,)`: the value of a scalar, the time of release of a particle."""


def cloud_of(content: dict[str, Any], time: float) -> Cloud:
    """The points of a `foxglove.PointCloud` as a run writes them, of single precision."""
    names = [field["name"] for field in content["fields"]]
    offsets = [field["offset"] for field in content["fields"]]
    if names[:3] != ["x", "y", "z"] or offsets != [0, 4, 8, 12] or content["point_stride"] != 16:
        raise ValueError(f"a cloud of {', '.join(names)} is not one that alewife writes")
    data = np.frombuffer(base64.b64decode(content["data"]), "<f4").reshape(-1, 4)
    return Cloud(time, data[:, :3].astype(float), data[:, 3].astype(float))


def body_history(reports: list[dict[str, Any]]) -> BodyHistory:
    """A body over time, of its messages in their order."""

    def numbers(*path: str) -> Array:
        values = []
        for report in reports:
            value: Any = report
            for key in path:
                value = value[key]
            # What is not a number is null in JSON.
            values.append(np.nan if value is None else value)
        return np.array(values, dtype=float)

    def vectors(*path: str, axes: str = "xyz") -> Array:
        return np.stack([numbers(*path, axis) for axis in axes], axis=1)

    return BodyHistory(
        time=numbers("time"),
        center=vectors("pose", "center"),
        angle=np.unwrap(numbers("pose", "angle")),
        rotation=vectors("pose", "rotation", axes="xyzw"),
        velocity=vectors("twist", "linear"),
        angular_velocity=vectors("twist", "angular"),
        force=vectors("load", "force"),
        torque=vectors("load", "torque"),
        surface_force=vectors("surface_load", "force"),
        surface_torque=vectors("surface_load", "torque"),
        power=numbers("power"),
    )
