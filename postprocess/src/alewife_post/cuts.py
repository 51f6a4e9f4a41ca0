"""Slices of a flow in space: the part of a plane that is cut out of its curved cells."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post import planes, tetrahedra
from alewife_post.domains import domain_box, periods
from alewife_post.fields import MAGNITUDES, nodal_values
from alewife_post.periodic import images
from alewife_post.read import Field

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

JUST = 1e-6
"""Distance from the end of a mesh over its size."""
HALVINGS = 2
"""Of the edges of a cell that is cut: a curved side has four times as many straight pieces."""


@dataclass(frozen=True)
class Cut:
    """A slice that is shown, less where the view has moved to."""

    plane: planes.Plane
    low: Array
    """Least coordinates in the plane, `(2,)`."""
    high: Array
    moves: bool = False
    """Whether it goes with the view."""

    def at(self, offset: Array, *, with_view: bool = False) -> Cut:
        """The same where the view has moved to; all of it `with_view`, even if it stands still."""
        if self.moves or with_view:
            return replace(self, plane=replace(self.plane, origin=self.plane.origin + offset))
        shift = self.plane.across @ offset
        return replace(self, low=self.low + shift, high=self.high + shift)

    def corners(self) -> Array:
        """`(4, 3)`."""
        pairs = [(x, y) for x in (self.low[0], self.high[0]) for y in (self.low[1], self.high[1])]
        return self.plane.points(np.array(pairs))


def within(plane: planes.Plane, field: Field) -> planes.Plane:
    """A plane that a mesh ends at, just inside of it: one in which faces lie cuts no cells."""
    heights = (field.nodes - plane.origin) @ plane.normal
    least = JUST * np.ptp(field.nodes, axis=0).max()
    if abs(heights.min()) < least:
        return replace(plane, origin=plane.origin + (least + heights.min()) * plane.normal)
    if abs(heights.max()) < least:
        return replace(plane, origin=plane.origin - (least - heights.max()) * plane.normal)
    return plane


def whole_slice(
    case: dict[str, Any],
    field: Field,
    cut: Cut,
    quantity: str,
    region: tuple[Array, Array] | None = None,
) -> pyvista.PolyData:
    """A slice that continues beyond the mesh of a periodic domain, over its box or a region."""
    if not periods(case).any():
        return slice_of(field, cut, quantity)
    import pyvista

    mesh = (field.nodes.min(axis=0), field.nodes.max(axis=0))
    found = []
    for shift in images(case, *mesh, region or domain_box(case)):
        part = slice_of(field, cut.at(-shift, with_view=True), quantity)
        if part.n_cells:
            found.append(part.translate(shift))
    return pyvista.merge(found) if found else pyvista.PolyData()


def slice_of(field: Field, cut: Cut, quantity: str) -> pyvista.PolyData:
    """The part of a plane that is cut out, in triangles with `values` at their corners."""
    import pyvista

    plane = within(cut.plane, field)
    lowest, highest = tetrahedra.bounds((field.nodes - plane.origin) @ plane.normal, field.cells)
    own_low, own_high = tetrahedra.bounds(plane.coordinates(field.nodes), field.cells)
    near = (lowest <= 0) & (highest >= 0)
    near &= (own_high >= cut.low).all(axis=1) & (own_low <= cut.high).all(axis=1)
    if not near.any():
        return pyvista.PolyData()
    values = nodal_values(field, quantity)
    points, fine, cells = tetrahedra.pieces(field, near, values, HALVINGS)
    if quantity in MAGNITUDES:
        # A magnitude is not negative, though a quadratic between its values may be.
        fine = np.maximum(fine, 0.0)
    grid = pyvista.UnstructuredGrid({tetrahedra.STRAIGHT: cells}, points)
    grid.point_data["values"] = fine
    found = grid.slice(normal=plane.normal, origin=plane.origin)
    for along, (low, high) in zip(plane.across, zip(cut.low, cut.high, strict=True), strict=True):
        for end, outwards in ((low, -along), (high, along)):
            if found.n_cells:
                found = found.clip(normal=outwards, origin=plane.origin + end * along)
    return found.triangulate() if found.n_cells else found


def samples(part: pyvista.PolyData) -> tuple[Array, Array]:
    """Values at cells of a surface and the areas they hold."""
    sized = part.compute_cell_sizes(length=False, volume=False)
    values = sized.point_data_to_cell_data().cell_data["values"]
    areas = np.asarray(sized.cell_data["Area"])
    return np.asarray(values), areas + 1e-300
