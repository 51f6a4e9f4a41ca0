"""Runs of soft cases: the body as it deforms, in the plane, around an axis and in space."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from alewife_post import camera, checked, drawing, movie, scene, style
from alewife_post.elements import edge_curves, edges, refine, subdivide
from alewife_post.read import Frame, Run, read_solid
from alewife_post.request import Request

Array = np.ndarray
View = tuple[float, float, float, float]

QUANTITIES = ("displacement", "strain", "speed", "volume-ratio", "pressure", "mesh")
MARGIN = 0.08
"""Room around the body over the longer side of what it takes."""
SIZE = (6.0, 4.6)
"""Largest width and height of what is drawn (inches)."""
BAR = 1.1
"""Room for the bar of colours (inches)."""
LEFT, BELOW, ABOVE = 0.7, 0.55, 0.4
"""Room for letters around a picture in the plane (inches)."""
LEVEL = 3
"""Pieces of each side of a cell, as it is drawn."""
FINER = 2
"""Pixels of what is rendered over those of a film."""
FACES = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])
"""Nodes of each face of a cell in space, seen from outside: vertices, then those between them."""


@dataclass(frozen=True)
class Body:
    """The body at one time. Nodes are those of quadratic triangles or tetrahedra."""

    time: float
    nodes: Array
    """Places, `(n_nodes, d)`."""
    cells: Array
    """Nodes of each cell, `(n_cells, 6)`, in space `(n_cells, 10)`."""
    rest: Array
    """Places at rest, `(n_nodes, d)`."""
    values: Array | None
    """The quantity that is shown, `(n_nodes,)`; None of the mesh alone."""


@dataclass(frozen=True)
class _Look:
    """What is the same in all pictures of a film."""

    quantity: str
    colour_map: str
    limits: style.Limits
    ends: style.Limits
    view: View | camera.Camera
    is_mirrored: bool


def is_soft(run: Run) -> bool:
    """Whether a run is one of a soft case."""
    return "soft" in run.case


def picture(
    run: Run,
    quantity: str = "displacement",
    *,
    time: float | None = None,
    view: View | None = None,
    look_from: tuple[float, float] | None = None,
    mirror: bool = True,
    scale: style.Scale = style.FREE,
) -> Figure:
    """The body at the frame nearest to `time`, or at the last one, coloured by a quantity.

    `view` is x0, x1, y0, y1 in the plane, `look_from` degrees about z and above the horizon in
    space. Around an axis both sides are shown unless `mirror` is false. The outline at rest is
    grey.
    """
    style.use()
    found = body(run, run.frame_at(time), quantity)
    looks = Request(view=view, camera=look_from, mirror=mirror, scale=scale)
    return _figure(run, found, _look(run, [found], quantity, looks))


def film(run: Run, out: Path, request: Request, report: Callable[[str], None] = print) -> int:
    """Write a film of the body, all frames in one view and one scale; returns how many."""
    out = Path(out)
    movie.check(out)
    _refuse(request)
    quantity = request.quantity or "displacement"
    frames = _chosen(run, request)
    if len(frames) == 1:
        raise ValueError(f"{run.path} has one frame at these times: alewife-post picture draws it")
    fps = request.fps or min(25.0, max(4.0, len(frames) / 5.0))
    style.use()
    bodies = [body(run, frame, quantity) for frame in frames]
    look = _look(run, bodies, quantity, request)
    n = movie.write(out, _images(run, bodies, look), fps)
    first, last = frames[0].time, frames[-1].time
    report(f"{out}: {n} frames of {quantity}, t = {first:.4g} to {last:.4g}, {fps:g} a second")
    return n


def body(run: Run, frame: Frame, quantity: str) -> Body:
    """The body of a field file, with values of a quantity at its nodes."""
    checked.choice("quantity of a soft case", quantity, QUANTITIES)
    solid = read_solid(frame.path)
    if "displacement" not in solid.at_nodes:
        raise ValueError(
            f"{frame.path} has no displacement: an earlier version wrote it; run the case again"
        )
    displacement = solid.at_nodes["displacement"]
    values = None
    if quantity == "displacement":
        values = np.linalg.norm(displacement, axis=1)
    elif quantity == "speed":
        values = np.linalg.norm(solid.at_nodes["velocity"], axis=1)
    elif quantity != "mesh":
        if quantity not in solid.in_cells:
            raise ValueError(
                f"{frame.path} has no {quantity}: there is one where poisson = 0.5 keeps the volume"
            )
        values = _at_nodes(solid.in_cells[quantity], solid.cells, len(solid.nodes))
    return Body(solid.time, solid.nodes, solid.cells, solid.nodes - displacement, values)


def _at_nodes(in_cells: Array, cells: Array, n_nodes: int) -> Array:
    """Means of the values of the cells around each node."""
    sums, counts = np.zeros(n_nodes), np.zeros(n_nodes)
    np.add.at(sums, cells, in_cells[:, None])
    np.add.at(counts, cells, 1.0)
    return sums / np.maximum(counts, 1.0)


def _refuse(request: Request) -> None:
    flows = {
        "--follow": request.follow, "--slice": request.plane, "--surface": request.surface,
        "--iso": request.iso, "--particles": request.particles,
    }  # fmt: skip
    given = [name for name, value in flows.items() if value and value != "none"]
    if given:
        raise ValueError(f"{', '.join(given)}: of runs with a flow; this is one of a soft case")


def _chosen(run: Run, request: Request) -> list[Frame]:
    frames = run.frames
    if request.window is not None:
        start, end = checked.window(request.window)
        frames = [frame for frame in frames if start <= frame.time <= end]
    if not frames:
        raise ValueError(f"{run.path} has no field files at these times")
    n = min(len(frames), max(1, request.frames))
    return [frames[k] for k in np.unique(np.linspace(0, len(frames) - 1, n).round().astype(int))]


def _look(run: Run, bodies: list[Body], quantity: str, request: Request) -> _Look:
    """Colours and view that hold all bodies."""
    colour_map, limits, ends = "viridis", (0.0, 1.0), (0.0, 1.0)
    if quantity != "mesh":
        values = np.concatenate([one.values for one in bodies])
        colour_map, limits = request.scale.colours(quantity, values)
        ends = (float(values.min()), float(values.max()))
    is_mirrored = run.is_axisymmetric and request.mirror
    places = np.concatenate([part for one in bodies for part in (one.nodes, one.rest)])
    if run.is_spatial:
        if not scene.can_render():
            raise ValueError("VTK can have no window here: install libosmesa6")
        towards = scene.direction(request.camera or scene.CAMERA)
        view = camera.camera(towards, places, SIZE[0] / SIZE[1])
    elif request.view is not None:
        view = checked.view(request.view)
    else:
        low, high = places.min(axis=0), places.max(axis=0)
        if is_mirrored:
            low[1] = -high[1]
        room = MARGIN * (high - low).max()
        view = (low[0] - room, high[0] + room, low[1] - room, high[1] + room)
    return _Look(quantity, colour_map, limits, ends, view, is_mirrored)


def _images(run: Run, bodies: list[Body], look: _Look) -> Iterator[Array]:
    for one in bodies:
        figure = _figure(run, one, look)
        # Sides of a film are even
        width, height = (2 * round(0.5 * style.DPI * side) for side in figure.get_size_inches())
        figure.set_dpi(style.DPI)
        figure.set_size_inches(width / style.DPI, height / style.DPI)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _figure(run: Run, shown: Body, look: _Look) -> Figure:
    """A picture whose size follows from its view alone."""
    if isinstance(look.view, camera.Camera):
        inner, margins = np.array(SIZE), np.zeros(2)
    else:
        aspect = (look.view[1] - look.view[0]) / (look.view[3] - look.view[2])
        across = max(min(SIZE[0], aspect * SIZE[1]), 1.0)
        inner, margins = np.array([across, max(across / aspect, 1.0)]), np.array([LEFT, BELOW])
    has_bar = shown.values is not None
    size = inner + margins + np.array([BAR if has_bar else 0.15, ABOVE])
    heading = style.fitted(f"{run.title}, {style.time_text(shown.time, run.units)}", size[0])
    size[1] += 0.15 * heading.count("\n")
    figure = Figure(figsize=tuple(size))
    axes = figure.add_axes((*(margins / size), *(inner / size)))
    if isinstance(look.view, camera.Camera):
        image = _rendered(shown, look, tuple(FINER * (style.DPI * inner).astype(int)))
        axes.imshow(image, extent=(0, 1, 0, 1), aspect="auto", interpolation="antialiased")
        camera.legend(axes, tuple(100 * inner), look.view, run.units)
    else:
        _in_the_plane(axes, run, shown, look)
    if has_bar:
        box = ((margins[0] + inner[0] + 0.12) / size[0], (margins[1] + 0.1 * inner[1]) / size[1])
        beside = figure.add_axes((*box, 0.13 / size[0], 0.8 * inner[1] / size[1]))
        ends = np.array(look.ends)
        bar = drawing.colour_bar(axes, ends, look.colour_map, look.limits, cax=beside)
        bar.set_label(style.label(look.quantity, run.units))
    figure.text(0.5, 1.0 - 0.06 / size[1], heading, ha="center", va="top",
                fontsize=style.PARAMETERS["axes.titlesize"], gid="title")  # fmt: skip
    return figure


def _in_the_plane(axes: Axes, run: Run, shown: Body, look: _Look) -> None:
    every, is_outer = edges(shown.cells)
    for sign in (1.0, -1.0) if look.is_mirrored else (1.0,):
        side = np.array([1.0, sign])
        nodes = shown.nodes * side
        triangles, weights = subdivide(shown.cells, LEVEL)
        mesh = Triangulation(*refine(nodes, shown.cells, weights).T, triangles)
        if shown.values is None:
            one = style.one_colour(style.FLUID)
            drawing.shade(axes, mesh, np.zeros(len(mesh.x)), one)
        else:
            fine = refine(shown.values, shown.cells, weights)
            drawing.shade(axes, mesh, fine, look.colour_map, look.limits)
        rest = edge_curves(shown.rest * side, every[is_outer])
        axes.add_collection(LineCollection(rest, colors=style.ROD, linewidths=0.6, zorder=0.5))
        cells = edge_curves(nodes, every)
        axes.add_collection(LineCollection(cells, colors=style.EDGE, linewidths=0.25, zorder=2))
        outline = edge_curves(nodes, every[is_outer])
        axes.add_collection(
            LineCollection(outline, colors=style.BOUNDARY, linewidths=0.8, zorder=4)
        )
    axes.set_xlim(*look.view[:2])
    axes.set_ylim(*look.view[2:])
    axes.set_xlabel(style.length_label("x", run.units))
    axes.set_ylabel(style.length_label("r" if run.is_axisymmetric else "y", run.units))
    width, height = axes.get_position().size * axes.figure.get_size_inches()
    for axis, inches in ((axes.xaxis, width), (axes.yaxis, height)):
        marks = int(np.clip(1.6 * inches, 2, 8))
        axis.set_major_locator(MaxNLocator(marks, steps=[1, 2, 2.5, 5, 10]))


def skin(cells: Array) -> Array:
    """Flat triangles `(n, 3)` of the surface of cells in space, four of each face of one cell."""
    faces = cells[:, FACES].reshape(-1, 6)
    _, first, counts = np.unique(
        np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = faces[first[counts == 1]]
    return outer[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)


def _rendered(shown: Body, look: _Look, size: tuple[int, int]) -> Array:
    """The surface of a body in space as an image."""
    import pyvista

    triangles = skin(shown.cells)
    surface = pyvista.PolyData.from_regular_faces(shown.nodes, triangles)
    plotter = pyvista.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    how: dict[str, object] = {"color": style.FLUID, "show_edges": True}
    if shown.values is not None:
        surface.point_data["values"] = shown.values
        how = {"scalars": "values", "cmap": look.colour_map, "clim": look.limits}
    surface = surface.compute_normals(feature_angle=40.0, split_vertices=True)
    plotter.add_mesh(surface, show_scalar_bar=False, smooth_shading=True, **how, **style.SOLID)
    rest = pyvista.PolyData.from_regular_faces(shown.rest, triangles)
    lines = rest.extract_feature_edges(feature_angle=40.0, boundary_edges=False)
    if lines.n_points:
        plotter.add_mesh(lines, color=style.ROD, line_width=2.0, lighting=False)
    plotter.enable_anti_aliasing("ssaa")
    look.view.applied(plotter, np.zeros(3))
    image = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    return image
