"""Which bodies swim together, what joins them, and how each of them swims.

The program says so in `bodies.json`. Of runs of versions that did not write it, `from_case` works
it out from the case, by the names that swimmers give their bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from alewife_post.messages import Shape

Array = np.ndarray

DEFORMING = ("carangiform", "anguilliform", "flagellum", "joints", "pulsating")
"""Gaits by which a body changes its shape."""


@dataclass(frozen=True)
class Joint:
    """What joins a child to its parent."""

    kind: str
    """`arm`, `slider`, `bent`, `hinge` or `ball`."""
    parent: str
    child: str
    on_parent: Array
    """Where it is in the frame of the parent, `(3,)`."""
    on_child: Array
    is_of_swimmer: bool
    """Whether it was made for a swimmer, and is none of `[[joint]]`."""

    @property
    def is_arm(self) -> bool:
        """Whether it has a length, given or free."""
        return self.kind in ("arm", "slider")


@dataclass(frozen=True)
class Members:
    """All swimmers, joints and gaits of a run."""

    frame: str | None
    """The body the frame of reference, and with it the domain, travels with."""
    swimmers: dict[str, list[str]]
    """Bodies of each swimmer of `[[swimmer]]`, and of each of its copies."""
    joints: list[Joint]
    gaits: dict[str, str]
    """Name of the gait of each body that has one."""
    headings: dict[str, Array]
    """Unit vectors `(3,)` in the frames of squirmers whose heading does not turn in time."""
    deforming: set[str]
    """Bodies that change their shape."""


def from_file(content: dict[str, Any]) -> Members:
    """The content of `bodies.json`."""
    bodies = content["bodies"]
    return Members(
        content["frame"],
        {swimmer["name"]: swimmer["bodies"] for swimmer in content["swimmers"]},
        [
            Joint(
                joint["kind"],
                joint["parent"],
                joint["child"],
                np.array(joint["on_parent"]),
                np.array(joint["on_child"]),
                joint["swimmer"] is not None,
            )
            for joint in content["joints"]
        ],
        {body["name"]: body["gait"] for body in bodies if body["gait"] is not None},
        {body["name"]: np.array(body["heading"]) for body in bodies if body["heading"] is not None},
        {body["name"] for body in bodies if body["deforms"]},
    )


# ---- Runs of earlier versions --------------------------------------------------------------------


def from_case(case: dict[str, Any], names: list[str], shapes: dict[str, list[Shape]]) -> Members:
    """The same of a case, the names of its bodies and their shapes.

    Bodies of a swimmer are its name and their numbers: `NAME-3`, those of a copy `NAME-2-3`.
    """
    names = names or [body["name"] for body in case.get("body", [])]
    swimmers: dict[str, list[str]] = {}
    joints: list[Joint] = []
    gaits = {body["name"]: body["gait"] for body in case.get("body", []) if body.get("gait")}
    for swimmer in case.get("swimmer", []):
        kind, values = next(iter(swimmer["kind"].items()))
        for name in _copies(swimmer, names):
            own = _members(swimmer, name, names)
            if own:
                swimmers[name] = own
                joints += _joints(kind, values, own, shapes)
                gaits |= _gaits(kind, values, own)
    for given in case.get("joint", []):
        ends = (np.array([*given.get(key, []), 0, 0, 0.0])[:3] for key in ("on_parent", "on_child"))
        kind = next(iter(given["kind"]))
        joints.append(Joint(kind, given["parent"], given["child"], *ends, False))
    squirmers = {name: gait["squirmer"] for name, gait in gaits.items() if "squirmer" in gait}
    return Members(
        _frame(case, names, swimmers),
        swimmers,
        joints,
        {name: next(iter(gait)) for name, gait in gaits.items()},
        {name: _heading(gait) for name, gait in squirmers.items() if "turn" not in gait},
        {name for name, gait in gaits.items() if next(iter(gait)) in DEFORMING},
    )


def _frame(case: dict[str, Any], names: list[str], swimmers: dict[str, list[str]]) -> str | None:
    name = case.get("frame")
    if name in names or name not in swimmers:
        return name if name in names else None
    kinds = {swimmer["name"]: next(iter(swimmer["kind"])) for swimmer in case["swimmer"]}
    own = swimmers[name]
    # The others hang on the one in the middle, on the first one of a star
    is_row = kinds.get(name) in ("linked-spheres", "chain")
    return own[(len(own) - 1) // 2] if is_row else own[0]


def _copies(swimmer: dict[str, Any], names: list[str]) -> list[str]:
    name = swimmer["name"]
    if "copies" not in swimmer:
        return [name]
    numbers = {
        other.removeprefix(f"{name}-").split("-")[0]
        for other in names
        if other.startswith(f"{name}-")
    }
    return [f"{name}-{number}" for number in sorted(filter(str.isdigit, numbers), key=int)]


def _members(swimmer: dict[str, Any], name: str, names: list[str]) -> list[str]:
    kind, values = next(iter(swimmer["kind"].items()))
    if kind == "bodies":
        return [other for other in values if other in names]
    if name in names:
        return [name]
    known = set(names)
    return [own for nth in range(1, len(names) + 1) if (own := f"{name}-{nth}") in known]


def _joints(
    kind: str, values: dict[str, Any], own: list[str], shapes: dict[str, list[Shape]]
) -> list[Joint]:
    origin = np.zeros(3)
    match kind:
        case "linked-spheres":
            return [Joint("arm", *pair, origin, origin, True) for pair in pairwise(own)]
        case "star":
            return [Joint("arm", own[0], other, origin, origin, True) for other in own[1:]]
        case "chain":
            # Pivots are half the gap beyond the ends of the links
            half = np.array([0.5 * values["gap"], 0.0, 0.0])
            along = np.array([1.0, 0.0, 0.0])
            found = []
            for before, after in pairwise(own):
                if before in shapes and after in shapes:
                    back = shapes[before][0].extents()[0] * along - half
                    front = shapes[after][0].extents()[1] * along + half
                    found.append(Joint("bent", before, after, back, front, True))
            return found
    return []


def _gaits(kind: str, values: dict[str, Any], own: list[str]) -> dict[str, dict[str, Any]]:
    if kind == "body" and values.get("gait"):
        return dict.fromkeys(own, values["gait"])
    if kind == "linked-spheres" and values.get("gaits"):
        return dict(zip(own, values["gaits"], strict=False))
    if kind == "chain" and values.get("skin") is not None:
        return {name: {"joints": {}} for name in own}
    return {}


def _heading(squirmer: dict[str, Any]) -> Array:
    axis = squirmer.get("axis")
    if axis is not None:
        return np.array(axis, dtype=float) / np.linalg.norm(axis)
    angle = squirmer.get("heading", 0.0)
    return np.array([np.cos(angle), np.sin(angle), 0.0])
