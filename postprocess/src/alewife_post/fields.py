"""A flow as it is shown: of a body, at rest, with its images; its quantities at nodes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alewife_post import asked, bodies, ways
from alewife_post.elements import inside, mirrored
from alewife_post.periodic import tiles
from alewife_post.quantities import speed
from alewife_post.read import Field, Run

Array = np.ndarray
View = tuple[float, float, float, float]

MAGNITUDES = ("speed", "vorticity", "shear-rate", "traction", "wall-shear")
"""Quantities that are not negative, of the vorticity in space."""
AT_REST = 1e-9
"""Largest speed over that of the fastest body at any time at which nothing flows any more."""


def flow_at(run: Run, time: float | None, frame: str | None) -> Field:
    """The flow at the frame nearest to a time, or the last one, less the velocity of a body."""
    field = settled(run, run.field(time))
    if frame is None:
        return field
    return replace(field, velocity=field.velocity - body_velocity(run, frame, field.time))


def body_velocity(run: Run, name: str, time: float) -> Array:
    """Velocity of a body, of as many components as the run has dimensions."""
    if name not in run.bodies:
        known = ", ".join(run.bodies) or "none"
        raise asked.UnknownNameError(f"no body {name}; bodies of this run: {known}")
    history = run.bodies[name]
    return history.velocity[bodies.nearest(history, time), : 3 if run.is_spatial else 2]


def settled(run: Run, field: Field) -> Field:
    """The flow, without what rounding leaves of it where all has come to rest."""
    largest = speed(field.velocity).max()
    if largest > AT_REST * ways.fastest(run):
        return field
    return replace(field, velocity=0.0 * field.velocity)


def prepared(run: Run, field: Field, view: View, *, mirror: bool) -> list[Field]:
    """The flow as a frame shows it: on both sides of an axis, with images in a periodic domain."""
    if run.is_axisymmetric and mirror:
        field = mirrored(field)
    x0, x1, y0, y1 = view
    region = (np.array([x0, y0, 0.0]), np.array([x1, y1, 0.0]))
    found = [inside(tile, view) for tile in tiles(run.case, field, region)]
    return [tile for tile in found if len(tile.cells)] or found[:1]


def nodal_values(field: Field, quantity: str) -> Array:
    """Values of a quantity at the nodes, `(n_nodes,)`; of the vorticity in space its magnitude."""
    match quantity:
        case "speed":
            return speed(field.velocity)
        case "vorticity":
            return field.vorticity if field.vorticity.ndim == 1 else speed(field.vorticity)
        case "pressure":
            return field.pressure
        case _ if quantity in field.scalars:
            return field.scalars[quantity]
        case _ if field.derived is not None:
            return field.derived
        case _:
            known = ", ".join(["speed", "pressure", "vorticity", *field.scalars])
            raise ValueError(f"{quantity} is no quantity of this flow; there are {known}")
