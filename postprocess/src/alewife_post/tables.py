"""Runs for pandas and pyvista: tables of comparisons, sweeps and references, fields as grids.

What compares runs needs matplotlib, and is imported where it is called: reading runs does not.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from alewife_post import checked, evidence, packages
from alewife_post.read import QUADRATIC_TETRAHEDRON, QUADRATIC_TRIANGLE, Field, Run

if TYPE_CHECKING:
    import pandas
    import pyvista


def series_table(run: Run) -> pandas.DataFrame:
    """The series of a run, indexed by time."""
    return run.to_dataframe()


def reference_table(run: Run) -> pandas.DataFrame:
    """What came of each reference of the case, one row each; without rows before its end."""
    pandas = packages.needed("pandas")
    return pandas.DataFrame(evidence.comparisons(run))


def comparison_table(paths: Iterable[str | Path], names: Iterable[str] = ()) -> pandas.DataFrame:
    """Statistics of runs and published curves, and how far each is from the first run."""
    pandas = packages.needed("pandas")
    from alewife_post import compare

    runs, sweeps, curves = compare.open_all([Path(path) for path in checked.names(paths)])
    if sweeps or not runs:
        raise ValueError("runs and curves are wanted; of a sweep take sweep_table")
    chosen = compare.chosen_names(runs, curves, checked.names(names))
    return pandas.DataFrame(compare.differences(runs, curves, chosen))


def sweep_table(
    path: str | Path, names: Iterable[str] = (), statistic: str = "final"
) -> pandas.DataFrame:
    """One row a point of a sweep: what it sets, and a statistic of each quantity."""
    pandas = packages.needed("pandas")
    from alewife_post import compare, sweeps

    sweep = compare.open_sweep(path)
    rows = sweeps.table(sweep, sweeps.chosen_names(sweep, checked.names(names)), statistic)
    return pandas.DataFrame(rows).set_index("point")


def grid(field: Field) -> pyvista.UnstructuredGrid:
    """A field as a grid of quadratic cells with its values at nodes, for filters of VTK."""
    pyvista = packages.needed("pyvista")
    if not isinstance(field, Field):
        raise TypeError(f"{field!r} is no field: field(TIME) of a run gives one")
    n_dimensions = field.nodes.shape[1]
    points = np.zeros((len(field.nodes), 3))
    points[:, :n_dimensions] = field.nodes
    kind = QUADRATIC_TRIANGLE if n_dimensions == 2 else QUADRATIC_TETRAHEDRON
    made = pyvista.UnstructuredGrid({kind: field.cells}, points)
    velocity = np.zeros_like(points)
    velocity[:, :n_dimensions] = field.velocity
    made.point_data["velocity"] = velocity
    made.point_data["pressure"] = field.pressure
    made.point_data["vorticity"] = field.vorticity
    for name, values in field.scalars.items():
        made.point_data[name] = values
    made.field_data["TimeValue"] = [field.time]
    return made
