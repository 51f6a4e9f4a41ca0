"""Derived fields and tractions as files for ParaView, and the forces that tractions add up to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from alewife_post import bodies, derived, traction
from alewife_post.planes import AXES
from alewife_post.read import QUADRATIC_TETRAHEDRON, QUADRATIC_TRIANGLE, Field, Run
from alewife_post.streamfunction import stream_function
from alewife_post.whole import replacing

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

QUADRATIC_EDGE = 21


@dataclass(frozen=True)
class Written:
    """Files of one frame, and a row for each body."""

    paths: list[Path]
    rows: list[dict[str, object]]


def write_fields(run: Run, time: float | None, out: Path) -> Written:
    """Write `out/fields.vtu` and `out/surfaces.vtu` of the frame nearest to a time."""
    field = run.field(time)
    own = derived.rates(field, is_axisymmetric=run.is_axisymmetric)
    found = traction.surfaces_of(run, field)
    out.mkdir(parents=True, exist_ok=True)
    paths = []
    for name, grid in (
        ("fields.vtu", _fluid(run, field, own)),
        ("surfaces.vtu", _surfaces(field, found)),
    ):
        grid.field_data["TimeValue"] = [field.time]
        # The ending says the format, and VTK asks it of the name
        with replacing(out / name) as unfinished:
            grid.save(unfinished)
        paths.append(out / name)
    return Written(
        paths, [_row(run, field, one) for one in found if one.facets.name != traction.SIDES]
    )


def _fluid(run: Run, field: Field, own: derived.Rates) -> pyvista.UnstructuredGrid:
    import pyvista

    kind = QUADRATIC_TETRAHEDRON if run.is_spatial else QUADRATIC_TRIANGLE
    grid = pyvista.UnstructuredGrid({kind: field.cells}, _spatial(field.nodes))
    data = grid.point_data
    data["velocity"] = _spatial(field.velocity)
    data["pressure"] = field.pressure
    data["vorticity"] = own.vorticity
    data["strain_rate"] = _tensor(own)
    data["shear_rate"] = own.shear_rate
    data["q"] = own.q
    data["divergence"] = own.divergence
    data["viscosity"] = derived.viscosity(run.case, own.shear_rate)
    if not run.is_spatial:
        psi = stream_function(field, is_axisymmetric=run.is_axisymmetric)
        if psi is not None:
            data["stream_function"] = psi.values
            grid.field_data["stream_function_misfit"] = [psi.misfit]
    return grid


def _tensor(own: derived.Rates) -> Array:
    """Rate of strain with components xx, yy, zz, xy, yz, xz; about an axis zz is around it."""
    strain = own.strain
    n, d = strain.shape[:2]
    full = np.zeros((n, 3, 3))
    full[:, :d, :d] = strain
    full[:, 2, 2] += own.hoop
    return np.stack([full[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))], 1)


def _surfaces(field: Field, found: list[traction.Surface]) -> pyvista.UnstructuredGrid:
    """Facets of all surfaces, each with nodes of its own, and `body`, a number in their order."""
    import pyvista

    d = field.nodes.shape[1]
    facets, parts, start = [], [], 0
    for number, one in enumerate(found):
        place = np.full(len(field.nodes), -1)
        place[one.nodes] = start + np.arange(len(one.nodes))
        facets.append(place[one.facets.nodes])
        start += len(one.nodes)
        parts.append((number, one))
    kind = QUADRATIC_EDGE if d == 2 else QUADRATIC_TRIANGLE
    points = np.concatenate([field.nodes[one.nodes] for one in found])
    grid = pyvista.UnstructuredGrid({kind: np.concatenate(facets)}, _spatial(points))
    data = grid.point_data
    for name in ("traction", "recovered", "viscous", "normal"):
        key = {"viscous": "viscous_traction", "recovered": "traction_recovered"}.get(name, name)
        data[key] = _spatial(np.concatenate([getattr(one, name) for one in found]))
    data["pressure"] = np.concatenate([field.pressure[one.nodes] for one in found])
    data["wall_shear"] = np.concatenate([_shear(one) for one in found])
    data["body"] = np.concatenate([np.full(len(one.nodes), number) for number, one in parts])
    grid.field_data["bodies"] = [one.facets.name for one in found]
    return grid


def _shear(one: traction.Surface) -> Array:
    """Magnitude of the tangential part of the traction."""
    along = (one.recovered * one.normal).sum(axis=1, keepdims=True)
    return np.linalg.norm(one.recovered - along * one.normal, axis=1)


def _spatial(values: Array) -> Array:
    return np.hstack([values, np.zeros((len(values), 3 - values.shape[1]))])


def _row(run: Run, field: Field, one: traction.Surface) -> dict[str, object]:
    """The integral of the traction beside the force that the run has written."""
    name = one.facets.name
    row: dict[str, object] = {"body": name, "method": one.method, "nodes": len(one.nodes)}
    history = run.bodies.get(name)
    for axis in range(1 if run.is_axisymmetric else len(one.force)):
        row[f"traction.{AXES[axis]}"] = float(one.force[axis])
        if history is not None and bodies.is_written(run, field.time):
            force = history.force[bodies.nearest(history, field.time), axis]
            row[f"force.{AXES[axis]}"] = float(force)
    return row
