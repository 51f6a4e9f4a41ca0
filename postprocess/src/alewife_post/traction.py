"""Traction of the fluid on surfaces of bodies: from the residual of its equations, or recovered."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from alewife_post import asked, bodies, derived, sides
from alewife_post.cells import reference_nodes, slopes, slopes_in_space, weights
from alewife_post.domains import periods
from alewife_post.facets import SIDES, Facets, boundary_edges, facets_of, parts
from alewife_post.read import Field, Run
from alewife_post.surfaces import boundary_faces

Array = np.ndarray

QUANTITIES = ("traction", "wall-shear")
"""Of pictures of surfaces."""
CREASE = 40.0
"""Degrees from which on facets that meet have a normal of their own each."""
RESIDUAL, RECOVERED = "residual", "recovered"
GAUSS = 4
"""Points a direction, for integrals over cells and facets."""
CONVERGED = 1e-13
MOST_ITERATIONS = 500


@dataclass(frozen=True)
class Surface:
    """What acts on a surface."""

    facets: Facets
    nodes: Array
    """Numbers of its nodes, `(n,)`; one at a crease is there once for each of its sides."""
    own: Array
    """Nodes of each facet by their places in `nodes`, `(m, k)`."""
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
    """Surfaces of all bodies, then of each side, with the tractions on them.

    Each has nodes of its own, and several where it has a crease: at the corner of two sides each
    has its own normal.

    Where one frame has all that is in the balance of momentum (Stokes flow, or a steady flow past
    held bodies), the traction on a body is that whose integrals are the residuals of the equations
    at its nodes: it adds up to `force` by construction. Elsewhere, and on sides, it is that of the
    recovered gradient.
    """
    own = derived.rates(field, is_axisymmetric=run.is_axisymmetric)
    recovered = derived.stress(run.case, field, own)
    found = []
    for facets in facets_of(run, field):
        own_nodes, nodes = _parted(field, facets.nodes)
        normal = -_normals(field, facets.nodes, own_nodes, len(nodes))
        viscous = np.einsum("nij,nj->ni", recovered[nodes], normal)
        smooth = viscous - field.pressure[nodes, None] * normal
        traction, method = smooth, RECOVERED
        if facets.is_body and _has_residual(run, field):
            once, place = np.unique(nodes, return_inverse=True)
            traction = _by_residual(run, field, facets, once)[place]
            method = RESIDUAL
        force = _integral(run, field, facets, own_nodes, traction)
        found.append(
            Surface(facets, nodes, own_nodes, normal, traction, smooth, viscous, method, force)
        )
    return found


def with_quantity(run: Run, field: Field, quantity: str) -> Field:
    """The field with the magnitude of the traction on bodies, or of its tangential part."""
    if quantity not in QUANTITIES:
        return derived.with_quantity(run, field, quantity)
    values = np.zeros(len(field.nodes))
    for one in surfaces_of(run, field):
        # At corners the larger one: a wall, rather than an open side beside it
        np.maximum.at(values, one.nodes, magnitude(one, quantity))
    return replace(field, derived=values)


def magnitude(one: Surface, quantity: str) -> Array:
    """Of the traction at the nodes of a surface, or of its tangential part, `(n,)`."""
    return np.linalg.norm(one.recovered if quantity == "traction" else shear(one), axis=1)


def shear(one: Surface) -> Array:
    """The tangential part of the traction, `(n, d)`."""
    along = (one.recovered * one.normal).sum(axis=1, keepdims=True)
    return one.recovered - along * one.normal


def chosen(run: Run, found: list[Surface], names: list[str]) -> list[Surface]:
    """Those of some names; a KeyError says which there are."""
    by_name = {one.facets.name: one for one in found}
    for name in names:
        if name not in by_name:
            known = ", ".join(by_name) or "none"
            why = sides.why_nameless(run) if SIDES in by_name else ""
            raise asked.UnknownNameError(f"no side or body {name}; there are {known}{why}")
    return [by_name[name] for name in dict.fromkeys(names)]


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


def _normals(field: Field, facets: Array, own: Array, n: int) -> Array:
    """Unit normals out of the fluid at nodes, `(n, d)`: means of facets by their areas."""
    total = np.zeros((n, field.nodes.shape[1]))
    for k, vectors in enumerate(_at_nodes(field, facets)):
        np.add.at(total, own[:, k], vectors)
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return total / np.where(size > 0.0, size, 1.0)


def _at_nodes(field: Field, facets: Array) -> list[Array]:
    places = field.nodes[facets]
    return [_vectors(places, local) for local in reference_nodes(field.nodes.shape[1] - 1)]


def _parted(field: Field, facets: Array) -> tuple[Array, Array]:
    """Nodes of facets `(m, k)` by numbers of their own, and the node that each of these is.

    A node at which facets meet at an edge has one number for each side of it.
    """
    m, k = facets.shape
    if m == 0:
        return facets, np.zeros(0, dtype=int)
    normal = np.stack(_at_nodes(field, facets), axis=1)
    normal = normal / np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), 1e-300)
    corner = np.arange(m * k).reshape(m, k)
    # What facets have in common: in the plane a vertex, in space an edge
    edges = ((0,), (1,)) if k == 3 else ((0, 1, 3), (1, 2, 4), (0, 2, 5))
    keys = np.concatenate([facets[:, edge[-1]] for edge in edges])
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    pairs = [np.column_stack([corner.ravel(), corner.ravel()])]
    first, last = (
        corner[(at % m)[:, None], np.array(edges)[at // m]] for at in (order[same], order[same + 1])
    )
    first, last = (
        np.take_along_axis(one, np.argsort(facets.ravel()[one], axis=1), axis=1)
        for one in (first, last)
    )
    flat = normal.reshape(m * k, -1)
    is_smooth = (flat[first] * flat[last]).sum(axis=2) > np.cos(np.radians(CREASE))
    pairs.append(np.column_stack([first[is_smooth], last[is_smooth]]))
    label = parts(np.vstack(pairs), m * k)[: m * k]
    # In the order of nodes, so that a surface without creases has them as they are
    _, start, place = np.unique(label, return_index=True, return_inverse=True)
    nodes = facets.ravel()[start]
    order = np.argsort(nodes, kind="stable")
    number = np.empty(len(order), dtype=int)
    number[order] = np.arange(len(order))
    return number[place].reshape(m, k), nodes[order]


def _around(run: Run, places: Array) -> Array:
    """Way around the axis of points `(n, d)`, one in the plane and in space."""
    if run.is_axisymmetric:
        return 2.0 * np.pi * places[:, 1]
    return np.ones(len(places))


def _integral(run: Run, field: Field, facets: Facets, own: Array, values: Array) -> Array:
    places = field.nodes[facets.nodes]
    total = np.zeros(values.shape[1])
    for local, weight in zip(*_rule(places.shape[2] - 1), strict=True):
        shape = weights(local[None])[0]
        area = weight * np.linalg.norm(_vectors(places, local), axis=1)
        area = area * _around(run, np.einsum("k,mki->mi", shape, places))
        total += area @ np.einsum("k,mki->mi", shape, values[own])
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
    every = boundary_faces(field) if run.is_spatial else boundary_edges(field)
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
