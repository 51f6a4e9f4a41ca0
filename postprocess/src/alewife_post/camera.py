"""Where a film in space is looked at from, and what is in view."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from alewife_post import bodies, planes, scene, style, surfaces
from alewife_post.cuts import Cut
from alewife_post.domains import corners_of, domain_box, periods
from alewife_post.read import Run, read_field
from alewife_post.request import Moment, Request

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

MARGIN = 0.7
"""Space shown around bodies over what they take."""
WHOLE = 4.0
"""A domain less than so many times as large as its bodies is shown as a whole."""


@dataclass(frozen=True)
class Camera:
    """Parallel rays on to a picture."""

    towards: Array
    """From what is seen to the camera, `(3,)`."""
    right: Array
    up: Array
    middle: Array
    """What is in the middle of the picture."""
    scale: float
    """Half the height of the picture, in lengths of the run."""

    def applied(self, plotter: pyvista.Plotter, offset: Array) -> None:
        """Look at a place that has moved."""
        camera = plotter.camera
        camera.parallel_projection = True
        focus = self.middle + offset
        camera.focal_point = tuple(focus)
        camera.position = tuple(focus + 100.0 * self.scale * self.towards)
        camera.up = tuple(self.up)
        camera.parallel_scale = self.scale
        plotter.reset_camera_clipping_range()


@dataclass(frozen=True)
class Seen:
    """What a film has in view, less where the view has moved to."""

    box: Array
    """Corners `(2, 3)`."""
    points: Array
    """Corners of all bodies at all times, `(n, 3)`."""
    is_whole: bool
    """Whether that is all of the domain."""
    margin: float
    """Length shown around the bodies."""


def seen(
    run: Run, moments: list[Moment], request: Request, moved: Array, around: float = MARGIN
) -> Seen:
    """What is in view in all frames: what is around the bodies, or a domain that is small."""
    low, high = domain_box(run.case)
    if not np.isfinite(low).all() and run.fields:
        nodes = run.field(moments[0].time).nodes
        low, high = nodes.min(axis=0), nodes.max(axis=0)
    domain = np.array([low, high])
    if periods(run.case).any():
        return Seen(domain, np.zeros((0, 3)), True, 0.0)
    members = request.follow and bodies.followed(run, request.follow)
    corners = []
    step = max(1, len(moments) // 60)
    for nth in range(0, len(moments), step):
        placed = bodies.poses(run, moments[nth].time)
        kept = {name: placed[name] for name in placed if members is None or name in members}
        corners += [one - moved[nth] for one in _corners(run, kept, moments[nth])]
    if not corners:
        return Seen(domain, np.zeros((0, 3)), True, 0.0)
    found = np.array(corners)
    box = np.array([found[:, 0].min(axis=0), found[:, 1].max(axis=0)])
    extent = (box[1] - box[0]).max()
    is_large = (domain[1] - domain[0]).max() >= WHOLE * extent
    if request.follow is None and not is_large:
        return Seen(domain, found.reshape(-1, 3), True, 0.0)
    share = 0.1 if request.surface or request.quantity == "bodies" else around
    if request.follow is not None:
        share = max(share, 1.0)
    margin = share * extent
    box = box + margin * np.array([[-1.0], [1.0]])
    if request.follow is None:
        box = np.array([np.maximum(box[0], domain[0]), np.minimum(box[1], domain[1])])
    return Seen(box, found.reshape(-1, 3), False, float(margin))


def _corners(run: Run, placed: dict[str, bodies.Pose], moment: Moment) -> list[Array]:
    """Lowest and highest corner `(2, 3)` of each body; of those only the mesh knows, of all."""
    found = [np.array(bodies.corners(run, name, pose)) for name, pose in placed.items()]
    known = [corners for corners in found if np.ptp(corners, axis=0).max() > 0.0]
    if len(known) == len(found) or moment.path is None:
        return found
    surface = surfaces.bodies_surface(run, read_field(moment.path), "speed")
    points = np.asarray(surface.points)
    return [*known, np.array([points.min(axis=0), points.max(axis=0)])]


def direction(run: Run, request: Request, plane: planes.Plane | None) -> tuple[Array, Array]:
    """Where the camera looks from, and what it sees upright.

    Without a wish it has the gravity downwards and looks on to the slice, askew.
    """
    if request.camera is not None:
        return scene.direction(request.camera)
    up = np.array([0.0, 0.0, 1.0])
    gravity = np.array(run.case.get("fluid", {}).get("gravity", [0.0, 0.0, 0.0]), dtype=float)
    if np.linalg.norm(gravity) > 0:
        up = -gravity / np.linalg.norm(gravity)
    towards, _ = scene.direction(scene.CAMERA)
    # Turned as z is turned to the direction upwards, by way of the nearest axes.
    if up[2] < 0.9:
        side = np.eye(3)[int(np.argmin(np.abs(up)))]
        first = np.cross(side, up)
        first = first / np.linalg.norm(first)
        towards = np.array([first, np.cross(up, first), up]).T @ towards
    if plane is not None:
        normal = plane.normal * (np.sign(plane.normal @ towards) or 1.0)
        towards = 0.9 * normal + 0.6 * towards
        towards = towards / np.linalg.norm(towards)
    if abs(towards @ up) > 0.99:
        up = np.eye(3)[int(np.argmin(np.abs(towards)))]
    return towards, up


def cut(run: Run, moments: list[Moment], request: Request, seen: Seen, moved: Array) -> Cut:
    """Through the bodies if no plane is asked for, and there as far as the bodies' surroundings."""
    times = np.array([moment.time for moment in moments])
    moves = request.plane is None and request.follow is not None
    if request.plane is not None:
        plane = planes.parsed(request.plane)
    else:
        plane = planes.through_bodies(run, times[:1] if moves else times, seen.box)
    if moves:
        plane = replace(plane, origin=plane.origin - moved[0])
    box = plane.coordinates(corners_of(seen.box))
    low, high = box.min(axis=0), box.max(axis=0)
    if not seen.is_whole:
        near = plane.coordinates(seen.points)
        low = np.maximum(low, near.min(axis=0) - seen.margin)
        high = np.minimum(high, near.max(axis=0) + seen.margin)
    return Cut(plane, low, high, moves)


def camera(direction: tuple[Array, Array], corners: Array, aspect: float) -> Camera:
    """The camera that has all corners `(n, 3)` in full view."""
    towards, up = direction
    right = np.cross(up, towards)
    right = right / np.linalg.norm(right)
    up = np.cross(towards, right)
    across = np.array([right, up])
    places = corners @ across.T
    low, high = places.min(axis=0), places.max(axis=0)
    depth = corners.mean(axis=0) @ towards
    middle = 0.5 * (low + high) @ across + depth * towards
    reach = 0.5 * (high - low)
    scale = 1.04 * max(reach[1], reach[0] / aspect)
    return Camera(towards, right, up, middle, float(scale))


def beyond(run: Run) -> Array:
    """How far bodies that cross its sides reach out of a periodic domain, `(3,)`."""
    largest = max([0.0, *(bodies.radius(run, name) for name in run.bodies)])
    return np.where(periods(run.case) > 0, largest, 0.0)


def legend(axes: Axes, pixels: tuple[float, float], camera: Camera, units: str) -> None:
    """Directions of the axes and a length, in the lower corners."""
    axes.set_axis_off()
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
    width, height = pixels
    root, reach = np.array([50.0, 50.0]), 32.0
    for name, axis in zip("xyz", np.eye(3), strict=True):
        tip = np.array([camera.right @ axis, camera.up @ axis])
        end = root + reach * tip
        axes.annotate(
            "",
            end / (width, height),
            root / (width, height),
            arrowprops={
                "arrowstyle": "-|>",
                "color": style.BOUNDARY,
                "lw": 1.0,
                "mutation_scale": 7,
            },
        )
        at = (root + (reach + 9) * tip) / (width, height)
        if np.linalg.norm(tip) > 0.15:
            axes.text(*at, name, ha="center", va="center", fontsize=8)
    across = 2 * camera.scale * width / height
    length = style.round_length(0.2 * across)
    end = 1.0 - 20.0 / width
    start = end - length / across
    axes.plot([start, end], [30 / height] * 2, color=style.BOUNDARY, lw=2, zorder=20)
    text = style.length_text(length, units)
    axes.text(0.5 * (start + end), 36 / height, text, ha="center", va="bottom", fontsize=8)
