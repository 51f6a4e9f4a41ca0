"""One snapshot rendered by VTK, which draws quadratic triangles with their curved sides."""

from __future__ import annotations

import ctypes
import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post import style
from alewife_post.read import QUADRATIC_TRIANGLE, Field

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray
View = tuple[float, float, float, float]

CAMERA = (-50.0, 20.0)
"""Where bodies are looked at from unless asked for: degrees about z and above the horizon."""

SUBDIVISION = 4
"""Halvings of each side of a curved cell: circles look round at any size of a page."""

WINDOWS = {
    "vtkEGLRenderWindow": ("libEGL.so.1",),
    "vtkOSOpenGLRenderWindow": ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"),
}


def can_render() -> bool:
    """Whether VTK can have a window here; chooses an off-screen one if there is no display.

    Call it before anything loads VTK: a window that cannot be had ends the process, with no
    exception to catch.
    """
    if not sys.platform.startswith("linux") or os.environ.get("DISPLAY"):
        return True
    if os.environ.get("VTK_DEFAULT_OPENGL_WINDOW"):
        return True
    for window, libraries in WINDOWS.items():
        if any(map(_can_load, libraries)):
            os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = window
            return True
    return False


def _can_load(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def render(
    field: Field,
    view: View,
    size: tuple[int, bool],
    values: Array | None,
    colour_map: str,
    limits: style.Limits,
    show_edges: bool,
) -> Array:
    """An image `(height, width, 4)` that fills the view `(x0, x1, y0, y1)`.

    Its size is a width, and whether it is rendered finer and averaged. It is clear outside the
    fluid. Without nodal `values` `(n_nodes,)` the fluid has one colour.
    """
    width, is_smooth = size
    grid = _grid(field)
    look = {"color": style.FLUID}
    if values is not None:
        grid.point_data["values"] = values
        look = {"scalars": "values", "cmap": colour_map, "clim": limits}
    # Without subdivision each quadratic triangle would be four flat ones.
    how = {
        "nonlinear_subdivision": SUBDIVISION if is_smooth else 2,
        "algorithm": "dataset_surface",
        "pass_pointid": False,
    }
    shown = [(grid.extract_surface(**how), look)]
    if show_edges:
        # Cells must be parted first: edges between two cells are no boundary of the whole.
        lines = (
            grid.separate_cells()
            .extract_surface(**how)
            .extract_feature_edges(
                boundary_edges=True,
                feature_edges=False,
                manifold_edges=False,
                non_manifold_edges=False,
            )
        )
        shown.append((lines, {"color": style.EDGE, "line_width": width / 600}))
    return render_flat(shown, view, size)


def render_flat(
    shown: list[tuple[pyvista.PolyData, dict[str, Any]]], view: View, size: tuple[int, bool]
) -> Array:
    """An image of what lies in the plane z = 0, each with its look; likewise."""
    import pyvista

    x0, x1, y0, y1 = view
    width, is_smooth = size
    height = max(1, round(width * (y1 - y0) / (x1 - x0)))
    plotter = pyvista.Plotter(off_screen=True, window_size=(width, height))
    for mesh, look in shown:
        plotter.add_mesh(mesh, lighting=False, show_scalar_bar=False, **look)
    plotter.view_xy()
    camera = plotter.camera
    camera.parallel_projection = True
    camera.focal_point = (0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.0)
    camera.position = (*camera.focal_point[:2], 1.0)
    camera.up = (0.0, 1.0, 0.0)
    camera.parallel_scale = 0.5 * (y1 - y0)
    if is_smooth:
        plotter.enable_anti_aliasing("ssaa")
    image = plotter.screenshot(transparent_background=True, return_img=True)
    plotter.close()
    return np.asarray(image)


def render_surface(
    shown: tuple,
    size: tuple[int, int],
    camera: tuple[float, float],
    colour_map: str,
    limits: style.Limits,
) -> tuple[Array, float]:
    """An image of a surface coloured by its `values`, cut to what it shows, and a pixel's size.

    `shown` is the surface and a list of others, each with a colour of its own.
    """
    import pyvista

    surface, others = shown
    plotter = pyvista.Plotter(off_screen=True, window_size=size)
    plotter.add_mesh(
        surface.compute_normals(feature_angle=40.0, split_vertices=True),
        scalars="values",
        cmap=colour_map,
        clim=limits,
        show_scalar_bar=False,
        smooth_shading=True,
        ambient=0.6,
        diffuse=0.45,
    )
    for other, colour in others:
        plotter.add_mesh(other, color=colour, **style.SOLID)
    towards, up = direction(camera)
    plotter.view_vector(towards, viewup=up)
    plotter.camera.parallel_projection = True
    plotter.reset_camera()
    plotter.enable_anti_aliasing("ssaa")
    image = np.asarray(plotter.screenshot(transparent_background=True, return_img=True))
    pixel = 2.0 * plotter.camera.parallel_scale / image.shape[0]
    plotter.close()
    rows, columns = np.nonzero(image[..., 3])
    if len(rows):
        image = image[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    return image, float(pixel)


def direction(camera: tuple[float, float]) -> tuple[Array, Array]:
    """Where a camera at degrees about z and above the horizon looks from, and what is upright."""
    azimuth, elevation = np.radians(camera)
    flat = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    towards = np.cos(elevation) * flat + np.array([0.0, 0.0, np.sin(elevation)])
    up = (0.0, 0.0, 1.0) if abs(towards[2]) < 0.99 else (0.0, 1.0, 0.0)
    return towards, np.array(up)


def _grid(field: Field):  # noqa: ANN202  (naming the type would load VTK)
    import pyvista

    points = np.column_stack([field.nodes, np.zeros(len(field.nodes))])
    return pyvista.UnstructuredGrid({QUADRATIC_TRIANGLE: field.cells}, points)
