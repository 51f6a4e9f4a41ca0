"""A scene as a figure: fluid on a plane, bodies, glass sides, streamlines, arrows, names, axes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from alewife_post import bodies, camera, checked, scene, scenery, style
from alewife_post.drawing import colour_bar
from alewife_post.read import Run, check_run
from alewife_post.snapshot import title

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

SIZE = (7.2, 5.2)
"""Inches."""
BAR = 1.05
"""Room for bars of colours (inches)."""
PIXELS = 300
"""To the inch, of what is rendered; lines and letters around it are drawn as such."""
MOST_NAMES = 6
"""Bodies with a name each, at most."""
SHOWN = {scenery.FLUID: "speed", scenery.BODIES: "pressure"}
"""What each part is coloured by."""


def scene_picture(
    run: Run,
    *,
    time: float | None = None,
    look_from: tuple[float, float] | None = None,
    quantity: str = "speed",
    scale: style.Scale = style.FREE,
) -> Figure:
    """A run in space at the frame nearest to `time`, or at the last one.

    The fluid on a plane through the bodies is coloured by its speed or another quantity, bodies by
    the pressure on them. `look_from` is in degrees about z, from x, and above the horizon. `scale`
    is that of the fluid.
    """
    check_run(run, is_spatial=True, instead="figure.picture")
    checked.choice("quantity of a scene", quantity, scenery.quantities_of(run))
    if not scene.can_render():
        raise ValueError("VTK can have no window here: install libosmesa6")
    shown = scenery.scenery(run, time)
    key = (scenery.FLUID, quantity)
    if key in shown.scales:
        usual = shown.scales[key]
        shown.scales[key] = replace(
            usual,
            colour_map=scale.colour_map or usual.colour_map,
            limits=scale.limits or usual.limits,
            is_asked=scale.limits is not None,
        )
    return figure_of(run, shown, look_from=look_from, quantity=quantity)


def figure_of(
    run: Run,
    shown: scenery.Scenery,
    *,
    look_from: tuple[float, float] | None = None,
    quantity: str = "speed",
) -> Figure:
    """The figure of a scene that is known."""
    style.use()
    chosen = {**SHOWN, scenery.FLUID: quantity}
    scales = [
        (part.name, chosen[part.name])
        for part in shown.parts
        if part.name in (scenery.FLUID, scenery.BODIES)
    ]
    figure = Figure(figsize=SIZE)
    heading = style.fitted(title(run, shown.time), 6.0)
    top = 0.25 + 0.15 * heading.count("\n")
    width, height = SIZE[0] - BAR, SIZE[1] - top
    axes = figure.add_axes((0.0, 0.0, width / SIZE[0], height / SIZE[1]))
    towards, up = (shown.towards, shown.up) if look_from is None else scene.direction(look_from)
    seen = np.vstack([part.points for part in shown.parts])
    view = camera.camera((towards, up), seen, width / height)
    image = _rendered(shown, view, chosen, (round(PIXELS * width), round(PIXELS * height)))
    axes.imshow(image, extent=(0, 1, 0, 1), aspect="auto", interpolation="antialiased")
    camera.legend(axes, (100 * width, 100 * height), view, run.units)
    _add_names(axes, run, shown.time, view, width / height)
    figure.text(0.5 * width / SIZE[0], 1.0 - 0.04 / SIZE[1], heading, ha="center", va="top",
                fontsize=style.PARAMETERS["axes.titlesize"], gid="title")  # fmt: skip
    for nth, key in enumerate(scales):
        _add_bar(figure, run, shown.scales[key], key, (nth, len(scales)))
    return figure


def _rendered(
    shown: scenery.Scenery, view: camera.Camera, chosen: dict[str, str], size: tuple[int, int]
) -> Array:
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    for part in shown.parts:
        mesh = _mesh(part)
        name = chosen.get(part.name, "")
        look: dict[str, object] = {"color": part.colour, "opacity": part.opacity}
        if name in part.values:
            scale = shown.scales[part.name, name]
            mesh.point_data["shown"] = part.values[name]
            look = {"scalars": "shown", "cmap": scale.colour_map, "clim": scale.limits}
        if part.cells.shape[1] == 2:
            look |= {"line_width": 2.0, "lighting": False}
        elif part.name == scenery.FLUID or part.opacity < 1.0:
            look |= {"lighting": False}
        else:
            mesh = mesh.compute_normals(feature_angle=40.0, split_vertices=True)
            look |= {"smooth_shading": True, **style.SOLID}
        plotter.add_mesh(mesh, show_scalar_bar=False, **look)
    # Sides of glass are seen through in their order
    plotter.enable_depth_peeling(8)
    plotter.enable_anti_aliasing("ssaa")
    view.applied(plotter, np.zeros(3))
    image = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    return image


def _mesh(part: scenery.Part) -> pyvista.PolyData:
    import pyvista

    if part.cells.shape[1] == 3:
        return pyvista.PolyData.from_regular_faces(part.points, part.cells)
    lines = np.column_stack([np.full(len(part.cells), 2), part.cells]).ravel()
    return pyvista.PolyData(part.points, lines=lines)


def _add_names(axes: Axes, run: Run, time: float, view: camera.Camera, aspect: float) -> None:
    """Names beside bodies, where they are few."""
    placed = bodies.poses(run, time)
    if not 1 < len(placed) <= MOST_NAMES:
        return
    for name, (center, _) in placed.items():
        size = bodies.radius(run, name)
        at = np.array([(center - view.middle) @ view.right, (center - view.middle) @ view.up])
        at = at + size * np.array([0.8, 0.8])
        place = 0.5 + 0.5 * at / (view.scale * np.array([aspect, 1.0]))
        if (np.abs(place - 0.5) < 0.5).all():
            text = axes.text(*place, name, fontsize=8, zorder=30, ha="left", va="bottom")
            text.set_bbox({"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 0.8})


def _add_bar(
    figure: Figure, run: Run, scale: scenery.Scale, key: tuple[str, str], place: tuple[int, int]
) -> None:
    """One of some bars on the right, the first one above."""
    nth, n = place
    part, name = key
    room = 0.9 / n
    box = ((SIZE[0] - BAR + 0.1) / SIZE[0], 0.04 + (n - 1 - nth) * room, 0.016, 0.72 * room)
    axes = figure.add_axes(box)
    values = np.array(scale.ends)
    bar = colour_bar(axes, values, scale.colour_map, scale.limits, cax=axes)
    on = " on bodies" if part == scenery.BODIES else ""
    bar.set_label(style.label(name, run.units) + on)
    note = style.beyond(name, scale.limits, scale.ends, scale.tail)
    if note != style.ALL:
        left_out, _, upto = note.removeprefix("limits leave out ").partition(", up to ")
        left_out = "values" if scale.is_asked else left_out
        axes.text(0.0, 1.06, f"{left_out.replace(' at each end', '')}\nbeyond, to {upto}",
                  transform=axes.transAxes, fontsize=5.5, va="bottom")  # fmt: skip
