"""Surfaces of equal vorticity, speed or scalars in space, and the value that shows most."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post.domains import domain_box, periods
from alewife_post.fields import nodal_values
from alewife_post.periodic import images
from alewife_post.quantities import percentile
from alewife_post.read import Field
from alewife_post.sections import pieces

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

QUANTITIES = ("vorticity", "speed")
WITHIN = 50.0
"""Per cent of a quantity, by volume and over what is in view, that lies within its surface."""


def parsed(text: str, scalars: Sequence[str] = ()) -> tuple[str, float | None]:
    """A quantity, and its value if it is asked for, written as `vorticity` or `vorticity=2.5`.

    `scalars` are those of the run, which have surfaces where their value is given.
    """
    found = re.fullmatch(r"\s*([\w.-]+)\s*(?:=\s*([-+0-9.eE]+)\s*)?", text)
    if found:
        try:
            value = None if found[2] is None else float(found[2])
        except ValueError:
            value = math.nan
        if found[1] in QUANTITIES and (value is None or value > 0.0):
            return found[1], value
        if found[1] in scalars and value is not None and math.isfinite(value):
            return found[1], value
    of_scalars = "".join(f", or {name}=0.5" for name in scalars)
    raise ValueError(
        f"{text} has no surface: write {' or '.join(QUANTITIES)}, or with a positive value, "
        f"such as vorticity=2.5{of_scalars}"
    )


def samples(field: Field, quantity: str, box: Array) -> tuple[Array, Array]:
    """Values at the corners of cells in a box `(2, 3)`, and the volumes they hold."""
    corners = field.nodes[field.cells[:, :4]]
    middle = corners.mean(axis=1)
    seen = ((middle >= box[0]) & (middle <= box[1])).all(axis=1)
    volume = np.abs(np.linalg.det(corners[seen][:, 1:] - corners[seen][:, :1])) / 6.0
    values = nodal_values(field, quantity)[field.cells[seen][:, :4]]
    return values.ravel(), np.repeat(volume / 4.0, 4)


def level_of(found: list[tuple[Array, Array]]) -> float:
    """The value beyond which half of a quantity lies in some fields together."""
    values = np.concatenate([values for values, _ in found])
    share = np.concatenate([share for _, share in found])
    if not (values * share).any():
        raise ValueError("it is zero all over what is in view: there is no surface to show")
    return percentile(values, values * share, 100.0 - WITHIN)


def isosurface(
    case: dict[str, Any], field: Field, quantity: str, level: float, box: Array
) -> pyvista.PolyData:
    """The surface on which a quantity has a value, within a box `(2, 3)`, smooth to look at.

    That of a periodic domain continues beyond the mesh.
    """
    import pyvista

    surface = _surface(field, quantity, level)
    if not periods(case).any():
        return _clipped(surface, box)
    low, high = domain_box(case)
    found = []
    for shift in images(case, field.nodes.min(axis=0), field.nodes.max(axis=0), (low, high)):
        part = _clipped(surface, np.array([low, high]) - shift)
        if part.n_cells:
            found.append(part.translate(shift))
    return pyvista.merge(found) if found else pyvista.PolyData()


def _surface(field: Field, quantity: str, level: float) -> pyvista.PolyData:
    import pyvista

    values = nodal_values(field, quantity)
    own = values[field.cells]
    near = (own.min(axis=1) <= level) & (own.max(axis=1) >= level)
    if not near.any():
        return pyvista.PolyData()
    return pieces(field, near, values).contour([level], scalars="values")


def _clipped(found: pyvista.PolyData, box: Array) -> pyvista.PolyData:
    """The part of a surface in a box."""
    for axis in range(3):
        for end, sign in ((box[0], -1.0), (box[1], 1.0)):
            if found.n_cells:
                origin = np.where(np.arange(3) == axis, end, 0.0)
                found = found.clip(normal=sign * np.eye(3)[axis], origin=origin)
    return found.compute_normals(split_vertices=False) if found.n_cells else found
