"""The body of a soft case as a scene of a report: its surface, and its outline at rest."""

from __future__ import annotations

import numpy as np

from alewife_post import scene, style
from alewife_post.elements import edge_curves, edges, quarters
from alewife_post.read import Run
from alewife_post.scenery import Part, Scale, Scenery
from alewife_post.soft import Body, body, skin

Array = np.ndarray

QUANTITIES = ("displacement", "strain", "speed")
"""What a body can be coloured by, the first at first."""
BODY, AT_REST = "body", "edges at rest"


def soft_scenery(run: Run, time: float | None = None) -> Scenery:
    """The body at the frame nearest to a time, or at the last one."""
    frame = run.frame_at(time)
    shown = {name: body(run, frame, name) for name in QUANTITIES}
    first = shown[QUANTITIES[0]]
    values = {name: one.values for name, one in shown.items() if one.values is not None}
    cells = skin(first.cells) if run.is_spatial else quarters(first.cells)
    sides = (1.0, -1.0) if run.is_axisymmetric else (1.0,)
    parts = [
        Part(BODY, _placed(first.nodes, side), cells[:, ::-1] if side < 0.0 else cells,
             style.FLUID, 1.0, values)
        for side in sides
    ]  # fmt: skip
    rest = [_outline(run, first, side) for side in sides]
    parts += [Part(AT_REST, points, lines, style.ROD) for points, lines in rest]
    scales = {
        (BODY, name): Scale(*style.colours(name, own), (float(own.min()), float(own.max())))
        for name, own in values.items()
    }
    places = np.vstack([part.points for part in parts])
    box = np.array([places.min(axis=0), places.max(axis=0)])
    towards, up = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    if run.is_spatial:
        towards, up = scene.direction(scene.CAMERA)
    return Scenery(first.time, parts, scales, box, towards, up, "")


def _placed(points: Array, side: float = 1.0) -> Array:
    if points.shape[1] == 3:
        return points
    return np.column_stack([points * np.array([1.0, side]), np.zeros(len(points))])


def _outline(run: Run, shown: Body, side: float) -> tuple[Array, Array]:
    """Lines along the body at rest: in space the edges of its surface where it turns sharply."""
    if run.is_spatial:
        return _sharp(shown.rest, skin(shown.cells))
    every, is_outer = edges(shown.cells)
    curves = edge_curves(shown.rest, every[is_outer])
    n = curves.shape[1]
    pairs = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    starts = n * np.arange(len(curves))[:, None, None]
    return _placed(curves.reshape(-1, 2), side), (pairs[None] + starts).reshape(-1, 2)


SHARP = np.cos(np.radians(40.0))
"""Cosine of the least angle between the normals beside a line, as in a picture."""


def _sharp(points: Array, triangles: Array) -> tuple[Array, Array]:
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    of = np.repeat(np.arange(len(triangles)), 3)
    order = np.lexsort((sides[:, 1], sides[:, 0]))
    sides, of = sides[order], of[order]
    # Of a closed surface each side is one of two triangles
    pairs = np.flatnonzero((sides[:-1] == sides[1:]).all(axis=1))
    turn = (normals[of[pairs]] * normals[of[pairs + 1]]).sum(axis=1)
    return points, sides[pairs[turn < SHARP]]
