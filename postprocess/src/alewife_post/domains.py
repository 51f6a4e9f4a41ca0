"""The domain of a case: its corners, periods and sides; the only file that knows its kinds."""

from __future__ import annotations

from typing import Any

import numpy as np

Array = np.ndarray
View = tuple[float, float, float, float]

SIDES = ("left", "bottom", "back")


def periods(case: dict[str, Any]) -> Array:
    """Length of each period, `(3,)`; zero along directions that are not periodic."""
    if "domain" not in case:
        return np.zeros(3)
    ((kind, domain),) = case["domain"].items()
    lengths = np.zeros(3)
    match kind:
        case "box":
            across = np.subtract(domain["max"], domain["min"])
            lengths[: len(across)] = across
        case "channel":
            lengths[:2] = domain["length"], domain["height"]
        case "cylinder":
            lengths[0] = domain["x"][1] - domain["x"][0]
    for axis, side in enumerate(SIDES):
        condition = case.get("boundary", {}).get(side)
        if not (isinstance(condition, dict) and "periodic" in condition):
            lengths[axis] = 0.0
    return lengths


def domain_low(case: dict[str, Any]) -> Array:
    """Lowest corner `(3,)` of a domain that may be periodic."""
    ((kind, domain),) = case["domain"].items()
    match kind:
        case "box":
            return np.array([*domain["min"], 0.0])[:3]
        case "cylinder":
            return np.array([domain["x"][0], 0.0, 0.0])
    return np.zeros(3)


def domain_box(case: dict[str, Any]) -> tuple[Array, Array]:
    """Lowest and highest corner `(3,)` of a domain in space; without bounds if it is a mesh."""
    ((kind, domain),) = case["domain"].items()
    match kind:
        case "box":
            return np.array(domain["min"], dtype=float), np.array(domain["max"], dtype=float)
        case "cylinder":
            r = domain["radius"]
            start, end = domain["x"]
            return np.array([start, -r, -r]), np.array([end, r, r])
        case "sphere":
            center = np.array(domain.get("center", [0.0, 0.0, 0.0]))
            return center - domain["radius"], center + domain["radius"]
    return np.full(3, -np.inf), np.full(3, np.inf)


def corners_of(box: Array) -> Array:
    """All corners `(8, 3)` of a box `(2, 3)`."""
    return np.array([[box[i, 0], box[j, 1], box[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])


def domain_view(case: dict[str, Any]) -> View | None:
    """All of a domain as its case has it; none if it is a mesh."""
    ((kind, domain),) = case["domain"].items()
    match kind:
        case "box":
            (x0, y0), (x1, y1) = domain["min"], domain["max"]
        case "channel":
            x0, y0, x1, y1 = 0.0, 0.0, domain["length"], domain["height"]
        case "cylinder":
            (x0, x1), y1 = domain["x"], domain["radius"]
            y0 = -y1
        case "disc" | "half-disc":
            x, y = np.append(np.atleast_1d(domain.get("center", 0.0)), 0.0)[:2]
            r = domain["radius"]
            x0, x1, y0, y1 = x - r, x + r, y - r, y + r
        case _:
            return None
    return float(x0), float(x1), float(y0), float(y1)


def distances_to_sides(case: dict[str, Any], nodes: Array) -> Array:
    """Distance of each node from each side of the domain, `(n_nodes, n_sides)`.

    The sides of an imported mesh are not known: it has none here.
    """
    ((kind, domain),) = case["domain"].items()
    match kind:
        case "box":
            return np.hstack([nodes - domain["min"], nodes - domain["max"]])
        case "cylinder":
            off_axis = np.hypot(nodes[:, 1], nodes[:, 2]) - domain["radius"]
            ends = nodes[:, :1] - np.asarray(domain["x"])
            return np.column_stack([ends, off_axis])
        case "sphere":
            off = nodes - domain.get("center", [0.0, 0.0, 0.0])
            return np.linalg.norm(off, axis=1, keepdims=True) - domain["radius"]
        case "mesh":
            return np.empty((len(nodes), 0))
        case _:
            raise ValueError(f"a {kind} is no domain in space")


def distances_by_side(case: dict[str, Any], nodes: Array) -> dict[str, Array]:
    """Distance of nodes `(n, d)` from each side, `(n,)`, by the name of the side.

    An axis is no side, and the sides of an imported mesh are not known: it has none here.
    """
    ((kind, domain),) = case["domain"].items()
    d = nodes.shape[1]
    match kind:
        case "box" | "channel":
            if kind == "channel":
                domain = {"min": [0.0, 0.0], "max": [domain["length"], domain["height"]]}
            names = (("left", "right"), ("bottom", "top"), ("back", "front"))[:d]
            return {
                name: nodes[:, axis] - domain[end][axis]
                for axis, pair in enumerate(names)
                for name, end in zip(pair, ("min", "max"), strict=True)
            }
        case "cylinder":
            start, end = domain["x"]
            off_axis = np.linalg.norm(nodes[:, 1:], axis=1) - domain["radius"]
            return {"left": nodes[:, 0] - start, "right": nodes[:, 0] - end, "wall": off_axis}
        case "disc" | "half-disc" | "sphere":
            center = np.zeros(d)
            given = np.atleast_1d(np.asarray(domain.get("center", 0.0), dtype=float))
            center[: min(d, len(given))] = given[:d]
            return {"wall": np.linalg.norm(nodes - center, axis=1) - domain["radius"]}
    return {}
