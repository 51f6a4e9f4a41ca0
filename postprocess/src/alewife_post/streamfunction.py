"""The stream function of a flow in the plane, or around an axis, on its own quadratic triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alewife_post.elements import edges, shape_functions
from alewife_post.read import Field

Array = np.ndarray

ON_AXIS = 1e-12
"""Distance from the axis over the size of the mesh up to which a node is on it."""
CONVERGED = 1e-6
"""Residual over the right-hand side: psi is then within some 1e-6 of its range."""
MOST_ITERATIONS = 4000


@dataclass(frozen=True)
class StreamFunction:
    """Nodal values of psi, and how far its velocity is from that of the flow.

    In the plane u = d psi / dy and v = - d psi / dx; around an axis r u_x = d psi / dr and
    r u_r = - d psi / dx, with psi zero on the first piece of the axis. Larger values lie left of
    the way the fluid goes.
    """

    values: Array
    """`(n_nodes,)`."""
    misfit: float
    """Root of the kinetic energy of the difference, over that of the flow."""


def stream_function(field: Field, *, is_axisymmetric: bool) -> StreamFunction | None:
    """The least-squares fit of psi to a velocity; none where nothing moves.

    A flow that has sources, be it inside a body, has no stream function: its `misfit` is large. A
    finite element flow is free of divergence on average over cells only, of which the fit takes
    the mean.
    """
    system = _assembled(field, is_axisymmetric=is_axisymmetric)
    if not system.energy > 0.0:
        return None
    unknown, n = _unknowns(field, is_axisymmetric=is_axisymmetric)
    rows = np.repeat(unknown[field.cells][:, :, None], 6, axis=2).ravel()
    columns = np.repeat(unknown[field.cells][:, None, :], 6, axis=1).ravel()
    matrix = _Matrix.summed(rows, columns, system.matrices.ravel(), n)
    rhs = np.bincount(unknown[field.cells].ravel(), system.loads.ravel(), n)
    values = matrix.solve(rhs)[unknown]
    if is_axisymmetric:
        on_axis = np.flatnonzero(_is_on_axis(field))
        if len(on_axis):
            values = values - values[on_axis[np.argmin(field.nodes[on_axis, 0])]]
    own = values[field.cells]
    fitted = np.einsum("ci,cij,cj->", own, system.matrices, own)
    left = fitted - 2.0 * np.sum(own * system.loads) + system.energy
    return StreamFunction(values, float(np.sqrt(max(left, 0.0) / system.energy)))


def _unknowns(field: Field, *, is_axisymmetric: bool) -> tuple[Array, int]:
    """Number of the unknown of each node, and how many there are: one for a piece of the axis."""
    used = np.zeros(len(field.nodes), dtype=bool)
    used[field.cells] = True
    number = np.where(used, np.cumsum(used) - 1, 0)
    n = int(used.sum())
    if not is_axisymmetric:
        return number, n
    every, is_boundary = edges(field.cells)
    ends = every[is_boundary]
    ends = ends[_is_on_axis(field)[ends].all(axis=1)]
    ends = ends[np.argsort(field.nodes[ends[:, 2], 0])]
    first = -1
    before: set[int] = set()
    for edge in ends.tolist():
        if not before & set(edge):
            first = number[edge[0]]
        number[edge] = first
        before = set(edge)
    _, number = np.unique(number, return_inverse=True)
    return number, int(number.max()) + 1


def _is_on_axis(field: Field) -> Array:
    return np.abs(field.nodes[:, 1]) <= ON_AXIS * np.ptp(field.nodes, axis=0).max()


# ---- Cells ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Assembled:
    """Integrals over cells, whose least value is the kinetic energy of a difference."""

    matrices: Array
    """`(n_cells, 6, 6)`."""
    loads: Array
    """`(n_cells, 6)`."""
    energy: float


def _points() -> tuple[Array, Array]:
    """Six points and weights in the reference triangle, exact for polynomials of degree four."""
    # Dunavant 1985
    a, b = 0.445948490915965, 0.091576213509771
    weights = np.repeat([0.223381589678011, 0.109951743655322], 3) / 2
    points = [p for c in (a, b) for p in ((c, c), (1 - 2 * c, c), (c, 1 - 2 * c))]
    return np.array(points), weights


def _slopes(points: Array) -> Array:
    """Derivatives `(q, 6, 2)` of shape functions at reference points."""
    x, y = points.T
    z = 1.0 - x - y
    zero = np.zeros_like(x)
    along_x = [1 - 4 * z, 4 * x - 1, zero, 4 * (z - x), 4 * y, -4 * y]
    along_y = [1 - 4 * z, zero, 4 * y - 1, -4 * x, 4 * x, 4 * (z - y)]
    return np.stack([np.stack(along_x, axis=1), np.stack(along_y, axis=1)], axis=-1)


def _assembled(field: Field, *, is_axisymmetric: bool) -> _Assembled:
    points, weights = _points()
    shapes, slopes = shape_functions(points), _slopes(points)
    corners, flow = field.nodes[field.cells], field.velocity[field.cells]
    n = len(field.cells)
    matrices, loads, energy = np.zeros((n, 6, 6)), np.zeros((n, 6)), 0.0
    for shape, slope, weight in zip(shapes, slopes, weights, strict=True):
        jacobian = np.einsum("cid,ie->cde", corners, slope)
        area = weight * np.abs(np.linalg.det(jacobian))
        gradient = np.einsum("ie,ced->cid", slope, np.linalg.inv(jacobian))
        velocity = np.einsum("i,cid->cd", shape, flow)
        factor = 1.0
        if is_axisymmetric:
            factor = np.maximum(corners[:, :, 1] @ shape, 1e-300)
        matrices += np.einsum("c,cid,cjd->cij", area / factor, gradient, gradient)
        wanted = np.stack([-velocity[:, 1], velocity[:, 0]], axis=1)
        loads += np.einsum("c,cid,cd->ci", area, gradient, wanted)
        energy += float(np.sum(area * factor * (velocity**2).sum(axis=1)))
    return _Assembled(matrices, loads, energy)


# ---- Linear system -------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Matrix:
    """A symmetric matrix by its rows, semi-definite: constants are in its kernel."""

    values: Array
    columns: Array
    starts: Array

    @classmethod
    def summed(cls, rows: Array, columns: Array, values: Array, n: int) -> _Matrix:
        """The sum of entries, of which each of n rows has one at least."""
        keys, index = np.unique(rows.astype(np.int64) * n + columns, return_inverse=True)
        starts = np.searchsorted(keys, np.arange(n, dtype=np.int64) * n)
        return cls(np.bincount(index, values), keys % n, starts)

    def times(self, vector: Array) -> Array:
        return np.add.reduceat(self.values * vector[self.columns], self.starts)

    def solve(self, rhs: Array) -> Array:
        """Conjugate gradients, scaled by the diagonal."""
        rows = np.repeat(np.arange(len(self.starts)), np.diff([*self.starts, len(self.columns)]))
        diagonal = np.zeros(len(self.starts))
        is_diagonal = rows == self.columns
        diagonal[rows[is_diagonal]] = self.values[is_diagonal]
        found, residual = np.zeros_like(rhs), rhs.copy()
        scaled = residual / diagonal
        direction, size = scaled.copy(), _dot(residual, scaled)
        enough = CONVERGED**2 * size
        for _ in range(MOST_ITERATIONS):
            if not size > enough:
                break
            image = self.times(direction)
            step = size / _dot(direction, image)
            found += step * direction
            residual -= step * image
            scaled = residual / diagonal
            before, size = size, _dot(residual, scaled)
            direction = scaled + (size / before) * direction
        return found


def _dot(a: Array, b: Array) -> float:
    # Not by BLAS, whose threads wait for each other longer than they work
    return float(np.einsum("i,i->", a, b))
