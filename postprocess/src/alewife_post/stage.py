"""Films in space: bodies, a slice, what joins bodies, their ways and headings, by one camera."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from alewife_post import camera as view
from alewife_post import isosurfaces, scene, style, surfaces
from alewife_post.cast import Cast
from alewife_post.cuts import Cut, samples, whole_slice
from alewife_post.domains import corners_of
from alewife_post.page import Page
from alewife_post.read import Field, Run
from alewife_post.request import (
    Moment,
    Request,
    colour_scale,
    field_at,
    offsets,
    thinned,
    time_stamp,
)
from alewife_post.units import unit_of
from alewife_post.walls import walls

if TYPE_CHECKING:
    import pyvista
    from matplotlib.figure import Figure

Array = np.ndarray

IN_SPACE = ("speed", "pressure", "vorticity", "bodies")
FINER = 2
"""Pixels of a still image over those of a film, from left to right."""
SLICE_OPACITY = 0.8


def images(run: Run, moments: list[Moment], request: Request) -> Iterator[Array]:
    """One image a moment."""
    _check(run, request)
    pages = zip(_pages(run, moments, request, 1), moments, strict=True)
    return (page.image(time_stamp(run, moment.time)) for page, moment in pages)


def still(run: Run, moment: Moment, request: Request) -> Figure:
    """The same as a figure, its image finer."""
    _check(run, request)
    page = next(_pages(run, [moment], request, FINER))
    page.stamp.set_text(time_stamp(run, moment.time))
    return page.figure


def _check(run: Run, request: Request) -> None:
    if request.iso is None and request.quantity not in (*IN_SPACE, *run.scalars):
        known = ", ".join([*IN_SPACE, *run.scalars])
        raise ValueError(f"{request.quantity} is not filmed in space: {known}")
    if request.iso is not None:
        isosurfaces.parsed(request.iso, run.scalars)
    if not scene.can_render():
        raise ValueError("VTK can have no window here: install libosmesa6")


def _pages(run: Run, moments: list[Moment], request: Request, finer: int) -> Iterator[Page]:
    import pyvista

    moved = offsets(run, request.follow, moments)
    seen = view.seen(run, moments, request, moved)
    cut, cuts = None, None
    if request.quantity not in ("bodies", "iso") and not request.surface:
        cut = view.cut(run, moments, request, seen, moved)
        cuts = [cut.at(offset) for offset in moved]
    title = run.title
    units = run.units
    if request.quantity == "iso":
        parts, said = _isosurfaces(run, moments, request, seen.box, moved)
        title = f"{title}: {said}"
    else:
        parts = _flow(run, moments, request, cuts)
    bar, look = None, {}
    if request.quantity == "iso":
        look = {
            "color": style.ISO,
            "opacity": style.ISO_OPACITY,
            "smooth_shading": True,
            **style.SOLID,
        }
    elif parts is not None:
        alpha = 1.0 if request.surface else SLICE_OPACITY
        seen_parts = (samples(part) for part in parts if part.n_cells)
        bar = colour_scale(request.quantity, seen_parts, units, alpha, request.scale)
        look = {"scalars": "values", "cmap": bar.colour_map, "clim": bar.limits}
        look["show_scalar_bar"] = False
        look |= style.SOLID if request.surface else {"lighting": False, "opacity": alpha}
    page = Page(request.size, title, None, bar)
    corners = corners_of(seen.box + np.outer([-1.0, 1.0], view.beyond(run)))
    if cut is not None and not seen.is_whole:
        corners = np.concatenate([cut.corners(), seen.points])
    direction = view.direction(run, request, cut and cut.plane)
    camera = view.camera(direction, corners, page.pixels[0] / page.pixels[1])
    view.legend(page.axes, page.pixels, camera, units)
    size = [finer * side for side in page.pixels]
    plotter = pyvista.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    sides = walls(run, moments, is_whole=seen.is_whole)
    cast = Cast(run)
    extent = 2.0 * camera.scale * max(1.0, page.pixels[0] / page.pixels[1])
    try:
        for nth, moment in enumerate(moments):
            plotter.clear_actors()
            for wall, wall_look in sides:
                plotter.add_mesh(wall, render=False, **wall_look)
            if parts is not None and parts[nth].n_cells:
                part = _smooth(parts[nth]) if request.surface else parts[nth]
                plotter.add_mesh(part, render=False, **look)
            cast.play(plotter, moment, request, extent, is_plain=bar is not None)
            camera.applied(plotter, moved[nth])
            plotter.render()
            image = plotter.screenshot(return_img=True)
            page.clear_images()
            how = "nearest" if finer == 1 else "antialiased"
            page.axes.imshow(image, extent=(0, 1, 0, 1), aspect="auto", interpolation=how)
            yield page
    finally:
        plotter.close()


# ---- The flow ------------------------------------------------------------------------------------


def _flow(
    run: Run, moments: list[Moment], request: Request, cuts: list[Cut] | None
) -> list[pyvista.PolyData] | None:
    """A slice or the surfaces of bodies with nodal `values`, one a moment."""
    if request.quantity == "bodies":
        return None
    if cuts is None:
        return [
            surfaces.bodies_surface(run, field_at(moment), request.quantity) for moment in moments
        ]
    found = [
        whole_slice(run.case, field_at(moment), cut, request.quantity)
        for moment, cut in zip(moments, cuts, strict=True)
    ]
    if not any(part.n_cells for part in found):
        raise ValueError(f"the slice {cuts[0].plane.text} meets no fluid that is seen")
    return found


def _isosurfaces(
    run: Run, moments: list[Moment], request: Request, box: Array, moved: Array
) -> tuple[list[pyvista.PolyData], str]:
    """Surfaces of one value in all frames, and what they are."""
    quantity, level = isosurfaces.parsed(request.iso, run.scalars)

    # Read again rather than kept: a film has hundreds of them
    def fields() -> Iterator[tuple[Field, Array]]:
        return zip((field_at(moment) for moment in moments), moved, strict=True)

    if level is None:
        level = isosurfaces.level_of(
            [
                thinned(*isosurfaces.samples(field, quantity, box + offset))
                for field, offset in fields()
            ]
        )
    found = [
        isosurfaces.isosurface(run.case, field, quantity, level, box + offset)
        for field, offset in fields()
    ]
    if not any(part.n_cells for part in found):
        raise ValueError(f"no surface of {quantity} {level:g} is in view")
    unit = unit_of(quantity, run.units)
    return found, f"{quantity} {level:.3g}" + (f" {unit}" if unit else "")


def _smooth(surface: pyvista.PolyData) -> pyvista.PolyData:
    return surface.compute_normals(feature_angle=40.0, split_vertices=True)
