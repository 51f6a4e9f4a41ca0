"""Bodies of a run in space as surfaces, with their ways, as they are added to a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from alewife_post import bodies, space, style, surfaces, tracers, ways
from alewife_post.domains import domain_box
from alewife_post.messages import Shape, Solid
from alewife_post.periodic import images, trail
from alewife_post.read import Run, read_field
from alewife_post.request import Moment, Request, group_colours

if TYPE_CHECKING:
    import pyvista

Array = np.ndarray

THICK = 0.0016
"""Radius of ways of particles in a picture over the length in view."""


class Cast:
    """Bodies of a run as surfaces, and what shows their motion."""

    def __init__(self, run: Run) -> None:
        """Nothing is made before it is asked for."""
        self.run = run
        self.colours = group_colours(run)
        self.forms: dict[str, tuple[float, Array, Array]] = {}
        self.deforming = bodies.deforming(run)
        self.tracks: tracers.Tracks | None = None

    def form(self, name: str, time: float) -> tuple[Array, Array]:
        """Points `(n, 3)` and triangles `(m, 3)` of a body in its own frame."""
        seen = bodies.shape(self.run, name, time)
        if name in self.deforming and seen is not None:
            # A dot where it is, rather than a shape it has no longer
            size = np.full(3, 0.2 * bodies.radius(self.run, name))
            dot = Solid("ellipsoid", np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]), size, (1.0, 1.0))
            seen = Shape(seen.time, [dot], [])
        if seen is None or not seen.solids:
            return np.zeros((0, 3)), np.zeros((0, 3), dtype=int)
        known = self.forms.get(name)
        if known is None or known[0] != seen.time:
            known = (seen.time, *_surface(seen))
            self.forms[name] = known
        return known[1:]

    def play(
        self,
        plotter: pyvista.Plotter,
        moment: Moment,
        request: Request,
        extent: float,
        *,
        is_plain: bool,
    ) -> None:
        """Add all that is known of a moment: without a colour of their own if `is_plain`.

        `extent` is the length that is in view.
        """
        placed = bodies.poses(self.run, moment.time)
        moved = self._inside(placed)
        if not request.surface or request.quantity == "bodies":
            if moment.path is not None and self._needs_mesh(list(placed), moment.time):
                surface = surfaces.bodies_surface(self.run, read_field(moment.path), "speed")
                plotter.add_mesh(
                    surface, color=style.BODY, smooth_shading=True, render=False, **style.SOLID
                )
            else:
                self._add_bodies(plotter, moved, moment.time, is_plain=is_plain)
        for mesh, colour in space.motion(self.run, moment.time, extent):
            plotter.add_mesh(mesh, color=colour, render=False, **style.SOLID)
        if request.trails:
            self._add_trails(plotter, moment.time)
        if request.particles is not None:
            self._add_particles(plotter, request, moment.time, extent)

    def _needs_mesh(self, names: list[str], time: float) -> bool:
        """Whether a body has a shape that only the mesh knows."""
        shapes = {name: bodies.shape(self.run, name, time) for name in names}
        unknown = {name for name, seen in shapes.items() if seen is None or not seen.solids}
        return bool(unknown | self.deforming) or not bodies.is_written(self.run, time)

    def _inside(self, placed: dict[str, bodies.Pose]) -> list[tuple[str, Array, Array]]:
        """Name, centre and rotation of each body, with its images where it crosses a side."""
        low, high = domain_box(self.run.case)
        found = []
        for name, (center, turn) in placed.items():
            size = bodies.radius(self.run, name)
            for shift in images(self.run.case, center - size, center + size, (low, high)):
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

    def _add_particles(
        self, plotter: pyvista.Plotter, request: Request, time: float, extent: float
    ) -> None:
        import pyvista

        if self.tracks is None:
            self.tracks = tracers.read_paths(request.particles)
        if request.is_still:
            lines, heads = self.tracks.still(self.run, time if self.run.is_unsteady else None)
        else:
            lines, heads = self.tracks.shown(self.run, time)
        look = {"color": style.PARTICLE, "lighting": False, "render": False}
        if request.is_still:
            # As thick as they look at any number of pixels, and above a plane they are in
            size = THICK * extent
            tubes = [pyvista.lines_from_points(line).tube(radius=size) for line in lines]
            if tubes:
                plotter.add_mesh(pyvista.merge(tubes), **look)
            if len(heads):
                balls = pyvista.PolyData(heads).glyph(
                    geom=pyvista.Sphere(radius=2.2 * size), scale=False, orient=False
                )
                plotter.add_mesh(balls, **look)
            return
        for line in lines:
            plotter.add_mesh(pyvista.lines_from_points(line), line_width=2.0, **look)
        if len(heads):
            plotter.add_mesh(
                pyvista.PolyData(heads), point_size=6.0, render_points_as_spheres=True, **look
            )

    def _add_trails(self, plotter: pyvista.Plotter, time: float) -> None:
        for times, way in ways.trails(self.run):
            for points in trail(self.run.case, way[times <= time * (1 + 1e-12)]):
                if len(points) > 1:
                    plotter.add_mesh(_line(points), color=style.TRAIL, line_width=2.5, render=False)


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


def _line(points: Array) -> pyvista.PolyData:
    import pyvista

    return pyvista.lines_from_points(points)
