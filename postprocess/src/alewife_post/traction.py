"""Traction of the fluid on surfaces of bodies: from the residual of its equations, or recovered."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from alewife_post import bodies, derived
from alewife_post.cells import reference_nodes, slopes, slopes_in_space, weights
from alewife_post.domains import periods
from alewife_post.elements import edges
from alewife_post.periodic import is_joined
from alewife_post.read import Field, Run
from alewife_post.surfaces import boundary_faces, on_sides

Array = np.ndarray

QUANTITIES = ("traction", "wall-shear")
"""Of pictures of surfaces."""
SIDES = "sides"
"""Name of all surfaces that are no body's."""
RESIDUAL, RECOVERED = "residual", "recovered"
NEAR = 1.05
"""A surface within the reach of a body times this is its own: shapes are drawn by it, and moved."""
GAUSS = 4
"""Points a direction, for integrals over cells and facets."""
CONVERGED = 1e-13
MOST_ITERATIONS = 500


@dataclass(frozen=True)
class Facets:
    """A surface of the fluid, of quadratic edges in the plane and quadratic triangles in space."""

    name: str
    """That of the body it belongs to, or `sides`."""
    nodes: Array
    """Nodes of each facet `(m, k)`, so that the normal of the parametrisation leaves the fluid."""


@dataclass(frozen=True)
class Surface:
    """What acts on a surface."""

    facets: Facets
    nodes: Array
    """Numbers of its nodes, `(n,)`."""
    normal: Array
    """Into the fluid, `(n, d)`."""
    traction: Array
    """Force of the fluid on it per area, `(n, d)`."""
    recovered: Array
    """The same by the recovered gradient, `(n, d)`: smoother, but of another sum."""
    viscous: Array
    """That without the part of the pressure, `(n, d)`."""
    method: str
    """`residual` or `recovered`."""
    force: Array
    """The integral of the traction, `(d,)`; about an axis over the whole surface."""


def surfaces_of(run: Run, field: Field) -> list[Surface]:
    """Surfaces of all bodies, then of the sides, with the tractions on them.

    Where one frame has all that is in the balance of momentum (Stokes flow, or a steady flow past
    held bodies), the traction on a body is that whose integrals are the residuals of the equations
    at its nodes: it adds up to `force` by construction. Elsewhere, and on sides, it is that of the
    recovered gradient.
    """
    own = derived.rates(field, is_axisymmetric=run.is_axisymmetric)
    recovered = derived.stress(run.case, field, own)
    found = []
    for facets in facets_of(run, field):
        nodes = np.unique(facets.nodes)
        normal = -_normals(field, facets.nodes)[nodes]
        viscous = np.einsum("nij,nj->ni", recovered[nodes], normal)
        smooth = viscous - field.pressure[nodes, None] * normal
        traction, method = smooth, RECOVERED
        if facets.name != SIDES and _has_residual(run, field):
            traction = _by_residual(run, field, facets, nodes)
            method = RESIDUAL
        force = _integral(run, field, facets, nodes, traction)
        found.append(Surface(facets, nodes, normal, traction, smooth, viscous, method, force))
    return found


def with_quantity(run: Run, field: Field, quantity: str) -> Field:
    """The field with the magnitude of the traction on bodies, or of its tangential part."""
    if quantity not in QUANTITIES:
        return derived.with_quantity(run, field, quantity)
    values = np.zeros(len(field.nodes))
    for one in surfaces_of(run, field):
        own = one.recovered
        if quantity == "wall-shear":
            own = own - (own * one.normal).sum(axis=1, keepdims=True) * one.normal
        values[one.nodes] = np.linalg.norm(own, axis=1)
    return replace(field, derived=values)


# ---- Which surface is whose ----------------------------------------------------------------------


def facets_of(run: Run, field: Field) -> list[Facets]:
    """The surfaces of bodies in their order, and all other ones together."""
    every = _boundary(run, field)
    is_side = on_sides(run, field, every) if run.is_spatial else None
    is_side = np.zeros(len(every), dtype=bool) if is_side is None else is_side
    part = np.full(len(every), -1)
    part[~is_side] = _parts(every[~is_side], len(field.nodes))
    owner = np.full(len(every), SIDES, dtype=object)
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
    names = [name for name in placed if (owner == name).any()]
    if (owner == SIDES).any():
        names.append(SIDES)
    return [Facets(name, every[owner == name]) for name in names]


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
        every = _edges(field)
        if run.is_axisymmetric:
            r = np.abs(field.nodes[every, 1]).max(axis=1)
            every = every[r > derived.ON_AXIS * np.ptp(field.nodes, axis=0).max()]
    lengths = periods(run.case)[: field.nodes.shape[1]]
    if lengths.any():
        every = every[~is_joined(field.nodes, lengths)[every].all(axis=1)]
    return every


def _edges(field: Field) -> Array:
    every, is_boundary = edges(field.cells)
    return every[is_boundary]


def _parts(facets: Array, n_nodes: int) -> Array:
    """A number for each facet, the same for those that hang together."""
    label = np.arange(n_nodes)
    while True:
        least = label[facets].min(axis=1)
        before = label.copy()
        np.minimum.at(label, facets, least[:, None])
        label = label[label]
        if np.array_equal(label, before):
            return np.unique(label[facets[:, 0]], return_inverse=True)[1]


# ---- Integrals -----------------------------------------------------------------------------------


def _rule(d: int) -> tuple[Array, Array]:
    """Points `(q, d)` and weights of the reference simplex, by Gauss's in collapsed coordinates."""
    at, weight = np.polynomial.legendre.leggauss(GAUSS)
    at, weight = 0.5 * (1.0 + at), 0.5 * weight
    points, weights_ = at[:, None], weight
    for axis in range(1, d):
        # A simplex over each point of an edge, which shrinks along it
        rest = np.repeat(points, GAUSS, axis=0)
        along = np.tile(at, len(points))
        points = np.column_stack([along, (1.0 - along[:, None]) * rest])
        weights_ = np.repeat(weights_, GAUSS) * np.tile(weight, len(weights_))
        weights_ = weights_ * (1.0 - along) ** axis
    return points, weights_


def _vectors(places: Array, local: Array) -> Array:
    """Normal of facets `(m, k, d)` at a point of the reference, times the area it stands for."""
    along = np.einsum("mki,kj->mij", places, slopes(local[None])[0])
    if places.shape[2] == 2:
        return np.stack([along[:, 1, 0], -along[:, 0, 0]], axis=1)
    return np.cross(along[:, :, 0], along[:, :, 1])


def _normals(field: Field, facets: Array) -> Array:
    """Unit normals out of the fluid at nodes, `(n_nodes, d)`: means of facets by their areas."""
    total = np.zeros(field.nodes.shape)
    places = field.nodes[facets]
    for k, local in enumerate(reference_nodes(field.nodes.shape[1] - 1)):
        np.add.at(total, facets[:, k], _vectors(places, local))
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return total / np.where(size > 0.0, size, 1.0)


def _around(run: Run, places: Array) -> Array:
    """Way around the axis of points `(n, d)`, one in the plane and in space."""
    if run.is_axisymmetric:
        return 2.0 * np.pi * places[:, 1]
    return np.ones(len(places))


def _integral(run: Run, field: Field, facets: Facets, nodes: Array, values: Array) -> Array:
    nodal = np.zeros((len(field.nodes), values.shape[1]))
    nodal[nodes] = values
    places = field.nodes[facets.nodes]
    total = np.zeros(values.shape[1])
    for local, weight in zip(*_rule(places.shape[2] - 1), strict=True):
        shape = weights(local[None])[0]
        area = weight * np.linalg.norm(_vectors(places, local), axis=1)
        area = area * _around(run, np.einsum("k,mki->mi", shape, places))
        total += area @ np.einsum("k,mki->mi", shape, nodal[facets.nodes])
    if run.is_axisymmetric:
        # What points away from the axis adds up to nothing around it
        total[1] = 0.0
    return total


# ---- By the residual -----------------------------------------------------------------------------


def _has_residual(run: Run, field: Field) -> bool:
    """Whether the equations of a frame are known by that frame alone."""
    model = run.case["fluid"]["model"]
    if model == "stokes":
        return True
    if run.is_unsteady or model != "navier-stokes" or run.frame_name is not None:
        return False
    return all(
        np.abs(history.velocity[bodies.nearest(history, field.time)]).max() == 0.0
        for history in run.bodies.values()
    )


def _by_residual(run: Run, field: Field, facets: Facets, nodes: Array) -> Array:
    """The traction `(n, d)` whose integrals with shape functions are minus the residuals."""
    number = np.full(len(field.nodes), -1)
    number[nodes] = np.arange(len(nodes))
    is_driven = bool(periods(run.case).any())
    near = field.cells
    if not is_driven:
        near = near[(number[near] >= 0).any(axis=1)]
    residual = np.zeros((len(field.nodes), field.nodes.shape[1]))
    volume = np.zeros(len(field.nodes))
    for start in range(0, len(near), derived.CHUNK):
        cells = near[start : start + derived.CHUNK]
        parts, volumes = _residuals(run, field, cells)
        np.add.at(residual, cells, parts)
        np.add.at(volume, cells, volumes)
    if is_driven:
        # The mean gradient of pressure that drives a periodic flow is what inner nodes have left
        inner = np.ones(len(field.nodes), dtype=bool)
        inner[_boundary_nodes(run, field)] = False
        drive = residual[inner].sum(axis=0) / volume[inner].sum()
        residual -= volume[:, None] * drive
        # And the part of the pressure that grows with the distance acts on the body as well
        residual -= _buoyancy(run, field, facets, drive)
    return _solved(run, field, number[facets.nodes], facets.nodes, -residual[nodes])


def _buoyancy(run: Run, field: Field, facets: Facets, drive: Array) -> Array:
    """Integrals `(n_nodes, d)` of what a pressure does whose gradient is minus `drive`."""
    places = field.nodes[facets.nodes]
    start = places.reshape(-1, places.shape[2]).mean(axis=0)
    found = np.zeros(field.nodes.shape)
    for local, weight in zip(*_rule(places.shape[2] - 1), strict=True):
        shape = weights(local[None])[0]
        at = np.einsum("k,mki->mi", shape, places)
        part = -weight * ((at - start) @ drive)[:, None] * _vectors(places, local)
        part = _around(run, at)[:, None] * part
        np.add.at(found, facets.nodes, part[:, None, :] * shape[:, None])
    return found


def _boundary_nodes(run: Run, field: Field) -> Array:
    every = boundary_faces(field) if run.is_spatial else _edges(field)
    return np.unique(every)


def _residuals(run: Run, field: Field, cells: Array) -> tuple[Array, Array]:
    """Integrals of stress and inertia with each shape function `(m, k, d)`, and of these."""
    places, velocity = field.nodes[cells], field.velocity[cells]
    pressure = field.pressure[cells]
    d = places.shape[2]
    density = run.case["fluid"].get("density", 0.0)
    has_inertia = run.case["fluid"]["model"] != "stokes"
    total, volumes = np.zeros(places.shape), np.zeros(places.shape[:2])
    for local, weight in zip(*_rule(d), strict=True):
        every = np.tile(local, (len(cells), 1))
        shape = weights(local[None])[0]
        by, volume = slopes_in_space(places, every)
        at = np.einsum("k,mki->mi", shape, places)
        volume = weight * np.abs(volume) * _around(run, at)
        gradient = np.einsum("mki,mkj->mij", velocity, by)
        u = np.einsum("k,mki->mi", shape, velocity)
        hoop = u[:, 1] / at[:, 1] if run.is_axisymmetric else np.zeros(len(cells))
        own = derived.Rates(gradient, hoop)
        mu = derived.viscosity(run.case, own.shear_rate)
        p = pressure @ shape
        stress = 2.0 * mu[:, None, None] * own.strain - p[:, None, None] * np.eye(d)
        part = np.einsum("mij,mkj->mki", stress, by)
        if run.is_axisymmetric:
            around = (2.0 * mu * hoop - p) / at[:, 1]
            part[:, :, 1] += around[:, None] * shape
        if has_inertia:
            carried = density * np.einsum("mij,mj->mi", gradient, u)
            part += carried[:, None, :] * shape[:, None]
        total += volume[:, None, None] * part
        volumes += volume[:, None] * shape
    return total, volumes


def _solved(run: Run, field: Field, own: Array, facets: Array, right: Array) -> Array:
    """Nodal values `(n, d)` of given integrals with shape functions, by conjugate gradients."""
    places = field.nodes[facets]
    k = facets.shape[1]
    matrices = np.zeros((len(facets), k, k))
    for local, weight in zip(*_rule(places.shape[2] - 1), strict=True):
        shape = weights(local[None])[0]
        area = weight * np.linalg.norm(_vectors(places, local), axis=1)
        area = area * _around(run, np.einsum("k,mki->mi", shape, places))
        matrices += area[:, None, None] * np.outer(shape, shape)
    n = len(right)

    def product(values: Array) -> Array:
        parts = np.einsum("mij,mjv->miv", matrices, values[own])
        found = np.zeros_like(values)
        np.add.at(found, own, parts)
        return found

    diagonal = np.bincount(own.ravel(), np.einsum("mii->mi", matrices).ravel(), n)[:, None]
    found = np.zeros_like(right)
    left = right.copy()
    step = left / diagonal
    size = (left * step).sum(axis=0)
    first = np.where(size > 0.0, size, 1.0)
    for _ in range(MOST_ITERATIONS):
        if (size <= CONVERGED**2 * first).all():
            break
        image = product(step)
        along = (step * image).sum(axis=0)
        share = size / np.where(along > 0.0, along, 1.0)
        found += share * step
        left -= share * image
        scaled = left / diagonal
        after = (left * scaled).sum(axis=0)
        step = scaled + after / np.where(size > 0.0, size, 1.0) * step
        size = after
    return found
