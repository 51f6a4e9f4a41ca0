"""One snapshot drawn by matplotlib: cells, curved edges, outlines, streamlines, arrows, bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import BoundaryNorm, Colormap, Normalize
from matplotlib.patches import Ellipse, FancyArrow, PathPatch, Polygon, Rectangle
from matplotlib.path import Path
from matplotlib.tri import LinearTriInterpolator, Triangulation
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from alewife_post import style
from alewife_post.bodies import Heading, Pose
from alewife_post.domains import domain_view, periods
from alewife_post.elements import edge_curves, edges, quarters, refine, subdivide
from alewife_post.messages import Shape, rotation_matrix
from alewife_post.periodic import is_joined
from alewife_post.read import Field
from alewife_post.streamlines import HEAD, Streamlines
from alewife_post.units import Given, units_of

Array = np.ndarray
View = tuple[float, float, float, float]

EMPTY = 0.3
"""Corners that are so far from all bodies, over the longer side of a view, are equally good."""


def draw_values(
    axes: Axes,
    field: Field,
    values: Array,
    colour_map: str,
    limits: style.Limits,
    contours: int = 0,
) -> None:
    """Nodal values `(n_nodes,)` as smooth colours, quadratic in each cell, or as bands."""
    # Finer than this, a page of many cells shows no difference.
    level = 4 if len(field.cells) < 20_000 else 2
    triangles, weights = subdivide(field.cells, level)
    x, y = refine(field.nodes, field.cells, weights).T
    mesh, fine = Triangulation(x, y, triangles), refine(values, field.cells, weights)
    if contours:
        fill(axes, mesh, fine, (colour_map, limits), contours)
    else:
        shade(axes, mesh, fine, colour_map, limits)


def fill(
    axes: Axes, mesh: Triangulation, values: Array, colours: tuple[str, style.Limits], n: int
) -> None:
    """Values at corners of triangles as bands of one colour each, as areas and not an image."""
    colour_map, limits = colours
    low, high = values.min() < limits[0], values.max() > limits[1]
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[low, high]
    ends = np.linspace(*limits, n + 1)
    norm = BoundaryNorm(ends, colormaps[colour_map].N, extend=extend)
    drawn = axes.tricontourf(
        mesh, values, ends, cmap=colour_map, norm=norm, extend=extend, zorder=1
    )
    # Without seams between areas
    drawn.set_edgecolor("face")
    drawn.set_linewidth(0.1)


def draw_outline(
    axes: Axes, curves: Array, values: Array, colour_map: str, limits: style.Limits
) -> None:
    """Curves `(n, k, 2)` in colours by values `(n, k)` along them."""
    pieces = np.stack([curves[:, :-1], curves[:, 1:]], axis=2).reshape(-1, 2, 2)
    lines = LineCollection(
        pieces, cmap=colour_map, norm=Normalize(*limits), linewidths=3.0, zorder=5,
        capstyle="round",
    )  # fmt: skip
    lines.set_array(0.5 * (values[:, :-1] + values[:, 1:]).ravel())
    axes.add_collection(lines)


def draw_fluid(axes: Axes, field: Field) -> None:
    """The fluid in one colour."""
    triangles, weights = subdivide(field.cells, 4)
    x, y = refine(field.nodes, field.cells, weights).T
    one = style.one_colour(style.FLUID)
    shade(axes, Triangulation(x, y, triangles), np.zeros(len(x)), one)


def shade(
    axes: Axes,
    triangles: Triangulation,
    values: Array,
    colour_map: str | Colormap,
    limits: style.Limits | None = None,
) -> None:
    """Values at corners of triangles as smooth colours, below all else."""
    low, high = limits or (None, None)
    axes.tripcolor(
        triangles,
        values,
        shading="gouraud",
        cmap=colour_map,
        vmin=low,
        vmax=high,
        rasterized=True,
        zorder=1,
    )


def draw_edges(axes: Axes, field: Field) -> None:
    """Edges of the cells, with their curvature."""
    every, _ = edges(field.cells)
    curves = edge_curves(field.nodes, every)
    axes.add_collection(LineCollection(curves, colors=style.EDGE, linewidths=0.25, zorder=2))


def draw_boundary(axes: Axes, field: Field, periods: Array, shifts: Array) -> None:
    """Outline of the fluid at some shifts, without sides joined to others a period `(2,)` away."""
    every, is_boundary = edges(field.cells)
    found = every[is_boundary]
    if periods.any():
        found = found[~is_joined(field.nodes[found[:, 2]], periods)]
    curves = edge_curves(field.nodes, found)
    for shift in shifts:
        lines = LineCollection(curves + shift, colors=style.BOUNDARY, linewidths=0.7, zorder=4)
        axes.add_collection(lines)


def draw_shape(axes: Axes, seen: Shape, pose: Pose, colour: str, zorder: float = 0.0) -> None:
    """A body that keeps its shape, placed in the plane."""
    center, turn = pose
    for solid in seen.solids:
        own = turn @ rotation_matrix(solid.rotation)
        degrees = np.degrees(np.arctan2(own[1, 0], own[0, 0]))
        at = center + turn @ solid.position
        width, height = solid.size[:2]
        axes.add_patch(
            Ellipse(at[:2], width, height, angle=degrees, facecolor=colour, zorder=zorder)
        )
    for line in seen.lines:
        outline = center[:2] + line @ turn[:2, :2].T
        axes.add_patch(Polygon(outline, facecolor=colour, edgecolor="none", zorder=zorder))


def draw_holes(axes: Axes, case: dict[str, Any], field: Field, shifts: Array) -> None:
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
        if outline is outer:
            continue
        for shift in shifts:
            shown = outline + shift
            axes.add_patch(Polygon(shown, facecolor=style.BODY, edgecolor="none", zorder=0))


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


def draw_arrows(axes: Axes, x: Array, y: Array, velocity: Array, colour: str) -> None:
    """Arrows on a regular grid, as `on_grid` has it, as long as the speed there."""
    axes.quiver(
        x, y, velocity[..., 0], velocity[..., 1], color=colour, width=0.0018, zorder=3, pivot="mid"
    )


def on_grid(flow: list[Field], view: View, n: int) -> tuple[Array, Array, Array]:
    """Velocity on a regular grid of at most n points a side, masked outside the fluid.

    Returns x `(n_x,)`, y `(n_y,)` and velocity `(n_y, n_x, 2)`.
    """
    x0, x1, y0, y1 = view
    step = max(x1 - x0, y1 - y0) / n
    x = np.linspace(x0, x1, max(4, round((x1 - x0) / step)))
    y = np.linspace(y0, y1, max(4, round((y1 - y0) / step)))
    grid = np.meshgrid(x, y)
    found = np.ma.masked_array(np.zeros((len(y), len(x), 2)), mask=True)
    for field in flow:
        mesh = Triangulation(*field.nodes.T, quarters(field.cells))
        finder = mesh.get_trifinder()
        components = [
            LinearTriInterpolator(mesh, component, trifinder=finder)(*grid)
            for component in field.velocity.T
        ]
        values = np.ma.stack(components, axis=-1)
        is_here = ~np.ma.getmaskarray(values)
        found[is_here] = values[is_here]
    return x, y, found


def draw_scale_bar(axes: Axes, view: View, units: Given, taken: Sequence[Array] = ()) -> None:
    """A round length, where the axes have no marks or the case names its unit.

    It lies in a corner that is far from places `(n, 2)` that are taken.
    """
    if units_of(units).length is None and axes.axison:
        return
    width, height = view[1] - view[0], view[3] - view[2]
    length = style.round_length(0.2 * width)
    bar = AnchoredSizeBar(
        axes.transData,
        length,
        style.length_text(length, units),
        loc=_empty_corner(view, taken),
        pad=0.35,
        borderpad=0.4,
        sep=3.0,
        size_vertical=0.004 * max(width, height),
        color=style.BOUNDARY,
    )
    bar.patch.set(facecolor="white", alpha=0.8, lw=0)
    bar.set_zorder(20)
    axes.add_artist(bar)


def _empty_corner(view: View, taken: Sequence[Array]) -> str:
    x0, x1, y0, y1 = view
    corners = {"lower right": (x1, y0), "lower left": (x0, y0), "upper right": (x1, y1)}
    if len(taken) == 0:
        return "lower right"
    size = max(x1 - x0, y1 - y0)
    places = np.array([place[:2] for place in taken])

    def nearest(corner: str) -> float:
        away = np.linalg.norm(places - corners[corner], axis=1).min() / size
        # The first corner unless there is a body in it
        return min(float(away), EMPTY)

    return max(corners, key=nearest)


def draw_rod(axes: Axes, points: Array, zorder: float = 4.5) -> None:
    """An arm or a pivot between bodies."""
    axes.plot(*points[:, :2].T, color=style.ROD, lw=1.8, zorder=zorder, solid_capstyle="round")


def draw_heading(axes: Axes, heading: Heading) -> None:
    """An arrow along which something swims."""
    length = float(np.linalg.norm(heading.vector[:2]))
    if length == 0.0:
        return
    axes.add_patch(
        FancyArrow(
            *heading.start[:2],
            *heading.vector[:2],
            width=0.12 * length,
            head_width=0.4 * length,
            head_length=0.4 * length,
            length_includes_head=True,
            facecolor=style.ARROW_IN_BODY if heading.is_inside else style.ARROW,
            edgecolor="none",
            zorder=6,
        )
    )


def draw_trail(axes: Axes, pieces: list[Array]) -> None:
    """The way of a centre."""
    for points in pieces:
        axes.plot(*points[:, :2].T, color=style.TRAIL, lw=1.0, alpha=0.9, zorder=5.5)


def draw_domain(axes: Axes, case: dict[str, Any], view: View) -> None:
    """The sides of a domain where there is no mesh to show them; a periodic one has none."""
    whole = domain_view(case)
    if whole is None:
        return
    lengths = periods(case)
    # A period beyond what is seen on each side
    sides = [
        (view[2 * k] - lengths[k], view[2 * k + 1] + lengths[k])
        if lengths[k] > 0
        else whole[2 * k : 2 * k + 2]
        for k in range(2)
    ]
    (x0, x1), (y0, y1) = sides
    look = {"facecolor": style.FLUID, "edgecolor": style.BOUNDARY, "lw": 1.2, "zorder": -1}
    if next(iter(case["domain"])) in ("disc", "half-disc"):
        center = (0.5 * (x0 + x1), 0.5 * (y0 + y1))
        axes.add_patch(Ellipse(center, x1 - x0, y1 - y0, **look))
    else:
        axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, **look))


def draw_streamlines(
    axes: Axes, found: Streamlines, view: View, colour: str, zorder: float = 3.0
) -> None:
    """Draw streamlines with their arrow heads."""
    axes.add_collection(
        LineCollection(found.lines, colors=colour, linewidths=0.6, zorder=zorder, capstyle="round")
    )
    size = HEAD * max(view[1] - view[0], view[3] - view[2])
    across = found.directions @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    middle = found.heads - 0.5 * size * found.directions
    corners = [
        middle + size * found.directions,
        middle + 0.38 * size * across,
        middle - 0.38 * size * across,
    ]
    if len(found.heads):
        triangles = np.stack([*corners, corners[0]], axis=1)
        codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY] * len(triangles)
        path = Path(triangles.reshape(-1, 2), codes)
        axes.add_patch(PathPatch(path, facecolor=colour, edgecolor="none", zorder=zorder))


def draw_particles(
    axes: Axes, lines: list[Array], heads: Array, colour: str, *, is_mirrored: bool
) -> None:
    """Streak lines or tails, and particles, `(n, 3)`; of a flow about an axis on both sides."""
    for sign in (1.0, -1.0) if is_mirrored else (1.0,):
        for line in lines:
            axes.plot(line[:, 0], sign * line[:, 1], color=colour, lw=0.7, zorder=6.2)
        axes.plot(heads[:, 0], sign * heads[:, 1], ".", color=colour, ms=2.5, zorder=6.3, mew=0.0)


def colour_bar(
    axes: Axes | list[Axes],
    values: Array,
    colour_map: str,
    limits: style.Limits,
    *,
    cax: Axes | None = None,
    is_beside: bool = False,
    alpha: float = 1.0,
    contours: int = 0,
) -> Colorbar:
    """A bar in axes of its own, else beside a tall picture, or below a wide one, never over it.

    Of several pictures it is one for all.
    """
    least = 1e-6 * (limits[1] - limits[0])
    below = bool(values.min() < limits[0] - least)
    above = bool(values.max() > limits[1] + least)
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[below, above]
    norm = Normalize(*limits)
    if contours:
        ends = np.linspace(*limits, contours + 1)
        norm = BoundaryNorm(ends, colormaps[colour_map].N, extend=extend)
    mappable = ScalarMappable(norm, colour_map)
    if cax is not None:
        box = cax.get_position()
        width, height = axes.figure.get_size_inches() * (box.width, box.height)
        orientation = "horizontal" if width > height else "vertical"
        return axes.figure.colorbar(
            mappable, cax=cax, extend=extend, orientation=orientation, alpha=alpha
        )
    every = axes if isinstance(axes, list) else [axes]
    (x0, x1), (y0, y1) = every[0].get_xlim(), every[0].get_ylim()
    is_wide = x1 - x0 > 1.4 * abs(y1 - y0) and not is_beside
    return every[0].figure.colorbar(
        mappable,
        ax=axes,
        location="bottom" if is_wide else "right",
        shrink=0.6 if is_wide else 0.85,
        aspect=40 if is_wide else 28,
        pad=0.03,
        extend=extend,
    )
