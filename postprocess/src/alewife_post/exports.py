"""Derived fields and tractions as files for ParaView, and the forces that tractions add up to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from alewife_post import bodies, derived, skins, traction
from alewife_post.planes import AXES
from alewife_post.read import QUADRATIC_TETRAHEDRON, QUADRATIC_TRIANGLE, Field, Run
from alewife_post.skins import spatial
from alewife_post.streamfunction import stream_function
from alewife_post.whole import replacing

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray


@dataclass(frozen=True)
class Written:
    """Files of one frame, and a row for each body and side."""

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
        ("surfaces.vtu", skins.grid(field, found)),
    ):
        grid.field_data["TimeValue"] = [field.time]
        # The ending says the format, and VTK asks it of the name
        with replacing(out / name) as unfinished:
            grid.save(unfinished)
        paths.append(out / name)
    return Written(paths, [row(run, field, one) for one in found])


def _fluid(run: Run, field: Field, own: derived.Rates) -> pyvista.UnstructuredGrid:
    import pyvista

    kind = QUADRATIC_TETRAHEDRON if run.is_spatial else QUADRATIC_TRIANGLE
    grid = pyvista.UnstructuredGrid({kind: field.cells}, spatial(field.nodes))
    data = grid.point_data
    data["velocity"] = spatial(field.velocity)
    data["pressure"] = field.pressure
    data["vorticity"] = own.vorticity
    data["strain_rate"] = _tensor(own)
    data["shear_rate"] = own.shear_rate
    data["q"] = own.q
    data["divergence"] = own.divergence
    data["viscosity"] = derived.viscosity(run.case, own.shear_rate)
    for name, values in field.scalars.items():
        data[name] = values
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


def row(run: Run, field: Field, one: traction.Surface) -> dict[str, object]:
    """The integral of the traction on a body or a side beside the force that the run has written.

    The force of a side is that of `series.csv`, at the time of the frame.
    """
    name = one.facets.name
    shear = traction.magnitude(one, "wall-shear")
    found: dict[str, object] = {
        "surface": name,
        "is": "body" if one.facets.is_body else "side",
        "method": one.method,
        "nodes": len(one.nodes),
        "largest wall shear": float(shear.max()),
    }
    history = run.bodies.get(name)
    for axis in range(1 if run.is_axisymmetric else len(one.force)):
        found[f"traction.{AXES[axis]}"] = float(one.force[axis])
        if not one.facets.is_body:
            force = _of_side(run, f"{name}.force.{AXES[axis]}", field.time)
        elif history is not None and bodies.is_written(run, field.time):
            force = history.force[bodies.nearest(history, field.time), axis]
        else:
            continue
        if force is not None:
            found[f"force.{AXES[axis]}"] = float(force)
    return found


def _of_side(run: Run, column: str, time: float) -> float | None:
    """A quantity of a side in the row of a time, if the run has both."""
    if not (run.path / "series.csv").is_file() or column not in run.series:
        return None
    times = run.series["time"]
    if not len(times):
        return None
    if not run.is_unsteady:
        return float(run.series[column][-1])
    nearest = int(np.argmin(np.abs(times - time)))
    is_there = abs(times[nearest] - time) <= 1e-6 * float(np.ptp(times)) + 1e-12
    return float(run.series[column][nearest]) if is_there else None
