"""Boundary of the fluid in facets: which are whose, bodies' and sides' of the domain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alewife_post import bodies, derived, sides
from alewife_post.domains import periods
from alewife_post.elements import edges
from alewife_post.periodic import is_joined
from alewife_post.read import Field, Run
from alewife_post.surfaces import boundary_faces

Array = np.ndarray

SIDES = "sides"
"""Name of all surfaces that are no body's, and on no side that has a name."""
NEAR = 1.05
"""A surface within the reach of a body times this is its own: shapes are drawn by it, and moved."""


@dataclass(frozen=True)
class Facets:
    """A surface of the fluid, of quadratic edges in the plane and quadratic triangles in space."""

    name: str
    """That of the body or the side it belongs to, or `sides`."""
    nodes: Array
    """Nodes of each facet `(m, k)`, so that the normal of the parametrisation leaves the fluid."""
    is_body: bool = True


def facets_of(run: Run, field: Field) -> list[Facets]:
    """The surfaces of bodies in their order, then the sides."""
    every = _boundary(run, field)
    side = np.full(len(every), "", dtype=object)
    if not sides.is_given(run):
        side = sides.named(run, field, every)
    is_side = side != ""
    part = np.full(len(every), -1)
    part[~is_side] = parts(every[~is_side], len(field.nodes))
    owner = np.full(len(every), "", dtype=object)
    placed = bodies.poses(run, field.time)
    d = field.nodes.shape[1]
    extents = {
        number: np.ptp(field.nodes[every[part == number]].reshape(-1, d), axis=0).max()
        for number in range(part.max(initial=-1) + 1)
    }
    outer = max(extents, key=lambda number: extents[number], default=-1)
    for number in extents:
        points = field.nodes[every[part == number]].reshape(-1, d)
        name = _owner(run, placed, points, is_outer=number == outer and not is_side.any())
        if name is not None:
            owner[part == number] = name
    found = [Facets(name, every[owner == name]) for name in placed if (owner == name).any()]
    rest = owner == ""
    if sides.is_given(run):
        side[rest] = sides.named(run, field, every[rest])
    order = [*run.case.get("boundary", {}), *side[rest]]
    for name in [*(name for name in dict.fromkeys(order) if name), ""]:
        own = rest & (side == name)
        if own.any():
            found.append(Facets(name or SIDES, every[own], is_body=False))
    return found


def _owner(
    run: Run, placed: dict[str, bodies.Pose], points: Array, *, is_outer: bool
) -> str | None:
    """The nearest body that reaches all of some points `(n, d)`."""
    best, least = None, np.inf
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    lengths = periods(run.case)[: points.shape[1]]
    for name, (center, _) in placed.items():
        own = center[: points.shape[1]]
        # Of a periodic domain the mesh may have a body whole periods from where it is
        turns = np.divide(middle - own, lengths, out=np.zeros(len(own)), where=lengths > 0)
        own = own + np.round(turns) * lengths
        reach = bodies.radius(run, name)
        farthest = np.linalg.norm(points - own, axis=1).max()
        is_near = farthest <= NEAR * reach if reach > 0.0 else not is_outer
        away = float(np.linalg.norm(middle - own))
        if is_near and away < least:
            best, least = name, away
    return best


def _boundary(run: Run, field: Field) -> Array:
    """Facets without those on an axis, and where a periodic mesh is cut open."""
    if run.is_spatial:
        every = boundary_faces(field)
    else:
        every = boundary_edges(field)
        if run.is_axisymmetric:
            r = np.abs(field.nodes[every, 1]).max(axis=1)
            every = every[r > derived.ON_AXIS * np.ptp(field.nodes, axis=0).max()]
    lengths = periods(run.case)[: field.nodes.shape[1]]
    if lengths.any():
        every = every[~is_joined(field.nodes, lengths)[every].all(axis=1)]
    return every


def boundary_edges(field: Field) -> Array:
    """Edges of one cell alone, `(n, 3)`, with the fluid on their left."""
    every, is_boundary = edges(field.cells)
    return every[is_boundary]


def parts(facets: Array, n_nodes: int) -> Array:
    """A number for each facet, the same for those that hang together."""
    label = np.arange(n_nodes)
    while True:
        least = label[facets].min(axis=1)
        before = label.copy()
        np.minimum.at(label, facets, least[:, None])
        label = label[label]
        if np.array_equal(label, before):
            return np.unique(label[facets[:, 0]], return_inverse=True)[1]
