"""Surfaces of bodies and sides as grids, and as curves over arc length."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from alewife_post import sections, traction
from alewife_post.fields import nodal_values
from alewife_post.planes import AXES, Plane
from alewife_post.read import QUADRATIC_TRIANGLE, Field

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray
Columns = dict[str, Array]

QUADRATIC_EDGE = 21
SUBDIVISION = 2
"""Halvings of the sides of curved facets that are cut, or rendered."""
AT, WEIGHT = (0.5 * one for one in np.polynomial.legendre.leggauss(4))
"""Gauss's rule on an interval of length one, about its middle."""


def grid(field: Field, found: list[traction.Surface]) -> pyvista.UnstructuredGrid:
    """Facets of all surfaces, each with nodes of its own, and what acts at these.

    `surface` is a number of each in their order, whose names are `surfaces`, and `is_body` one on
    bodies. Where a surface has a crease, and at the corner of two sides, a node is there for each
    of both, with its own normal.
    """
    import pyvista

    d = field.nodes.shape[1]
    starts = np.cumsum([0, *(len(one.nodes) for one in found)])
    facets = [start + one.own for start, one in zip(starts, found, strict=False)]
    kind = QUADRATIC_EDGE if d == 2 else QUADRATIC_TRIANGLE
    points = np.concatenate([field.nodes[one.nodes] for one in found])
    made = pyvista.UnstructuredGrid({kind: np.concatenate(facets)}, spatial(points))
    data = made.point_data
    for name in ("traction", "recovered", "viscous", "normal"):
        key = {"viscous": "viscous_traction", "recovered": "traction_recovered"}.get(name, name)
        data[key] = spatial(np.concatenate([getattr(one, name) for one in found]))
    data["pressure"] = np.concatenate([field.pressure[one.nodes] for one in found])
    data["wall_shear"] = np.concatenate([traction.magnitude(one, "wall-shear") for one in found])
    numbers = [np.full(len(one.nodes), nth) for nth, one in enumerate(found)]
    data["surface"] = np.concatenate(numbers)
    data["is_body"] = np.concatenate([np.full(len(one.nodes), one.facets.is_body) for one in found])
    data["is_body"] = data["is_body"].astype(int)
    # By their old names
    data["body"] = data["surface"]
    made.field_data["surfaces"] = [one.facets.name for one in found]
    made.field_data["bodies"] = [one.facets.name for one in found]
    return made


def spatial(values: Array) -> Array:
    """Vectors `(n, d)` as `(n, 3)`."""
    return np.hstack([values, np.zeros((len(values), 3 - values.shape[1]))])


def values(field: Field, one: traction.Surface, quantity: str) -> Array:
    """A quantity at the nodes of a surface, `(n,)`."""
    if quantity in traction.QUANTITIES:
        return traction.magnitude(one, quantity)
    return nodal_values(field, quantity)[one.nodes]


def shown(field: Field, found: list[traction.Surface], quantity: str) -> pyvista.PolyData:
    """Surfaces in space as flat triangles, with nodal `values`."""
    import pyvista

    starts = np.cumsum([0, *(len(one.nodes) for one in found)])
    facets = [start + one.own for start, one in zip(starts, found, strict=False)]
    points = np.concatenate([field.nodes[one.nodes] for one in found])
    made = pyvista.UnstructuredGrid({QUADRATIC_TRIANGLE: np.concatenate(facets)}, points)
    made.point_data["values"] = np.concatenate([values(field, one, quantity) for one in found])
    return made.extract_surface(nonlinear_subdivision=SUBDIVISION, algorithm="dataset_surface")


# ---- Curves --------------------------------------------------------------------------------------


def nodes(field: Field, one: traction.Surface) -> Columns:
    """What acts at the nodes of a surface, a row each."""
    return _columns(field, one, np.arange(len(one.nodes)))


def curve(field: Field, one: traction.Surface) -> Columns:
    """What acts along a surface in the plane or about an axis, over arc length.

    A side begins at its end of smaller x, an upright one at that of smaller y. Around a body it
    goes counter-clockwise from where x is largest; about an axis from smaller to larger x. `shear`
    is the part of the traction along the way. At an edge there are two rows, one for each side of
    it. Of a surface of several pieces each begins at zero, and `part` is its number.
    """
    chains = [_turned(field, one, chain) for chain in _chains(one.facets.nodes)]
    chains.sort(key=lambda chain: tuple(field.nodes[chain[0][0]]))
    found = []
    for nth, chain in enumerate(chains):
        rows, distance, way = _along(field, one, chain)
        columns = _columns(field, one, rows)
        shear = np.einsum("ij,ij->i", traction.shear(one)[rows], way)
        part = {"part": np.full(len(rows), float(nth))} if len(chains) > 1 else {}
        found.append({**part, "distance": distance, **columns, "shear": shear})
    return {name: np.concatenate([part[name] for part in found]) for name in found[0]}


def cut(field: Field, one: traction.Surface, plane: Plane) -> Columns:
    """What acts along the curves in which a plane cuts a surface in space, over arc length."""
    found = []
    made = grid(field, [one]).extract_surface(
        nonlinear_subdivision=SUBDIVISION, algorithm="dataset_surface"
    )
    sliced = made.slice(normal=plane.normal, origin=plane.origin)
    curves = sections.curves(sliced)
    if not curves:
        raise ValueError(f"{plane.text} does not cut {one.facets.name}")
    for nth, points in enumerate(_forwards(one) for one in curves):
        nearest = [sliced.find_closest_point(point) for point in points]
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        columns: Columns = {} if len(curves) == 1 else {"part": np.full(len(points), float(nth))}
        columns["distance"] = np.append(0.0, np.cumsum(steps))
        columns |= {name: points[:, axis] for axis, name in enumerate(AXES)}
        for key, name in (("normal", "normal"), ("traction", "traction_recovered")):
            vectors = np.asarray(sliced.point_data[name])[nearest]
            columns |= {f"{key}.{axis}": vectors[:, k] for k, axis in enumerate(AXES)}
        for name in ("pressure", "wall_shear"):
            columns[name] = np.asarray(sliced.point_data[name])[nearest]
        found.append(columns)
    return {name: np.concatenate([part[name] for part in found]) for name in found[0]}


def _forwards(points: Array) -> Array:
    """A curve `(n, 3)` from its end of smaller x, or y, or z, along which it goes farthest."""
    away = points[-1] - points[0]
    return points[::-1] if away[np.argmax(np.abs(away))] < 0.0 else points


def _columns(field: Field, one: traction.Surface, rows: Array) -> Columns:
    axes = AXES[: field.nodes.shape[1]]
    found = {}
    for name, vectors in (
        ("", field.nodes[one.nodes]),
        ("normal.", one.normal),
        ("traction.", one.recovered),
    ):
        found |= {f"{name}{axis}": vectors[rows, k] + 0.0 for k, axis in enumerate(axes)}
    found["pressure"] = field.pressure[one.nodes[rows]]
    found["wall_shear"] = traction.magnitude(one, "wall-shear")[rows]
    return found


def _chains(facets: Array) -> list[list[tuple[int, int, int]]]:
    """Edges `(m, 3)` that follow each other, each as its nodes and its number: `(a, b, edge)`."""
    after = {int(start): nth for nth, (start, _, _) in enumerate(facets)}
    ends = {int(end) for _, end, _ in facets}
    left = dict.fromkeys(nth for nth, (start, _, _) in enumerate(facets) if int(start) not in ends)
    left |= dict.fromkeys(range(len(facets)))
    chains = []
    while left:
        edge = next(iter(left))
        chain = []
        while edge in left:
            del left[edge]
            start, end, _ = (int(node) for node in facets[edge])
            chain.append((start, end, edge))
            edge = after.get(end, -1)
        chains.append(chain)
    return chains


def _turned(
    field: Field, one: traction.Surface, chain: list[tuple[int, int, int]]
) -> list[tuple[int, int, int]]:
    """A chain the way it is to be gone."""
    first, last = field.nodes[chain[0][0]], field.nodes[chain[-1][1]]
    if chain[0][0] == chain[-1][1]:
        at = int(np.argmax([field.nodes[start, 0] for start, _, _ in chain]))
        chain = chain[at:] + chain[:at]
        x, y = field.nodes[[start for start, _, _ in chain]].T
        is_backwards = (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() < 0.0
    else:
        away = last - first
        axis = 0 if one.facets.is_body or abs(away[0]) >= abs(away[1]) else 1
        is_backwards = away[axis] < 0.0
    if is_backwards:
        chain = [(end, start, edge) for start, end, edge in chain[::-1]]
    return chain


def _along(
    field: Field, one: traction.Surface, chain: list[tuple[int, int, int]]
) -> tuple[Array, Array, Array]:
    """Numbers of nodes of a surface along a chain, arc lengths, and unit vectors along the way."""
    rows, distance, ways, before = [], [], [], 0.0
    for start, _, edge in chain:
        own, global_ = one.own[edge], one.facets.nodes[edge]
        if global_[0] != start:
            own, global_ = own[[1, 0, 2]], global_[[1, 0, 2]]
        a, b, middle = field.nodes[global_]
        # x(s) = a + s (4 m - 3 a - b) + s^2 (2 a + 2 b - 4 m)
        slope, bend = 4 * middle - 3 * a - b, 2 * a + 2 * b - 4 * middle
        halves = [
            0.5 * WEIGHT @ np.linalg.norm(slope + 2 * s[:, None] * bend, axis=1)
            for s in (0.5 * (AT + 0.5), 0.5 * (AT + 1.5))
        ]
        places = before + np.cumsum([0.0, *halves])
        for s, k, at in zip((0.0, 0.5, 1.0), (0, 2, 1), places, strict=True):
            way = slope + 2 * s * bend
            if rows and rows[-1] == own[k]:
                continue
            rows.append(int(own[k]))
            distance.append(at)
            ways.append(way / np.linalg.norm(way))
        before = places[-1]
    # Along the surface as its normal has it, which is the mean of two edges
    way, normal = np.array(ways), one.normal[rows]
    way = way - (way * normal).sum(axis=1, keepdims=True) * normal
    way = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
    return np.array(rows), np.array(distance), way
