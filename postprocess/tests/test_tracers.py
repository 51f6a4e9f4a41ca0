"""Particles that a run has carried are read as paths."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista

from alewife_post import tracers


def test_tracers_of_a_run_are_paths_that_go_on_across_periodic_sides(tmp_path: Path) -> None:
    """Two clouds, the second released twice, one of whose particles leaves."""
    places = {
        # tracer, seed, released: x at t = 0, 1, 2; none where it has left, or is not there yet
        (0, 0, 0.0): (0.0, 1.0, 2.0),
        (1, 0, 0.0): (0.5, 1.5, None),
        (1, 0, 1.0): (None, 0.5, 1.5),
    }
    (tmp_path / "tracers").mkdir()
    lines = []
    for n in range(3):
        keys = [key for key, way in places.items() if n >= key[2]]
        x = [places[key][n] for key in keys]
        position = np.array([[0.0 if at is None else at, 0.2, 0.0] for at in x])
        cells = np.column_stack([np.ones(len(keys), int), np.arange(len(keys))]).ravel()
        kinds = np.full(len(keys), pyvista.CellType.VERTEX)
        grid = pyvista.UnstructuredGrid(cells, kinds, position % 1.0)
        for nth, name in enumerate(("tracer", "seed", "released")):
            grid.point_data[name] = np.array([float(key[nth]) for key in keys])
        grid.point_data["left"] = np.array([float(at is None) for at in x])
        grid.point_data["position"] = position
        grid.save(tmp_path / f"tracers/{n:06}.vtu")
        lines.append(f'<DataSet timestep="{n}.0" part="0" file="tracers/{n:06}.vtu"/>')
    text = f'<VTKFile type="Collection"><Collection>{"".join(lines)}</Collection></VTKFile>'
    (tmp_path / "tracers.pvd").write_text(text)

    found = tracers.read_paths(tmp_path)
    assert found.seed == [0, 1, 1]
    assert found.released == [0.0, 0.0, 1.0]
    assert [list(times) for times in found.time] == [[0, 1, 2], [0, 1], [1, 2]]
    assert [list(way[:, 0]) for way in found.place] == [[0, 1, 2], [0.5, 1.5], [0.5, 1.5]]
    with pytest.raises(FileNotFoundError, match=r"\[\[tracer\]\]"):
        tracers.read_paths(tmp_path / "none")
