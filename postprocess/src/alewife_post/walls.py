"""Sides of a domain in space as they are seen: edges of a box, glass of tubes, balls and meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post import style, surfaces
from alewife_post.domains import domain_box
from alewife_post.read import Run, read_field
from alewife_post.request import Moment

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

SIDES = (("left", "right"), ("bottom", "top"), ("back", "front"))
"""Of a box, across each axis."""
LINES = {"color": style.EDGE, "line_width": 1.5, "lighting": False}
GLASS = {"color": style.EDGE, "opacity": 0.12, "lighting": False}


def walls(
    run: Run, moments: list[Moment], *, is_whole: bool
) -> list[tuple[pyvista.PolyData, dict[str, Any]]]:
    """Each with its look: lines of a box, rims and wall of a tube, a mesh's outer surface.

    A ball is there only where `is_whole`: one that is far away is seen from inside.
    """
    import pyvista

    ((kind, domain),) = run.case["domain"].items()
    match kind:
        case "box":
            low, high = domain_box(run.case)
            edges = pyvista.Box(np.array([low, high]).T.ravel()).extract_feature_edges()
            return [(edges, LINES), *((side, GLASS) for side in _no_slip(run, low, high))]
        case "cylinder":
            start, end = domain["x"]
            tube = pyvista.Cylinder(
                center=(0.5 * (start + end), 0.0, 0.0),
                direction=(1.0, 0.0, 0.0),
                radius=domain["radius"],
                height=end - start,
                resolution=96,
                capping=False,
            )
            rims = tube.extract_feature_edges(
                boundary_edges=True,
                feature_edges=False,
                manifold_edges=False,
                non_manifold_edges=False,
            )
            return [(rims, LINES), (tube, GLASS)]
        case "mesh" if moments[0].path is not None:
            return [(surfaces.outer_surface(read_field(moments[0].path)), GLASS)]
        case "sphere" if is_whole:
            center, radius = domain.get("center", (0.0, 0.0, 0.0)), domain["radius"]
            ball = pyvista.Icosphere(radius=radius, center=center, nsub=4)
            return [(ball, GLASS)]
    return []


def _no_slip(run: Run, low: Array, high: Array) -> list[pyvista.PolyData]:
    """The sides of a box at which fluid sticks."""
    import pyvista

    found = []
    for axis, names in enumerate(SIDES):
        for name, end in zip(names, (low, high), strict=True):
            if run.case.get("boundary", {}).get(name) == "no-slip":
                across = [other for other in range(3) if other != axis]
                corners = np.tile(end, (4, 1))
                corners[:, across[0]] = np.array([low, high, high, low])[:, across[0]]
                corners[:, across[1]] = np.array([low, low, high, high])[:, across[1]]
                faces = np.array([[0, 1, 2], [0, 2, 3]])
                found.append(pyvista.PolyData.from_regular_faces(corners, faces))
    return found
