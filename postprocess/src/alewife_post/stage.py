"""Films in space: bodies, a slice, what joins bodies, their ways and headings, by one camera."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from alewife_post import bodies, planes, scene, space, style
from alewife_post.film import Moment, Page, Request, field_at, group_colours, limits_of, offsets
from alewife_post.film import thinned as thinned_samples
from alewife_post.periodic import images as shifts_into
from alewife_post.periodic import periods, trail
from alewife_post.read import Field, Run, Shape

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

CAMERA = (-50.0, 20.0)
"""Degrees about z and above the horizon."""
IN_SPACE = ("speed", "pressure", "vorticity", "bodies")
SLICE_OPACITY = 0.8
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


def images(run: Run, moments: list[Moment], request: Request) -> Iterator[Array]:
    """One image a moment."""
    if request.quantity not in IN_SPACE:
        raise ValueError(f"{request.quantity} is not filmed in space: {', '.join(IN_SPACE)}")
    if not scene.can_render():
        raise ValueError("VTK can have no window here: install libosmesa6")
    return _images(run, moments, request)


def _images(run: Run, moments: list[Moment], request: Request) -> Iterator[Array]:
    import pyvista

    moved = offsets(run, request.follow, moments)
    seen = _seen(run, moments, request, moved)
    cut, cuts = None, None
    if request.quantity != "bodies" and not request.surface:
        cut = _cut(run, moments, request, seen, moved)
        cuts = [cut.at(offset) for offset in moved]
    parts = _flow(run, moments, request, cuts)
    units = run.case.get("units", "")
    bar, look = None, {}
    if parts is not None:
        colour_map, limits = limits_of(
            request.quantity, [thinned_samples(*_samples(part)) for part in parts]
        )
        every = np.concatenate([np.asarray(part.point_data["values"]) for part in parts])
        alpha = 1.0 if request.surface else SLICE_OPACITY
        bar = (colour_map, limits, every, style.label(request.quantity, units), alpha)
        look = {"scalars": "values", "cmap": colour_map, "clim": limits, "show_scalar_bar": False}
    page = Page(request, run.case["title"], None, bar)
    corners = _corners(seen.box)
    if cut is not None and not seen.is_whole:
        corners = np.concatenate([cut.corners(), seen.points])
    direction = _direction(run, request, cut and cut.plane)
    camera = _camera(direction, corners, page.pixels[0] / page.pixels[1])
    _legend(page, camera, units)
    plotter = pyvista.Plotter(off_screen=True, window_size=page.pixels)
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    walls = _walls(run, moments, is_whole=seen.is_whole)
    cast = Cast(run)
    try:
        for nth, moment in enumerate(moments):
            plotter.clear_actors()
            for wall, wall_look in walls:
                plotter.add_mesh(wall, render=False, **wall_look)
            if parts is not None and request.surface:
                plotter.add_mesh(_smooth(parts[nth]), render=False, **look, **style.SOLID)
            elif parts is not None:
                plotter.add_mesh(
                    parts[nth], render=False, lighting=False, opacity=SLICE_OPACITY, **look
                )
            cast.play(plotter, moment, request, is_plain=parts is not None)
            camera.applied(plotter, moved[nth])
            plotter.render()
            image = plotter.screenshot(return_img=True)
            page.clear_images()
            page.axes.imshow(image, extent=(0, 1, 0, 1), aspect="auto", interpolation="nearest")
            yield page.image(style.time_text(moment.time, units))
    finally:
        plotter.close()


class Cast:
    """Bodies of a run as surfaces, and what tells of their motion."""

    def __init__(self, run: Run) -> None:
        """Nothing is made before it is asked for."""
        self.run = run
        self.colours = group_colours(run)
        self.forms: dict[str, tuple[float, Array, Array]] = {}

    def form(self, name: str, time: float) -> tuple[Array, Array]:
        """Points `(n, 3)` and triangles `(m, 3)` of a body in its own frame."""
        seen = bodies.shape(self.run, name, time)
        if seen is None or not seen.solids:
            return np.zeros((0, 3)), np.zeros((0, 3), dtype=int)
        known = self.forms.get(name)
        if known is None or known[0] != seen.time:
            known = (seen.time, *_surface(seen))
            self.forms[name] = known
        return known[1:]

    def play(
        self, plotter: pyvista.Plotter, moment: Moment, request: Request, *, is_plain: bool
    ) -> None:
        """Add all that is known of a moment: without a colour of their own if `is_plain`."""
        placed = bodies.poses(self.run, moment.time)
        moved = self._inside(placed)
        if not request.surface or request.quantity == "bodies":
            self._add_bodies(plotter, moved, moment.time, is_plain=is_plain)
        for mesh, colour in space.motion(self.run, moment.time):
            plotter.add_mesh(mesh, color=colour, render=False, **style.SOLID)
        if request.trails:
            self._add_trails(plotter, placed, moment.time)

    def _inside(self, placed: dict[str, bodies.Pose]) -> list[tuple[str, Array, Array]]:
        """Name, centre and rotation of each body, with its images where it crosses a side."""
        low, high = _domain_box(self.run.case)
        found = []
        for name, (center, turn) in placed.items():
            size = bodies.radius(self.run, name)
            for shift in shifts_into(self.run.case, center - size, center + size, (low, high)):
                found.append((name, center + shift, turn))
        return found

    def _add_bodies(
        self,
        plotter: pyvista.Plotter,
        moved: list[tuple[str, Array, Array]],
        time: float,
        *,
        is_plain: bool,
    ) -> None:
        import pyvista

        points, triangles, colours, n = [], [], [], 0
        for name, center, turn in moved:
            own, faces = self.form(name, time)
            points.append(center + own @ turn.T)
            triangles.append(faces + n)
            colour = style.BODY if is_plain else self.colours.get(name, style.BODY)
            colours.append(np.tile(style.rgb(colour), (len(own), 1)))
            n += len(own)
        if n == 0:
            return
        mesh = pyvista.PolyData.from_regular_faces(
            np.concatenate(points), np.concatenate(triangles)
        )
        mesh.point_data["colour"] = np.concatenate(colours)
        plotter.add_mesh(
            mesh, scalars="colour", rgb=True, smooth_shading=True, render=False, **style.SOLID
        )

    def _add_trails(
        self, plotter: pyvista.Plotter, placed: dict[str, bodies.Pose], time: float
    ) -> None:
        for name in placed:
            history = self.run.bodies.get(name)
            least = 0.05 * bodies.radius(self.run, name)
            if history is None or np.ptp(history.center, axis=0).max() <= least:
                continue
            past = history.center[history.time <= time * (1 + 1e-12)]
            for points in trail(self.run.case, past):
                if len(points) > 1:
                    plotter.add_mesh(
                        _line(points), color=style.TRAIL, line_width=2.5, render=False
                    )


# ---- The flow ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Cut:
    """A slice that a film shows, less where the view has moved to."""

    plane: planes.Plane
    low: Array
    """Least coordinates in the plane, `(2,)`."""
    high: Array
    moves: bool
    """Whether it goes with the view."""

    def at(self, offset: Array) -> Cut:
        """The same where the view has moved to."""
        if self.moves:
            return replace(self, plane=replace(self.plane, origin=self.plane.origin + offset))
        shift = self.plane.across @ offset
        return replace(self, low=self.low + shift, high=self.high + shift)

    def corners(self) -> Array:
        """`(4, 3)`."""
        pairs = [(x, y) for x in (self.low[0], self.high[0]) for y in (self.low[1], self.high[1])]
        return self.plane.points(np.array(pairs))


def _cut(run: Run, moments: list[Moment], request: Request, seen: Seen, moved: Array) -> Cut:
    """Through the bodies if no plane is asked for, and there as far as the bodies' surroundings."""
    times = np.array([moment.time for moment in moments])
    moves = request.plane is None and request.follow is not None
    if request.plane is not None:
        plane = planes.parsed(request.plane)
    else:
        plane = planes.through_bodies(run, times[:1] if moves else times, seen.box.mean(axis=0))
    if moves:
        plane = replace(plane, origin=plane.origin - moved[0])
    box = plane.coordinates(_corners(seen.box))
    low, high = box.min(axis=0), box.max(axis=0)
    if not seen.is_whole:
        near = plane.coordinates(seen.points)
        low = np.maximum(low, near.min(axis=0) - seen.margin)
        high = np.minimum(high, near.max(axis=0) + seen.margin)
    return Cut(plane, low, high, moves)


def _flow(
    run: Run, moments: list[Moment], request: Request, cuts: list[Cut] | None
) -> list[pyvista.PolyData] | None:
    """A slice or the surfaces of bodies with nodal `values`, one a moment."""
    if request.quantity == "bodies":
        return None
    if cuts is None:
        return [
            space.bodies_surface(run, field_at(moment), request.quantity) for moment in moments
        ]
    found = [
        slice_of(field_at(moment), cut, request.quantity)
        for moment, cut in zip(moments, cuts, strict=True)
    ]
    if not any(part.n_cells for part in found):
        raise ValueError(f"the slice {cuts[0].plane.text} meets no fluid that is seen")
    return found


def slice_of(field: Field, cut: Cut, quantity: str) -> pyvista.PolyData:
    """The part of a plane that is cut out, with nodal `values`."""
    import pyvista

    plane = cut.plane
    height = (field.nodes - plane.origin) @ plane.normal
    own = plane.coordinates(field.nodes)[field.cells]
    heights = height[field.cells]
    near = (heights.min(axis=1) <= 0) & (heights.max(axis=1) >= 0)
    near &= (own.max(axis=1) >= cut.low).all(axis=1) & (own.min(axis=1) <= cut.high).all(axis=1)
    if not near.any():
        return pyvista.PolyData()
    pieces = field.cells[near][:, space.PIECES].reshape(-1, 4)
    grid = pyvista.UnstructuredGrid({space.TETRAHEDRON: pieces}, field.nodes)
    grid.point_data["values"] = space.nodal_values(field, quantity)
    found = grid.slice(normal=plane.normal, origin=plane.origin)
    for along, (low, high) in zip(
        plane.across, zip(cut.low, cut.high, strict=True), strict=True
    ):
        for end, outwards in ((low, -along), (high, along)):
            if found.n_cells:
                found = found.clip(normal=outwards, origin=plane.origin + end * along)
    return found


def _samples(part: pyvista.PolyData) -> tuple[Array, Array]:
    """Values at cells of a surface and the areas they hold."""
    if part.n_cells == 0:
        return np.zeros(1), np.ones(1)
    sized = part.compute_cell_sizes(length=False, volume=False)
    values = sized.point_data_to_cell_data().cell_data["values"]
    areas = np.asarray(sized.cell_data["Area"])
    return np.asarray(values), areas + 1e-300


# ---- What is seen, and from where ----------------------------------------------------------------


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


def _seen(run: Run, moments: list[Moment], request: Request, moved: Array) -> Seen:
    low, high = _domain_box(run.case)
    if not np.isfinite(low).all() and run.fields:
        nodes = run.field(moments[0].time).nodes
        low, high = nodes.min(axis=0), nodes.max(axis=0)
    domain = np.array([low, high])
    members = bodies.groups(run).get(request.follow, [request.follow])
    corners = []
    step = max(1, len(moments) // 60)
    for nth in range(0, len(moments), step):
        for name, pose in bodies.poses(run, moments[nth].time).items():
            if request.follow is None or name in members:
                corners.append(np.array(bodies.corners(run, name, pose)) - moved[nth])
    if not corners or periods(run.case).any():
        return Seen(domain, np.zeros((0, 3)), True, 0.0)
    found = np.array(corners)
    box = np.array([found[:, 0].min(axis=0), found[:, 1].max(axis=0)])
    extent = (box[1] - box[0]).max()
    is_large = (domain[1] - domain[0]).max() >= WHOLE * extent
    if request.follow is None and not is_large:
        return Seen(domain, found.reshape(-1, 3), True, 0.0)
    share = 0.1 if request.surface or request.quantity == "bodies" else MARGIN
    if request.follow is not None:
        share = max(share, 1.0)
    margin = share * extent
    box = box + margin * np.array([[-1.0], [1.0]])
    if request.follow is None:
        box = np.array([np.maximum(box[0], domain[0]), np.minimum(box[1], domain[1])])
    return Seen(box, found.reshape(-1, 3), False, float(margin))


def _direction(run: Run, request: Request, plane: planes.Plane | None) -> tuple[Array, Array]:
    """Where the camera looks from, and what it sees upright.

    Without a wish it has the gravity downwards and looks on to the slice, askew.
    """
    if request.camera is not None:
        return scene.direction(request.camera)
    up = np.array([0.0, 0.0, 1.0])
    gravity = np.array(run.case.get("fluid", {}).get("gravity", [0.0, 0.0, 0.0]), dtype=float)
    if np.linalg.norm(gravity) > 0:
        up = -gravity / np.linalg.norm(gravity)
    towards, _ = scene.direction(CAMERA)
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


def _camera(direction: tuple[Array, Array], corners: Array, aspect: float) -> Camera:
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


def _corners(box: Array) -> Array:
    return np.array([[box[i, 0], box[j, 1], box[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])


def _legend(page: Page, camera: Camera, units: str) -> None:
    """Directions of the axes and a length, in the lower corners."""
    page.axes.set_axis_off()
    page.axes.set_xlim(0, 1)
    page.axes.set_ylim(0, 1)
    width, height = page.pixels
    root, reach = np.array([50.0, 50.0]), 32.0
    for name, axis in zip("xyz", np.eye(3), strict=True):
        tip = np.array([camera.right @ axis, camera.up @ axis])
        end = root + reach * tip
        page.axes.annotate(
            "",
            end / (width, height),
            root / (width, height),
            arrowprops={"arrowstyle": "-|>", "color": style.BOUNDARY, "lw": 1.0, "mutation_scale": 7},
        )
        at = (root + (reach + 9) * tip) / (width, height)
        if np.linalg.norm(tip) > 0.15:
            page.axes.text(*at, name, ha="center", va="center", fontsize=8)
    across = 2 * camera.scale * width / height
    length = style.round_length(0.2 * across)
    end = 1.0 - 20.0 / width
    start = end - length / across
    page.axes.plot([start, end], [30 / height] * 2, color=style.BOUNDARY, lw=2, zorder=20)
    text = style.length_text(length, units)
    page.axes.text(0.5 * (start + end), 36 / height, text, ha="center", va="bottom", fontsize=8)


def _domain_box(case: dict[str, Any]) -> tuple[Array, Array]:
    ((kind, domain),) = case["domain"].items()
    match kind:
        case "box":
            return np.array(domain["min"], dtype=float), np.array(domain["max"], dtype=float)
        case "cylinder":
            r = domain["radius"]
            start, end = domain["x"]
            return np.array([start, -r, -r]), np.array([end, r, r])
        case "sphere":
            center = np.array(domain.get("center", [0.0, 0.0, 0.0]))
            return center - domain["radius"], center + domain["radius"]
    return np.full(3, -np.inf), np.full(3, np.inf)


def _walls(
    run: Run, moments: list[Moment], *, is_whole: bool
) -> list[tuple[pyvista.PolyData, dict[str, Any]]]:
    """The sides of the domain: edges of a box, rims and wall of a tube or of a mesh."""
    import pyvista

    ((kind, domain),) = run.case["domain"].items()
    lines = {"color": style.EDGE, "line_width": 1.5, "lighting": False}
    glass = {"color": style.EDGE, "opacity": 0.12, "lighting": False}
    match kind:
        case "box":
            low, high = _domain_box(run.case)
            edges = pyvista.Box(np.array([low, high]).T.ravel()).extract_feature_edges()
            return [(edges, lines)]
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
            return [(rims, lines), (tube, glass)]
        case "mesh" if run.fields:
            return [(space.outer_surface(run.field(moments[0].time)), glass)]
        case "sphere" if is_whole:
            center, radius = domain.get("center", (0.0, 0.0, 0.0)), domain["radius"]
            ball = pyvista.Icosphere(radius=radius, center=center, nsub=4)
            return [(ball, glass)]
    # A ball that is far away is left out: it is seen from inside.
    return []


# ---- Surfaces ------------------------------------------------------------------------------------


def _surface(seen: Shape) -> tuple[Array, Array]:
    """Points and triangles of all solids of a shape."""
    import pyvista

    points, triangles, n = [], [], 0
    for solid in seen.solids:
        turn = bodies.rotation_matrix(solid.rotation)
        if solid.kind == "ellipsoid":
            own = pyvista.Icosphere(radius=0.5, nsub=3 if len(seen.solids) < 20 else 2)
            at, faces = np.asarray(own.points) * solid.size, own.regular_faces
        else:
            at, faces = _cone(solid.size, solid.scales)
            if len(seen.solids) > 3 and solid.scales == (1.0, 1.0):
                # A ball fills the wedge between two pieces of a bent tube.
                ball = pyvista.Icosphere(radius=solid.size[0] / 2, nsub=2)
                below = np.asarray(ball.points) - [0.0, 0.0, solid.size[2] / 2]
                faces = np.concatenate([faces, ball.regular_faces + len(at)])
                at = np.concatenate([at, below])
        points.append(solid.position + at @ turn.T)
        triangles.append(faces + n)
        n += len(at)
    return np.concatenate(points), np.concatenate(triangles)


def _cone(size: Array, scales: tuple[float, float], n: int = 32) -> tuple[Array, Array]:
    """A cylinder or a cone without its tip along z, with flat ends."""
    angles = 2 * np.pi * np.arange(n) / n
    round_ = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(n)]) / 2
    rings = [
        size * (round_ * [scale, scale, 1.0] + [0.0, 0.0, height])
        for scale, height in ((scales[0], -0.5), (scales[1], 0.5))
    ]
    after = (np.arange(n) + 1) % n
    k = np.arange(n)
    side = np.concatenate(
        [np.column_stack([k, after, k + n]), np.column_stack([after, after + n, k + n])]
    )
    # The ends have points of their own: they are not to look round.
    ends = np.concatenate(rings)
    fan = np.column_stack([np.zeros(n - 2, dtype=int), k[1:-1], k[2:]])
    faces = np.concatenate([side, fan[:, ::-1] + 2 * n, fan + 3 * n])
    return np.concatenate([ends, ends]), faces


def _smooth(surface: pyvista.PolyData) -> pyvista.PolyData:
    return surface.compute_normals(feature_angle=40.0, split_vertices=True)


def _line(points: Array) -> pyvista.PolyData:
    import pyvista

    return pyvista.lines_from_points(points)

