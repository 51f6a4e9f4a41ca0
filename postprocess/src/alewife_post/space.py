"""Runs in space: pictures of bodies with what acts on them, and what they swim along."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from alewife_post import bodies, derived, drawing, facets, scene, skins, style, surfaces, traction
from alewife_post.domains import domain_box
from alewife_post.drawing import colour_bar
from alewife_post.periodic import shifts
from alewife_post.read import Field, Run, check_run
from alewife_post.recovered import smooth_pressure
from alewife_post.sections import sample, sections, side_sections
from alewife_post.snapshot import title

if TYPE_CHECKING:
    import pyvista

__all__ = ["motion", "sample", "sections", "side_sections", "surface_picture"]

Array = np.ndarray
Camera = tuple[float, float]

IMAGE_SIZE = (1600, 1200)
BELOW = 0.09
"""Room for the scale of lengths over the longer side of a picture of bodies."""


def surface_picture(
    run: Run,
    quantity: str = "pressure",
    *,
    time: float | None = None,
    camera: Camera = scene.CAMERA,
    on: Sequence[str] = (),
    scale: style.Scale = style.FREE,
) -> Figure:
    """The bodies, coloured by a quantity on their surfaces; without any the sides of the domain.

    `on` names bodies and sides that are shown instead. `camera` is where it is looked from: degrees
    about z, from x, and above the horizon. `scale` has limits and a map of colours.
    """
    check_run(run, is_spatial=True, instead="figure.picture")
    if not scene.can_render():
        raise ValueError("VTK can have no window here: install libosmesa6")
    style.use()
    surface, field = _shown(run, quantity, time, on)
    sized = surface.compute_cell_sizes(length=False, volume=False)
    values = np.asarray(sized.point_data_to_cell_data().cell_data["values"])
    colour_map, limits = scale.colours(quantity, values, np.asarray(sized.cell_data["Area"]))
    extent = float(np.ptp(np.asarray(surface.points), axis=0).max())
    image, pixel = scene.render_surface(
        (surface, [] if on else motion(run, field.time, extent)),
        IMAGE_SIZE,
        camera,
        colour_map,
        limits,
    )
    figure = Figure(figsize=(7.2, 5.0), layout="compressed")
    axes = figure.add_subplot()
    width, height = pixel * image.shape[1], pixel * image.shape[0]
    axes.imshow(image, extent=(0.0, width, 0.0, height))
    axes.set_axis_off()
    # The scale lies below, not on what is shown.
    below = BELOW * max(width, height)
    axes.set_ylim(-below, height)
    drawing.draw_scale_bar(axes, (0.0, width, -below, height), run.units)
    axes.set_title(style.fitted(title(run, field.time), 6.0))
    bar = colour_bar(axes, values, colour_map, limits, is_beside=True)
    bar.set_label(style.label(quantity, run.units))
    return figure


def _shown(
    run: Run, quantity: str, time: float | None, on: Sequence[str]
) -> tuple[pyvista.PolyData, Field]:
    """A surface with nodal `values`, and the flow that it is of."""
    field = smooth_pressure(run.field(time))
    if not on:
        every = facets.facets_of(run, field)
        if any(one.is_body for one in every):
            field = traction.with_quantity(run, field, quantity)
            return surfaces.bodies_surface(run, field, quantity), field
    field = derived.with_quantity(run, field, quantity)
    found = traction.surfaces_of(run, field)
    return skins.shown(
        field, traction.chosen(run, found, list(on)) if on else found, quantity
    ), field


def motion(run: Run, time: float, extent: float) -> list[tuple[Any, str]]:
    """What joins bodies and where they swim to, as surfaces with a colour, in a view so long."""
    import pyvista

    placed = bodies.poses(run, time)
    sizes = [bodies.radius(run, name) for name in placed]
    seen = [bodies.shape(run, name, time) for name in placed]
    # Thin beside the bodies, and no thicker than thin ones.
    thin = [solid.size.min() / 4 for one in seen if one for solid in one.solids]
    found = [
        (
            pyvista.lines_from_points(points).tube(
                radius=min([0.12 * min(sizes), *thin]), n_sides=12
            ),
            style.ROD,
        )
        for rod in bodies.rods(run, placed, time)
        for points in _inside(run, rod)
    ]
    for known in bodies.headings(run, placed):
        arrow = bodies.fitted(known, extent)
        length = float(np.linalg.norm(arrow.vector))
        for (start,) in _inside(run, arrow.start[None]):
            mesh = pyvista.Arrow(
                start=start,
                direction=arrow.vector / length,
                scale=length,
                tip_length=0.4,
                tip_radius=0.18,
                shaft_radius=0.07,
            )
            found.append((mesh, style.ARROW))
    return found


def _inside(run: Run, points: Array) -> list[Array]:
    """Points `(n, 3)` where a periodic domain shows them, of any other domain where they are."""
    return [points + shift for shift in shifts(run.case, points, domain_box(run.case))]
