"""Fields derived from a flow: its gradient at nodes, vorticity, strain rate, Q, stress."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from alewife_post.cells import reference_nodes, slopes_in_space
from alewife_post.read import Field, Run

Array = np.ndarray

QUANTITIES = ("shear-rate", "q")
"""Of pictures, beside those that a field file has."""
ON_AXIS = 1e-12
"""Distance from the axis over the size of the mesh up to which a node is on it."""
CHUNK = 20_000
"""Cells at one time."""


def nodal_gradient(field: Field, values: Array) -> Array:
    """Derivatives `(n_nodes, ..., d)` of nodal values `(n_nodes, ...)`, recovered at nodes.

    The mean of those of all cells of a node, by their volumes: of second order in the size of
    cells, at boundaries, too, as the gradient of each cell is.
    """
    n, d = field.nodes.shape
    local = reference_nodes(d)
    shape = values.shape[1:]
    flat = values.reshape(n, -1)
    total, weight = np.zeros((n, flat.shape[1] * d)), np.zeros(n)
    for start in range(0, len(field.cells), CHUNK):
        cells = field.cells[start : start + CHUNK]
        places, own = field.nodes[cells], flat[cells]
        volume = np.abs(np.linalg.det(places[:, 1 : d + 1] - places[:, :1]))
        for k, at in enumerate(local):
            by, _ = slopes_in_space(places, np.tile(at, (len(cells), 1)))
            slope = np.einsum("nkv,nki->nvi", own, by).reshape(len(cells), -1)
            weight += np.bincount(cells[:, k], volume, n)
            for column in range(slope.shape[1]):
                total[:, column] += np.bincount(cells[:, k], volume * slope[:, column], n)
    return (total / np.where(weight > 0.0, weight, 1.0)[:, None]).reshape(n, *shape, d)


@dataclass(frozen=True)
class Rates:
    """The velocity gradient at nodes, and what is made of it."""

    gradient: Array
    """`du_i / dx_j`, `(n, d, d)`."""
    hoop: Array
    """`u_r / r` about an axis, `(n,)`; zero in the plane and in space."""

    @property
    def strain(self) -> Array:
        """Rate of strain D, `(n, d, d)`."""
        return 0.5 * (self.gradient + self.gradient.swapaxes(1, 2))

    @property
    def shear_rate(self) -> Array:
        """`sqrt(2 D : D)`, `(n,)`."""
        return np.sqrt(2.0 * ((self.strain**2).sum(axis=(1, 2)) + self.hoop**2))

    @property
    def vorticity(self) -> Array:
        """`(n,)`, counter-clockwise; in space `(n, 3)`."""
        g = self.gradient
        if g.shape[1] == 2:
            return g[:, 1, 0] - g[:, 0, 1]
        pairs = ((2, 1), (0, 2), (1, 0))
        return np.stack([g[:, i, j] - g[:, j, i] for i, j in pairs], axis=1)

    @property
    def divergence(self) -> Array:
        """`(n,)`: zero but for errors."""
        return np.trace(self.gradient, axis1=1, axis2=2) + self.hoop

    @property
    def q(self) -> Array:
        """`(|W|^2 - |D|^2) / 2`, `(n,)`: positive where turning wins over strain."""
        spin = 0.5 * (self.gradient - self.gradient.swapaxes(1, 2))
        strain = (self.strain**2).sum(axis=(1, 2)) + self.hoop**2
        return 0.5 * ((spin**2).sum(axis=(1, 2)) - strain)


def rates(field: Field, *, is_axisymmetric: bool) -> Rates:
    """Velocity gradients of a flow at its nodes."""
    gradient = nodal_gradient(field, field.velocity)
    hoop = np.zeros(len(field.nodes))
    if is_axisymmetric:
        r = field.nodes[:, 1]
        off = np.abs(r) > ON_AXIS * np.ptp(field.nodes, axis=0).max()
        # On the axis u_r / r is its own derivative
        hoop = np.where(off, field.velocity[:, 1] / np.where(off, r, 1.0), gradient[:, 1, 1])
    return Rates(gradient, hoop)


def with_quantity(run: Run, field: Field, quantity: str) -> Field:
    """The field with a quantity that is derived, if it is one."""
    if quantity not in QUANTITIES:
        return field
    own = rates(field, is_axisymmetric=run.is_axisymmetric)
    return replace(field, derived=own.q if quantity == "q" else own.shear_rate)


def viscosity(case: dict[str, Any], shear_rate: Array) -> Array:
    """Dynamic viscosity at rates of shear, by the law of the case."""
    given = case["fluid"]["viscosity"]
    if not isinstance(given, dict):
        return np.full(np.shape(shear_rate), float(given))
    ((law, values),) = given.items()
    g = np.asarray(shear_rate)
    match law:
        case "carreau" | "cross":
            low = values.get("infinite", 0.0)
            index, scaled = values["index"], values["time"] * g
            if law == "carreau":
                share = (1.0 + scaled**2) ** (0.5 * (index - 1.0))
            else:
                share = 1.0 / (1.0 + scaled ** (1.0 - index))
            return low + (values["zero"] - low) * share
        case "power-law" | "herschel-bulkley":
            g = np.sqrt(g**2 + values["regularised"] ** 2)
            power = values["consistency"] * g ** (values["index"] - 1.0)
            return power + values.get("yield_stress", 0.0) / g
    raise ValueError(f"the law of viscosity {law} is not known here")


def stress(case: dict[str, Any], field: Field, own: Rates) -> Array:
    """Viscous stress `2 mu D` at nodes, `(n, d, d)`."""
    return 2.0 * viscosity(case, own.shear_rate)[:, None, None] * own.strain
