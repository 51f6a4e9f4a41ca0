"""Sides of a domain by name: which facets of the boundary of the fluid are on each."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np

from alewife_post import bodies
from alewife_post.domains import distances_by_side
from alewife_post.packages import missing
from alewife_post.read import Field, Run

Array = np.ndarray

ON_SIDE = 1e-3
"""Distance from a side over the size of a facet below which the facet is on it."""
GIVEN = "domain.msh"
"""Where a run keeps a mesh that was given."""
PIECES = {"line3": ((0, 2), (2, 1)), "triangle6": ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))}
"""Straight pieces of quadratic facets of a given mesh."""


def is_given(run: Run) -> bool:
    """Whether the domain is a mesh that was given."""
    return "mesh" in run.case["domain"]


def named(run: Run, field: Field, facets: Array) -> Array:
    """Name of the side that each of some facets `(n, k)` is on, `(n,)`; empty where on none.

    Of a given mesh it is the nearest one, by the groups of its file, which meshio reads.
    """
    if is_given(run):
        return _of_given(run, field.nodes[facets])
    found = [_of_domain(run, nodes, facets) for nodes in _seen_by_sides(run, field)]
    # Which frame the domain has is told by what lies on its sides
    best = max(found, key=lambda names: (names != "").sum())
    return _with_the_rest(run, best, field.nodes[facets])


def why_nameless(run: Run) -> str:
    """What sides without names need to have them; empty where nothing helps."""
    if is_given(run) and _file(run).is_file():
        try:
            import meshio  # noqa: F401
        except ImportError:
            return f"; names of a mesh that was given need more: {missing('meshio')}"
    return ""


def _seen_by_sides(run: Run, field: Field) -> list[Array]:
    """Nodes `(n, d)` as they are, and where the domain travels with a body as it was at first."""
    frame = run.members.frame
    if frame not in run.bodies:
        return [field.nodes]
    start, now = (bodies.poses(run, time)[frame] for time in (0.0, field.time))
    d = field.nodes.shape[1]
    away = field.nodes - now[0][:d]
    turned = away @ now[1][:d, :d] @ start[1][:d, :d].T
    return [away + start[0][:d], turned + start[0][:d], field.nodes]


def _of_domain(run: Run, nodes: Array, facets: Array) -> Array:
    names = np.full(len(facets), "", dtype=object)
    size = np.ptp(nodes[facets], axis=1).max(axis=1, initial=0.0)
    least = ON_SIDE * size
    for name, distance in distances_by_side(run.case, nodes).items():
        away = np.abs(distance[facets]).max(axis=1, initial=0.0)
        names[away < least] = name
        least = np.where(away < least, away, least)
    return names


def _with_the_rest(run: Run, names: Array, places: Array) -> Array:
    """A side that waves is on no straight line: what is left of the outer boundary is that one."""
    conditions = run.case.get("boundary", {})
    waving = [
        side
        for side, condition in conditions.items()
        if isinstance(condition, dict) and "waving-sheet" in condition and not (names == side).any()
    ]
    if len(waving) == 1 and not run.case.get("body") and len(places):
        names[names == ""] = waving[0]
    return names


def _file(run: Run) -> Path:
    return run.path / GIVEN


def _of_given(run: Run, places: Array) -> Array:
    """Names by the nearest facet of the given mesh of each middle of facets `(n, k, d)`."""
    import pyvista

    known = _groups(_file(run), run.case["domain"]["mesh"].get("scale", 1.0)) if len(places) else ()
    if not known:
        return np.full(len(places), "", dtype=object)
    points, pieces, owner, groups = known
    k = pieces.shape[1]
    kind = pyvista.CellType.LINE if k == 2 else pyvista.CellType.TRIANGLE
    grid = pyvista.UnstructuredGrid({kind: pieces}, points)
    middles = np.zeros((len(places), 3))
    # Nodes on the side itself: of edges the one between, of triangles the mean of such
    middles[:, : places.shape[2]] = places[:, k:].mean(axis=1)
    nearest = np.atleast_1d(grid.find_closest_cell(middles))
    return np.array([groups[number] for number in owner[nearest]], dtype=object)


@lru_cache(2)
def _groups(path: Path, scale: float) -> tuple:
    """Points, straight pieces of boundary facets, the group of each, and names of groups.

    Empty where there is no file, or no meshio to read it.
    """
    try:
        import meshio
    except ImportError:
        return ()
    if not path.is_file():
        return ()
    mesh = meshio.read(path)
    is_flat = not any(cells.type.startswith("tetra") for cells in mesh.cells)
    d = 1 if is_flat else 2
    names = {int(number): name for name, (number, of) in mesh.field_data.items() if of == d}
    pieces, owner = [], []
    for nth, cells in enumerate(mesh.cells):
        if not cells.type.startswith("line" if is_flat else "triangle"):
            continue
        groups = mesh.cell_data.get("gmsh:physical", [np.zeros(len(one)) for one in mesh.cells])
        patterns = PIECES.get(cells.type, (tuple(range(d + 1)),))
        for pattern in patterns:
            pieces.append(cells.data[:, pattern])
            owner.append(np.asarray(groups[nth], dtype=int))
    if not pieces:
        return ()
    owner = np.concatenate(owner)
    texts = {int(number): names.get(int(number), str(number)) for number in np.unique(owner)}
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = scale * mesh.points
    return points, np.concatenate(pieces), owner, texts
