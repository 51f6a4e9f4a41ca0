"""One snapshot drawn by matplotlib: cells, curved edges, outlines, streamlines, arrows, bodies."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Ellipse, Polygon
from matplotlib.tri import LinearTriInterpolator, Triangulation

from alewife_post import style
from alewife_post.elements import edge_curves, edges, quarters, refine, subdivide
from alewife_post.read import Field

Array = np.ndarray
View = tuple[float, float, float, float]


def draw_values(
    axes: Axes, field: Field, values: Array, colour_map: str, limits: style.Limits
) -> None:
    """Nodal values `(n_nodes,)` as smooth colours, quadratic in each cell."""
    # Finer than this, a page of many cells shows no difference.
    level = 4 if len(field.cells) < 20_000 else 2
    triangles, weights = subdivide(field.cells, level)
    x, y = refine(field.nodes, field.cells, weights).T
    axes.tripcolor(
        Triangulation(x, y, triangles),
        refine(values, field.cells, weights),
        shading="gouraud",
        cmap=colour_map,
        vmin=limits[0],
        vmax=limits[1],
        rasterized=True,
        zorder=1,
    )


def draw_fluid(axes: Axes, field: Field) -> None:
    """The fluid in one colour."""
    triangles, weights = subdivide(field.cells, 4)
    x, y = refine(field.nodes, field.cells, weights).T
    axes.tripcolor(
        Triangulation(x, y, triangles),
        np.zeros(len(x)),
        shading="gouraud",
        cmap=style.one_colour(style.FLUID),
        rasterized=True,
        zorder=1,
    )


def draw_edges(axes: Axes, field: Field) -> None:
    """Edges of the cells, with their curvature."""
    every, _ = edges(field.cells)
    curves = edge_curves(field.nodes, every)
    axes.add_collection(LineCollection(curves, colors=style.EDGE, linewidths=0.25, zorder=2))


def draw_boundary(axes: Axes, field: Field) -> None:
    """Outline of the fluid."""
    every, is_boundary = edges(field.cells)
    curves = edge_curves(field.nodes, every[is_boundary])
    axes.add_collection(LineCollection(curves, colors=style.BOUNDARY, linewidths=0.7, zorder=4))


def draw_bodies(
    axes: Axes,
    case: dict[str, Any],
    poses: dict[str, tuple[Array, float]],
    field: Field,
) -> None:
    """Bodies, below the fluid so that its edge is theirs; a pose is centre `(2,)` and angle."""
    known = {body["name"]: body for body in case.get("body", [])}
    if any(name not in known or not _keeps_shape(known[name]) for name in poses):
        _draw_holes(axes, case, field)
    for name, body in known.items():
        if not _keeps_shape(body):
            continue
        center, angle = poses[name]
        (kind, shape), *_ = body["shape"].items()
        match kind:
            case "disc" | "sphere":
                semi_axes = [shape["radius"]] * 2
            case "ellipse" | "spheroid":
                semi_axes = shape["semi-axes" if "semi-axes" in shape else "semi_axes"]
            case _:
                turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
                # The pose is that of the centre of mass, the points have an origin of their own.
                outline = smooth_outline(np.array(shape["points"]))
                outline = center + (outline - centroid(outline)) @ turn
                axes.add_patch(Polygon(outline, facecolor=style.BODY, edgecolor="none", zorder=0))
                continue
        width, height = 2 * np.array(semi_axes)
        degrees = np.degrees(angle)
        axes.add_patch(
            Ellipse(center, width, height, angle=degrees, facecolor=style.BODY, zorder=0)
        )


def _keeps_shape(body: dict[str, Any]) -> bool:
    """Whether a body looks as its shape in the case at all times."""
    is_simple = next(iter(body["shape"])) in ("disc", "sphere", "ellipse", "spheroid", "spline")
    return is_simple and next(iter(body.get("gait", {})), "squirmer") == "squirmer"


def _draw_holes(axes: Axes, case: dict[str, Any], field: Field) -> None:
    """What is inside the domain and no fluid: bodies that deform, or were made for a swimmer."""
    if case.get("geometry") == "axisymmetric":
        # Half of the outline of a body ends on the axis; the domain has no sides but straight ones
        # or an arc, and all of it lies below the fluid.
        low, high = field.nodes.min(axis=0), field.nodes.max(axis=0)
        reach = max(abs(low[1]), abs(high[1]))
        if "half-disc" in case.get("domain", {}):
            center = ((low[0] + high[0]) / 2, 0.0)
            patch = Ellipse(center, 2 * reach, 2 * reach, facecolor=style.BODY, zorder=0)
        else:
            corners = [(low[0], -reach), (high[0], -reach), (high[0], reach), (low[0], reach)]
            patch = Polygon(corners, facecolor=style.BODY, edgecolor="none", zorder=0)
        axes.add_patch(patch)
        return
    outlines = boundary_loops(field)
    outer = max(outlines, key=lambda outline: np.prod(np.ptp(outline, axis=0)))
    for outline in outlines:
        if outline is not outer:
            axes.add_patch(Polygon(outline, facecolor=style.BODY, edgecolor="none", zorder=0))


def boundary_loops(field: Field) -> list[Array]:
    """Closed outlines of the fluid, each `(n_points, 2)` along its curved edges."""
    every, is_boundary = edges(field.cells)
    ends = every[is_boundary]
    curves = edge_curves(field.nodes, ends)
    at: dict[int, list[int]] = {}
    for edge, (first, second, *_) in enumerate(ends):
        at.setdefault(int(first), []).append(edge)
        at.setdefault(int(second), []).append(edge)
    left = set(range(len(ends)))
    loops = []
    while left:
        edge = min(left)
        vertex = int(ends[edge][0])
        points = []
        while edge in left:
            left.remove(edge)
            is_forward = int(ends[edge][0]) == vertex
            points.append(curves[edge] if is_forward else curves[edge][::-1])
            vertex = int(ends[edge][1] if is_forward else ends[edge][0])
            edge = next((other for other in at[vertex] if other in left), edge)
        loops.append(np.concatenate(points))
    return loops


def centroid(outline: Array) -> Array:
    """Centre of the area `(2,)` within a closed polygon `(n_points, 2)`."""
    after = np.roll(outline, -1, axis=0)
    crossed = outline[:, 0] * after[:, 1] - after[:, 0] * outline[:, 1]
    return ((outline + after) * crossed[:, None]).sum(axis=0) / (3 * crossed.sum())


def smooth_outline(points: Array, n: int = 16) -> Array:
    """A smooth closed curve through points `(n_points, 2)`, as `(n_points * n, 2)`."""
    before, after, beyond = (np.roll(points, shift, axis=0) for shift in (1, -1, -2))
    s = (np.arange(n) / n)[:, None, None]
    # Cubic of Catmull and Rom: its slope at a point is that of the chord between its neighbours.
    curve = points + 0.5 * s * (
        after
        - before
        + s * (2 * before - 5 * points + 4 * after - beyond)
        + s**2 * (3 * (points - after) + beyond - before)
    )
    return curve.transpose(1, 0, 2).reshape(-1, 2)


def draw_streamlines(axes: Axes, field: Field, view: View, colour: str) -> None:
    """Streamlines with arrow heads, evenly spaced over the view."""
    x, y, velocity = _on_grid(field, view, 240)
    extent = np.array([view[1] - view[0], view[3] - view[2]])
    axes.streamplot(
        x,
        y,
        velocity[..., 0],
        velocity[..., 1],
        density=tuple(1.1 * extent / extent.min() ** 0.5 / extent.max() ** 0.5),
        color=colour,
        linewidth=0.6,
        arrowsize=0.6,
        zorder=3,
    )


def draw_arrows(axes: Axes, field: Field, view: View, colour: str) -> None:
    """Arrows on a regular grid, as long as the speed there."""
    x, y, velocity = _on_grid(field, view, 28)
    axes.quiver(
        x, y, velocity[..., 0], velocity[..., 1], color=colour, width=0.0018, zorder=3, pivot="mid"
    )


def _on_grid(field: Field, view: View, n: int) -> tuple[Array, Array, Array]:
    """Velocity on a regular grid of at most n points a side, masked outside the fluid.

    Returns x `(n_x,)`, y `(n_y,)` and velocity `(n_y, n_x, 2)`.
    """
    x0, x1, y0, y1 = view
    step = max(x1 - x0, y1 - y0) / n
    x = np.linspace(x0, x1, max(4, round((x1 - x0) / step)))
    y = np.linspace(y0, y1, max(4, round((y1 - y0) / step)))
    mesh = Triangulation(*field.nodes.T, quarters(field.cells))
    finder = mesh.get_trifinder()
    grid = np.meshgrid(x, y)
    components = [
        LinearTriInterpolator(mesh, component, trifinder=finder)(*grid)
        for component in field.velocity.T
    ]
    return x, y, np.ma.stack(components, axis=-1)
