"""Meshes of quadratic cells for tests, and fields on them that are known."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from alewife_post.cells import ENDS
from alewife_post.read import Field, Run, open_run

Array = np.ndarray
TOP = """title = "A known flow"
geometry = "{geometry}"
[domain]
{domain}
[time.{time}]
{body}"""


def quadratic(vertices: Array, corners: Array) -> tuple[Array, Array]:
    """Nodes and cells of straight triangles or tetrahedra, with nodes in the middles of edges."""
    d = vertices.shape[1]
    pairs = np.sort(corners[:, ENDS[d]].reshape(-1, 2), axis=1)
    edges, number = np.unique(pairs, axis=0, return_inverse=True)
    nodes = np.vstack([vertices, vertices[edges].mean(axis=1)])
    return nodes, np.hstack([corners, len(vertices) + number.reshape(len(corners), -1)])


def rectangle(
    n: tuple[int, int], low: Array, high: Array, skew: float = 0.0
) -> tuple[Array, Array]:
    """Triangles in a rectangle, of which inner vertices are moved by part of a cell."""
    i, j = np.meshgrid(np.arange(n[0] + 1), np.arange(n[1] + 1), indexing="ij")
    at = np.stack([i, j], axis=-1).reshape(-1, 2).astype(float)
    inner = ((at > 0) & (at < n)).all(axis=1)
    shift = skew * np.column_stack(
        [np.sin(7 * at[:, 0] + 3 * at[:, 1]), np.cos(5 * at.sum(axis=1))]
    )
    at = np.where(inner[:, None], at + shift, at)
    vertices = np.asarray(low) + at / np.asarray(n) * (np.asarray(high) - low)

    def number(a: Array, b: Array) -> Array:
        return a * (n[1] + 1) + b

    a, b = (one.ravel() for one in np.meshgrid(np.arange(n[0]), np.arange(n[1]), indexing="ij"))
    first = np.column_stack([number(a, b), number(a + 1, b), number(a + 1, b + 1)])
    second = np.column_stack([number(a, b), number(a + 1, b + 1), number(a, b + 1)])
    return quadratic(vertices, np.vstack([first, second]))


def box(n: int, low: float, high: float, skip: Callable[[Array], Array] | None = None) -> tuple:
    """Tetrahedra in a cube, six in each of its `n**3`, without cubes at which `skip` is true."""
    at = np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    step = (high - low) / n
    if skip is not None:
        at = at[~skip(low + step * (at + 0.5))]
    cells = []
    for order in [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]:
        steps = np.vstack([np.zeros(3), np.cumsum(np.eye(3)[list(order)], axis=0)]).astype(int)
        if np.linalg.det(steps[1:] - steps[0]) < 0:
            steps[[2, 3]] = steps[[3, 2]]
        cells.append(at[:, None] + steps)
    corners = np.concatenate(cells)
    every, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return quadratic(low + step * every, number.reshape(-1, 4))


def shell(n_around: int, n_across: int, radii: tuple[float, float], end: float) -> tuple:
    """Curved triangles between two circles about the origin, from the angle zero to `end`."""
    nodes, cells = rectangle((n_across, n_around), np.zeros(2), np.ones(2))
    radius = radii[0] * (radii[1] / radii[0]) ** nodes[:, 0]
    angle = end * nodes[:, 1]
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), cells


def written(
    path: Path,
    frames: list[tuple[float, Array, Array, Array, Array]],
    top: str,
    scalars: dict[str, Callable[[Array], Array]] | None = None,
) -> Run:
    """A run of frames: time, nodes, cells, velocity and pressure of each; scalars by place."""
    import pyvista

    (path / "fields").mkdir(parents=True)
    sets = ""
    for nth, (time, nodes, cells, velocity, pressure) in enumerate(frames):
        d = nodes.shape[1]
        flat = np.zeros((len(nodes), 3 - d))
        grid = pyvista.UnstructuredGrid({{2: 22, 3: 24}[d]: cells}, np.hstack([nodes, flat]))
        grid.point_data["velocity"] = np.hstack([velocity, flat])
        grid.point_data["pressure"] = pressure
        grid.point_data["vorticity"] = np.zeros(len(nodes)) if d == 2 else np.zeros((len(nodes), 3))
        for name, of_place in (scalars or {}).items():
            grid.point_data[name] = of_place(nodes)
        grid.field_data["TimeValue"] = [time]
        grid.save(path / f"fields/{nth:06}.vtu")
        sets += f'<DataSet timestep="{time}" part="0" file="fields/{nth:06}.vtu"/>'
    (path / "fields.pvd").write_text(
        f'<VTKFile type="Collection" version="1.0"><Collection>{sets}</Collection></VTKFile>\n'
    )
    (path / "case.toml").write_text(top)
    return open_run(path)


def field(nodes: Array, cells: Array, velocity: Array, pressure: Array | None = None) -> Field:
    """A flow that is known at its nodes."""
    zero = np.zeros(len(nodes))
    vorticity = zero if nodes.shape[1] == 2 else np.zeros(nodes.shape)
    return Field(0.0, nodes, cells, velocity, zero if pressure is None else pressure, vorticity)
