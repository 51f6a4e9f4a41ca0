"""The figures: a snapshot with its axes and colour bar; time series with references."""

from __future__ import annotations

from typing import Any, Literal

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from alewife_post import drawing, scene, style
from alewife_post.elements import inside, mirrored
from alewife_post.quantities import speed
from alewife_post.read import Field, Run

Array = np.ndarray
View = tuple[float, float, float, float]
Quantity = Literal["speed", "pressure", "vorticity", "mesh"]
Lines = Literal["streamlines", "arrows", "none"]
Painter = Literal["auto", "vtk", "matplotlib"]

QUANTITIES = ("speed", "pressure", "vorticity", "mesh")
IMAGE_WIDTH = 2400

SMALL_BODY = 0.1
"""A body smaller than this part of the domain is looked at from near."""


def picture(
    run: Run,
    quantity: Quantity = "speed",
    *,
    time: float | None = None,
    view: View | None = None,
    frame: str | None = None,
    lines: Lines | None = None,
    mirror: bool = True,
    painter: Painter = "auto",
) -> Figure:
    """A picture of one quantity at the frame nearest to `time`, or at the last one.

    `view` is x0, x1, y0, y1; without it, all of the domain, or the bodies if they are small in it.
    `frame` names a body whose velocity is subtracted. Speed has streamlines unless `lines` says
    otherwise. An axisymmetric run is shown on both sides of its axis unless `mirror` is false.
    """
    can_render = painter != "matplotlib" and scene.can_render()
    if painter == "auto":
        painter = "vtk" if can_render else "matplotlib"
    elif painter == "vtk" and not can_render:
        raise ValueError("VTK can have no window here: install libosmesa6, or draw by matplotlib")
    style.use()
    field = run.field(time)
    poses, twists = body_states(run, field.time)
    poses = in_mesh(run.case, field, poses)
    velocity = field.velocity - (0.0 if frame is None else twists[frame])
    field = Field(**{**vars(field), "velocity": velocity})
    if run.is_axisymmetric and mirror:
        field = mirrored(field)
    view = view or default_view(run, field, poses)
    field = inside(field, view)
    lines = lines or ("streamlines" if quantity == "speed" else "none")

    units = run.case.get("units", "")
    width, height = _size(view)
    figure = Figure(figsize=(width, height), layout="compressed")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    drawing.draw_bodies(axes, run.case, poses, field)
    is_mesh = quantity == "mesh"
    values = None if is_mesh else nodal_values(field, quantity)
    colour_map, limits = ("viridis", (0.0, 1.0))
    if values is not None:
        colour_map, limits = style.colours(quantity, values[np.unique(field.cells)])
    if painter == "vtk":
        image = scene.render(field, view, IMAGE_WIDTH, values, colour_map, limits, is_mesh)
        axes.imshow(image, extent=view, zorder=1, interpolation="antialiased", aspect="equal")
    else:
        if values is None:
            drawing.draw_fluid(axes, field)
            drawing.draw_edges(axes, field)
        else:
            drawing.draw_values(axes, field, values, colour_map, limits)
    drawing.draw_boundary(axes, field)
    colour = style.STREAMLINE if quantity == "speed" else style.STREAMLINE_ON_LIGHT
    if lines == "streamlines":
        drawing.draw_streamlines(axes, field, view, colour)
    elif lines == "arrows":
        drawing.draw_arrows(axes, field, view, colour)

    axes.set_xlim(view[0], view[1])
    axes.set_ylim(view[2], view[3])
    axes.set_xlabel(style.length_label("x", units))
    axes.set_ylabel(style.length_label("y", units))
    # A flat picture has room for few marks on its short side.
    for axis, inches in ((axes.xaxis, width), (axes.yaxis, height - 0.9)):
        axis.set_major_locator(
            MaxNLocator(int(np.clip(2 * inches, 4, 9)), steps=[1, 2, 2.5, 5, 10])
        )
    is_unsteady = "unsteady" in run.case["time"]
    moment = f", {style.time_text(field.time, units)}" if is_unsteady else ""
    axes.set_title(run.case["title"] + moment)
    if values is not None:
        _colour_bar(axes, values[np.unique(field.cells)], colour_map, limits).set_label(
            style.label(quantity, units) + ("" if frame is None else f" relative to {frame}")
        )
    return figure


def nodal_values(field: Field, quantity: str) -> Array:
    """Values of a quantity at the nodes, `(n_nodes,)`."""
    return speed(field.velocity) if quantity == "speed" else getattr(field, quantity)


def body_states(run: Run, time: float) -> tuple[dict[str, tuple[Array, float]], dict[str, Array]]:
    """Pose (centre `(2,)`, angle) and velocity `(2,)` of each body, from the message nearest."""
    poses, velocities = {}, {}
    for body in run.case.get("body", []):
        if body["name"] not in run.bodies:
            # Nothing was measured: the body is where the case put it.
            name, center = body["name"], np.array([*body["center"], 0.0])[:2]
            poses[name], velocities[name] = (center, body.get("angle", 0.0)), np.zeros(2)
    for name, history in run.bodies.items():
        nearest = int(np.argmin(np.abs(history.time - time)))
        poses[name] = (history.center[nearest, :2], float(history.angle[nearest]))
        velocities[name] = history.velocity[nearest, :2]
    return poses, velocities


def in_mesh(
    case: dict[str, Any], field: Field, poses: dict[str, tuple[Array, float]]
) -> dict[str, tuple[Array, float]]:
    """Poses by whole periods away, where the mesh of a periodic domain has the bodies."""
    ((kind, domain),) = case["domain"].items()
    match kind:
        case "box":
            lengths = np.subtract(domain["max"], domain["min"])
        case "channel":
            lengths = np.array([domain["length"], domain["height"]])
        case "cylinder":
            lengths = np.array([domain["x"][1] - domain["x"][0], np.inf])
        case _:
            return poses
    low = field.nodes.min(axis=0)

    def is_periodic(side: str) -> bool:
        condition = case.get("boundary", {}).get(side)
        return isinstance(condition, dict) and "periodic" in condition

    axes = [axis for axis, side in enumerate(("left", "bottom")) if is_periodic(side)]

    def periods(center: Array) -> Array:
        shift = np.zeros(2)
        for axis in axes:
            shift[axis] = -np.floor((center[axis] - low[axis]) / lengths[axis]) * lengths[axis]
        # The sides of a mesh may be curved: of all images of a body, the nodes around it are
        # nearest to the one in the mesh.
        steps = [(0, 1, -1, 2) if axis in axes else (0,) for axis in range(2)]
        near = [
            shift + np.array([x * lengths[0] if x else 0.0, y * lengths[1] if y else 0.0])
            for y in steps[1]
            for x in steps[0]
        ]
        return min(near, key=lambda by: np.linalg.norm(field.nodes - center - by, axis=1).min())

    return {name: (center + periods(center), angle) for name, (center, angle) in poses.items()}


def default_view(run: Run, field: Field, poses: dict[str, tuple[Array, float]]) -> View:
    """All of the domain, or the surroundings of the bodies if they are small in it."""
    low, high = field.nodes.min(axis=0), field.nodes.max(axis=0)
    radii = [_radius(body["shape"]) for body in run.case.get("body", [])]
    across = (high - low) * [1.0, 2.0 if run.is_axisymmetric and low[1] >= 0.0 else 1.0]
    if radii and 2 * max(radii) < SMALL_BODY * across.min():
        centers = np.array([center for center, _ in poses.values()])
        reach = 4.0 * max(radii) + 0.25 * np.ptp(centers, axis=0).max()
        low = np.maximum(low, centers.min(axis=0) - reach)
        high = np.minimum(high, centers.max(axis=0) + reach)
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def _radius(shape: dict[str, Any]) -> float:
    """Largest distance of a surface from the shape's origin."""
    ((_, values),) = shape.items()
    return max(float(np.abs(np.asarray(value)).max()) for value in values.values())


def _size(view: View) -> tuple[float, float]:
    """Size of the axes (inches)."""
    largest_width, largest_height = style.LARGEST
    aspect = (view[1] - view[0]) / (view[3] - view[2])
    width = min(largest_width, aspect * largest_height)
    # Room for title, labels and a bar below.
    return width + 0.6, width / aspect + 0.9


def _colour_bar(
    axes: Axes, values: Array, colour_map: str, limits: style.Limits
) -> matplotlib.colorbar.Colorbar:
    """A bar beside a tall picture, or below a wide one, never over it."""
    below = bool(values.min() < limits[0] - 1e-12 * abs(limits[0]))
    above = bool(values.max() > limits[1] + 1e-12 * abs(limits[1]))
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[below, above]
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    is_wide = x1 - x0 > 1.4 * (y1 - y0)
    return axes.figure.colorbar(
        ScalarMappable(Normalize(*limits), colour_map),
        ax=axes,
        location="bottom" if is_wide else "right",
        shrink=0.6 if is_wide else 0.85,
        aspect=40 if is_wide else 28,
        pad=0.03,
        extend=extend,
    )


def series_figure(
    run: Run, names: list[str], *, window: tuple[float, float] | None = None
) -> Figure:
    """Quantities over time, one panel each, with the references of the case as bands."""
    style.use()
    missing = [name for name in names if name not in run.series]
    if missing:
        raise KeyError(f"no column {', '.join(missing)}; there are {', '.join(run.series)}")
    time = run.series["time"]
    figure = Figure(figsize=(6.4, 0.7 + 1.9 * len(names)), layout="constrained")
    panels = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for index, (axes, name) in enumerate(zip(panels, names, strict=True)):
        colour = style.SERIES[index % len(style.SERIES)]
        shown = np.ones(len(time), dtype=bool)
        if window is not None:
            shown = (time >= window[0]) & (time <= window[1])
        marker = "o" if shown.sum() < 2 else ""
        axes.plot(time[shown], run.series[name][shown], color=colour, lw=1.0, marker=marker)
        draw_references(axes, run.case, name)
        axes.set_ylabel(name.replace(".", "\n", 1).replace("_", " "))
        axes.margins(x=0.01)
        axes.spines[["top", "right"]].set_visible(False)
    figure.suptitle(run.case["title"], fontsize=style.PARAMETERS["axes.titlesize"])
    panels[-1].set_xlabel("t (s)" if run.case.get("units", "").upper() == "SI" else "t")
    return figure


def draw_references(axes: Axes, case: dict[str, Any], name: str) -> None:
    """The interval each reference allows, over the stretch of time it speaks of."""
    same_unit = {"final", "max", "min", "mean", "at"}
    window = case.get("statistics", {}).get("window")
    drawn = False
    for reference in case.get("reference", []):
        statistic = reference.get("statistic", "final")
        is_of_it = reference["quantity"] == name and "minus" not in reference
        if not is_of_it or statistic not in same_unit:
            continue
        scale = reference.get("per", 1.0)
        value = scale * reference["value"]
        half = abs(scale * reference.get("absolute", 0.0))
        half = half or abs(value) * reference.get("relative", 0.0)
        start, end = window or axes.get_xlim()
        kind = reference.get("kind", "reference")
        label = f"{statistic}, {kind}: {value:.4g} ± {half:.2g} ({reference['source']})"
        axes.fill_between(
            [start, end], value - half, value + half, color=style.REFERENCE, alpha=0.25, lw=0
        )
        axes.plot([start, end], [value, value], color=style.REFERENCE, lw=0.8, ls="--", label=label)
        drawn = True
    if drawn:
        # Above the panel, where no curve can be.
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)
