"""Pictures of runs in space: a slice with streamlines, and bodies with what acts on them."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from alewife_post import scene, style
from alewife_post.quantities import speed
from alewife_post.read import QUADRATIC_TETRAHEDRON, Field, Run

Array = np.ndarray
View = tuple[float, float, float, float]
Camera = tuple[float, float]

AXES = "xyz"
POINTS = 400
"""Points on the longer side of a slice."""
TETRAHEDRON = 10
"""VTK's number of a cell with straight sides."""
PIECES = np.array(
    [
        [0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3],
        [4, 5, 6, 8], [4, 6, 7, 8], [6, 9, 7, 8], [5, 9, 6, 8],
    ]
)  # fmt: skip
"""Nodes of the pieces of a quadratic tetrahedron: its corners, and what is left about edge 6-8."""
ON_SIDE = 1e-5
"""Distance from a side over the size of the domain below which a node is on it."""
SUBDIVISION = 3
IMAGE_SIZE = (1600, 1200)
NEAR = 3.0
"""Reach of bodies over which their surroundings are shown."""


def slice_picture(
    run: Run,
    quantity: str = "speed",
    *,
    time: float | None = None,
    plane: str | None = None,
    view: View | None = None,
    lines: str = "streamlines",
) -> Figure:
    """A quantity on a plane such as `z=0.5`, with the streamlines of the velocity in the plane.

    Without `plane` it is across z, through the middle of the first body. `view` is in the two
    coordinates of the plane; without it, the surroundings of the bodies.
    """
    style.use()
    field = run.field(time)
    low, high = field.nodes.min(axis=0), field.nodes.max(axis=0)
    axis, height = _plane(run, plane, 0.5 * (low + high))
    if not low[axis] < height < high[axis]:
        reach = f"{low[axis]:.6g} to {high[axis]:.6g}"
        raise ValueError(f"{AXES[axis]} = {height:.6g} is outside the domain: {reach}")
    across = [other for other in range(3) if other != axis]
    view = view or _surroundings(run, field, across)
    x, y = _grid_lines(view)
    at = np.zeros((len(y), len(x), 3))
    at[..., across[0]], at[..., across[1]], at[..., axis] = x[None, :], y[:, None], height
    found = sample(field, at.reshape(-1, 3), quantity)
    shape = (len(y), len(x))
    values = found["values"].reshape(shape)
    velocity = found["velocity"].reshape(*shape, 3)[..., across]

    width = min(style.LARGEST[0], style.LARGEST[1] * (view[1] - view[0]) / (view[3] - view[2]))
    size = (width + 1.2, width * (view[3] - view[2]) / (view[1] - view[0]) + 0.9)
    figure = Figure(figsize=size, layout="compressed")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.set_facecolor(style.BODY)
    colour_map, limits = style.colours(quantity, values.compressed())
    axes.imshow(
        values, extent=view, origin="lower", cmap=colour_map, vmin=limits[0], vmax=limits[1]
    )
    if lines == "streamlines" and np.abs(velocity).max() > 0:
        colour = style.STREAMLINE if quantity == "speed" else style.STREAMLINE_ON_LIGHT
        axes.streamplot(
            x, y, velocity[..., 0], velocity[..., 1], color=colour, linewidth=0.6, arrowsize=0.6
        )
    for section in sections(run, field, axis, height):
        axes.fill(*section[:, across].T, color=style.BODY, zorder=3)
    units = run.case.get("units", "")
    axes.set_xlim(view[0], view[1])
    axes.set_ylim(view[2], view[3])
    axes.set_xlabel(style.length_label(AXES[across[0]], units))
    axes.set_ylabel(style.length_label(AXES[across[1]], units))
    axes.set_title(f"{run.case['title']}, {AXES[axis]} = {height:.4g}")
    bar = figure.colorbar(ScalarMappable(Normalize(*limits), colour_map), ax=axes, shrink=0.85)
    bar.set_label(style.label(quantity, units))
    return figure


def surface_picture(
    run: Run,
    quantity: str = "pressure",
    *,
    time: float | None = None,
    camera: Camera = (-50.0, 20.0),
) -> Figure:
    """The bodies, coloured by a quantity on their surfaces.

    `camera` is where it is looked from: degrees about z, from x, and above the horizon.
    """
    if not scene.can_render():
        raise ValueError("VTK can have no window here: install libosmesa6")
    style.use()
    field = run.field(time)
    surface = bodies_surface(run, field, quantity)
    values = np.asarray(surface.point_data["values"])
    colour_map, limits = style.colours(quantity, values)
    image = scene.render_surface(surface, IMAGE_SIZE, camera, colour_map, limits)
    figure = Figure(figsize=(7.2, 5.0), layout="compressed")
    axes = figure.add_subplot()
    axes.imshow(image)
    axes.set_axis_off()
    axes.set_title(run.case["title"])
    bar = figure.colorbar(ScalarMappable(Normalize(*limits), colour_map), ax=axes, shrink=0.85)
    bar.set_label(style.label(quantity, run.case.get("units", "")))
    return figure


def sample(field: Field, points: Array, quantity: str) -> dict[str, Array]:
    """Values and velocity at points `(n, 3)`, masked outside the fluid."""
    import pyvista

    # VTK looks for points in curved cells by iterations that end early: eight straight pieces of
    # each cell, with its nodes, are as good in a picture
    grid = _grid(field, quantity)
    pieces = field.cells[:, PIECES].reshape(-1, 4)
    straight = pyvista.UnstructuredGrid({TETRAHEDRON: pieces}, field.nodes)
    for name in ("values", "velocity"):
        straight.point_data[name] = grid.point_data[name]
    found = pyvista.PolyData(points).sample(straight)
    is_outside = np.asarray(found.point_data["vtkValidPointMask"]) == 0
    velocity = np.asarray(found.point_data["velocity"])
    return {
        "values": np.ma.masked_array(found.point_data["values"], is_outside),
        "velocity": np.ma.masked_array(velocity, np.repeat(is_outside[:, None], 3, axis=1)),
    }


def sections(run: Run, field: Field, axis: int, height: float) -> list[Array]:
    """Curves `(n, 3)` in which a plane cuts the bodies."""
    try:
        surface = bodies_surface(run, field, "pressure")
    except ValueError:
        return []
    origin = [height if own == axis else 0.0 for own in range(3)]
    cut = surface.slice(normal=AXES[axis], origin=origin)
    if cut.n_cells == 0:
        return []
    strips = cut.strip(join=True)
    points, lines = np.asarray(strips.points), strips.lines
    found, start = [], 0
    while start < len(lines):
        n = lines[start]
        found.append(points[lines[start + 1 : start + 1 + n]])
        start += n + 1
    return found


def bodies_surface(run: Run, field: Field, quantity: str):  # noqa: ANN201  (loads VTK)
    """The surface of the fluid without the sides of the domain, with nodal `values`."""
    grid = _grid(field, quantity)
    sides = distances_to_sides(run.case, field.nodes)
    extent = np.ptp(field.nodes, axis=0).max()
    if sides.shape[1] > 0:
        grid.point_data["side"] = (np.abs(sides) < ON_SIDE * extent).astype(float)
    surface = grid.extract_surface(nonlinear_subdivision=SUBDIVISION, algorithm="dataset_surface")
    if sides.shape[1] == 0:
        surface = surface.connectivity("all")
    cells = surface.faces.reshape(-1, 4)[:, 1:]
    if sides.shape[1] == 0:
        is_on_side = _is_on_largest_part(surface)[cells[:, 0]]
    else:
        # One number a node where the domain has a single side
        side = np.asarray(surface.point_data["side"]).reshape(surface.n_points, -1)
        is_on_side = (side[cells] > 0.5).all(axis=1).any(axis=-1)
    kept = surface.extract_cells(np.flatnonzero(~is_on_side)).extract_surface(
        algorithm="dataset_surface"
    )
    if kept.n_cells == 0:
        raise ValueError("there is no body in this run: draw a slice")
    return kept


def _is_on_largest_part(surface) -> Array:  # noqa: ANN001  (VTK)
    """Whether each point of a surface is on its part of the largest extent, the outer one."""
    part = np.asarray(surface.point_data["RegionId"])
    points = np.asarray(surface.points)
    extents = [np.ptp(points[part == index], axis=0).max() for index in range(part.max() + 1)]
    return part == np.argmax(extents)


def distances_to_sides(case: dict[str, Any], nodes: Array) -> Array:
    """Distance of each node from each side of the domain, `(n_nodes, n_sides)`.

    The sides of an imported mesh are not known: it has none here.
    """
    ((kind, domain),) = case["domain"].items()
    match kind:
        case "box":
            return np.hstack([nodes - domain["min"], nodes - domain["max"]])
        case "cylinder":
            off_axis = np.hypot(nodes[:, 1], nodes[:, 2]) - domain["radius"]
            ends = nodes[:, :1] - np.asarray(domain["x"])
            return np.column_stack([ends, off_axis])
        case "sphere":
            off = nodes - domain.get("center", [0.0, 0.0, 0.0])
            return np.linalg.norm(off, axis=1, keepdims=True) - domain["radius"]
        case "mesh":
            return np.empty((len(nodes), 0))
        case _:
            raise ValueError(f"a {kind} is no domain in space")


def _grid(field: Field, quantity: str):  # noqa: ANN202  (loads VTK)
    import pyvista

    grid = pyvista.UnstructuredGrid({QUADRATIC_TETRAHEDRON: field.cells}, field.nodes)
    grid.point_data["velocity"] = field.velocity
    grid.point_data["values"] = nodal_values(field, quantity)
    return grid


def nodal_values(field: Field, quantity: str) -> Array:
    """Values of a quantity at the nodes, `(n_nodes,)`; of the vorticity its magnitude."""
    match quantity:
        case "speed":
            return speed(field.velocity)
        case "vorticity":
            return speed(field.vorticity)
        case "pressure":
            return field.pressure
        case _:
            raise ValueError(f"{quantity} is not drawn in space: speed, pressure or vorticity")


def outer_surface(field: Field):  # noqa: ANN201  (loads VTK)
    """The outer part of the surface of the fluid: the sides of its domain."""
    grid = _grid(field, "speed")
    surface = grid.extract_surface(nonlinear_subdivision=2, algorithm="dataset_surface")
    surface = surface.connectivity("all")
    cells = surface.faces.reshape(-1, 4)[:, 1:]
    kept = np.flatnonzero(_is_on_largest_part(surface)[cells[:, 0]])
    return surface.extract_cells(kept).extract_surface(algorithm="dataset_surface")


def _plane(run: Run, plane: str | None, middle: Array) -> tuple[int, float]:
    """Axis and position of a plane written as `z=0.5`."""
    if plane is None:
        center = next(iter(_centers(run)), middle)
        return 2, float(center[2])
    found = re.fullmatch(r"\s*([xyz])\s*=\s*([-+0-9.eE]+)\s*", plane)
    if not found:
        raise ValueError(f"{plane} is not a plane: write one such as z=0.5")
    return AXES.index(found[1]), float(found[2])


def _centers(run: Run) -> list[Array]:
    return [history.center[-1] for history in run.bodies.values()]


def _surroundings(run: Run, field: Field, across: list[int]) -> View:
    """The part of the domain around the bodies, in the coordinates of a slice."""
    low, high = field.nodes.min(axis=0), field.nodes.max(axis=0)
    extent = np.ptp(field.nodes, axis=0).max()
    sides = (np.abs(distances_to_sides(run.case, field.nodes)) < ON_SIDE * extent).any(axis=1)
    boundary = np.unique(_boundary_nodes(field.cells))
    on_bodies = field.nodes[boundary[~sides[boundary]]]
    if len(on_bodies):
        middle = 0.5 * (on_bodies.min(axis=0) + on_bodies.max(axis=0))
        reach = NEAR * 0.5 * np.ptp(on_bodies, axis=0).max()
        low, high = np.maximum(low, middle - reach), np.minimum(high, middle + reach)
    a, b = across
    return (low[a], high[a], low[b], high[b])


def _boundary_nodes(cells: Array) -> Array:
    """Vertices of the faces that only one cell has, `(n_faces, 3)`."""
    faces = np.sort(cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    unique, counts = np.unique(faces, axis=0, return_counts=True)
    return unique[counts == 1]


def _grid_lines(view: View) -> tuple[Array, Array]:
    """Coordinates of a regular grid over a view."""
    width, height = view[1] - view[0], view[3] - view[2]
    n = [max(2, round(POINTS * side / max(width, height))) for side in (width, height)]
    return np.linspace(view[0], view[1], n[0]), np.linspace(view[2], view[3], n[1])
