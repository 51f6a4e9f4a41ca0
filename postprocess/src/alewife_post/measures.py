"""Numbers of a stored flow: along a line, through a section, and how it decays far from bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alewife_post import bodies, derived, fields
from alewife_post.cells import Cells
from alewife_post.cutting import cut
from alewife_post.domains import periods
from alewife_post.planes import AXES
from alewife_post.read import Field, Run, check_run

Array = np.ndarray

POINTS = 201
"""On a line, unless asked for."""
RADII = 24
DIRECTIONS = {2: 180, 3: 400}
"""Points on a circle, or on a sphere, by dimension."""
NEAREST = 4.0
"""Least distance of a fit over the reach of the bodies."""
FARTHEST = 0.3
"""Largest distance over that of the nearest side, which is felt before it is near."""
FEWEST = 4
"""Radii of a fit, at least."""


def names_of(run: Run) -> str:
    """Axes of a run, one letter each."""
    return AXES if run.is_spatial else AXES[:2]


def line(
    run: Run,
    start: Array,
    end: Array,
    *,
    points: int = POINTS,
    time: float | None = None,
    frame: str | None = None,
) -> dict[str, Array]:
    """Flow along a straight line from `start` to `end` `(d,)`, at points evenly on it.

    Columns `distance`, the coordinates, `velocity.x` and so on, `speed`, `pressure`, `vorticity`
    (in space its magnitude), and those of scalars by their names, each `(points,)` and not a number
    outside of the fluid. With a `frame` the velocity of that body is subtracted. Velocity is
    quadratic within cells, as it was computed.
    """
    check_run(run)
    flow = fields.flow_at(run, time, frame)
    d = flow.nodes.shape[1]
    start, end = (np.asarray(one, dtype=float) for one in (start, end))
    if len(start) != d or len(end) != d:
        raise ValueError(f"{run.path} has {d} dimensions: write {d} numbers for each end")
    length = float(np.linalg.norm(end - start))
    if not length > 0.0 or points < 2:
        raise ValueError("a line needs two ends that are apart, and two points at least")
    share = np.linspace(0.0, 1.0, points)
    places = start + share[:, None] * (end - start)
    cells = Cells(flow, run.case)
    found = cells.find(places)
    velocity = cells.at(found, flow.velocity)
    columns = {"distance": share * length}
    columns |= {name: places[:, axis] for axis, name in enumerate(names_of(run))}
    columns |= {f"velocity.{name}": velocity[:, axis] for axis, name in enumerate(names_of(run))}
    columns["speed"] = np.linalg.norm(velocity, axis=1)
    columns["pressure"] = cells.at(found, flow.pressure)
    vorticity = derived.rates(flow, is_axisymmetric=run.is_axisymmetric).vorticity
    if vorticity.ndim == 2:
        vorticity = np.linalg.norm(vorticity, axis=1)
    columns["vorticity"] = cells.at(found, vorticity)
    columns |= {name: cells.at(found, values) for name, values in flow.scalars.items()}
    if not found.is_inside.any():
        raise ValueError("no point of the line is in the fluid")
    return columns


# ---- Sections ------------------------------------------------------------------------------------


def section(run: Run, axis: int, height: float, time: float | None = None) -> dict[str, float]:
    """Integrals over all of the fluid in which a coordinate has one value.

    `area` (of a planar run the length, of one about an axis that of the disc or cylinder), `flux`
    along the coordinate, its `mean_velocity`, the largest `speed`, and the mean `pressure`.
    """
    check_run(run)
    return section_of(run, fields.settled(run, run.field(time)), axis, height)


def section_of(run: Run, flow: Field, axis: int, height: float) -> dict[str, float]:
    """The same of a flow that was read."""
    d = flow.nodes.shape[1]
    if axis >= d:
        raise ValueError(f"{run.path} has no {AXES[axis]}: write {' or '.join(names_of(run))}")
    cells = Cells(flow)
    normal = np.eye(d)[axis]
    period = periods(run.case)[axis]
    parts = []
    low, high = flow.nodes[:, axis].min(), flow.nodes[:, axis].max()
    slack = 1e-9 * (high - low)
    if period == 0.0:
        # A side of the domain is cut just within it
        heights = [min(max(height, low + slack), high - slack)]
        if not low - 2 * slack <= height <= high + 2 * slack:
            heights = []
    else:
        # What is cut here is whole with what is cut periods away: a mesh ends along cells
        first = np.ceil((low - slack - height) / period)
        every = height + period * np.arange(first, first + 2 + (high - low) // period)
        heights = [max(at, low + slack) for at in every if at < high - slack]
    for at in heights:
        found = cut(cells, at * normal, normal)
        weight = found.weight
        if run.is_axisymmetric:
            weight = 2.0 * np.pi * np.maximum(found.points[:, 1], 0.0) * weight
        velocity = found.at(cells, flow.velocity)
        parts.append((weight, velocity, found.at(cells, flow.pressure)))
    area = float(sum(weight.sum() for weight, _, _ in parts))
    if not area > 0.0:
        raise ValueError(f"{AXES[axis]} = {height:g} cuts no fluid of {run.path}")
    weight, velocity, pressure = (np.concatenate(one) for one in zip(*parts, strict=True))
    flux = float(weight @ velocity[:, axis])
    return {
        "area": area,
        "flux": flux,
        "mean_velocity": flux / area,
        "largest_speed": float(np.linalg.norm(velocity, axis=1).max()),
        "mean_pressure": float(weight @ pressure) / area,
    }


# ---- Decay ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Decay:
    """Speeds over distances, and the power of the distance they go with."""

    center: Array
    """`(d,)`."""
    distance: Array
    """`(n,)`."""
    speed: Array
    """Root mean square over the sphere, or circle, of each distance, `(n,)`."""
    exponent: float
    coefficient: float
    """The fitted speed is `coefficient * distance**exponent`."""
    misfit: float
    """Root mean square of the difference of logarithms."""


def decay(
    run: Run,
    *,
    around: str | None = None,
    nearest: float | None = None,
    farthest: float | None = None,
    time: float | None = None,
) -> Decay:
    """How the speed in the laboratory goes down with the distance from a body, or from all.

    The fit is over distances from `nearest` to `farthest`; without them from four times the reach
    of the bodies to 0.3 of the distance of the nearest side.
    """
    check_run(run)
    flow = fields.settled(run, run.field(time))
    center, reach = _middle(run, around, flow.time)
    center = center[: flow.nodes.shape[1]]
    cells = Cells(flow, run.case)
    first = NEAREST * reach if nearest is None else nearest
    last = FARTHEST * _room(cells, run, center) if farthest is None else farthest
    if not 0.0 < first < last:
        raise ValueError(
            f"no distances to fit from {first:.4g} to {last:.4g}: bodies reach {reach:.4g}, and "
            "the fluid is too small for a far field; --from and --to choose others"
        )
    radii = np.geomspace(first, last, RADII)
    speeds = np.array([_speed(run, cells, flow, center, radius) for radius in radii])
    kept = np.isfinite(speeds) & (speeds > 0.0)
    if kept.sum() < FEWEST:
        raise ValueError(
            f"{kept.sum()} of {RADII} distances from {first:.4g} to {last:.4g} are in the fluid "
            "all around and not at rest: that is no far field"
        )
    radii, speeds = radii[kept], speeds[kept]
    x, y = np.log(radii), np.log(speeds)
    exponent, offset = np.polyfit(x, y, 1)
    misfit = float(np.sqrt(np.mean((exponent * x + offset - y) ** 2)))
    return Decay(center, radii, speeds, float(exponent), float(np.exp(offset)), misfit)


def _middle(run: Run, around: str | None, time: float) -> tuple[Array, float]:
    placed = bodies.poses(run, time)
    names = list(placed) if around is None else bodies.followed(run, around)
    if not names:
        raise ValueError(f"{run.path} has no bodies whose far field could be measured")
    center = np.mean([placed[name][0] for name in names], axis=0)
    reach = max(
        float(np.linalg.norm(placed[name][0] - center)) + bodies.radius(run, name) for name in names
    )
    return center, reach


def _room(cells: Cells, run: Run, center: Array) -> float:
    """Distance of the nearest end of the fluid along the axes."""
    nodes = cells.field.nodes
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    if run.is_axisymmetric:
        low[1] = -high[1]
    return float(np.minimum(center - low, high - center).min())


def _speed(run: Run, cells: Cells, flow: Field, center: Array, radius: float) -> float:
    """Root mean square on a sphere or circle; not a number where that leaves the fluid."""
    found = cells.find(center + radius * directions(run))
    if not found.is_inside.all():
        return float("nan")
    size = (cells.at(found, flow.velocity) ** 2).sum(axis=1)
    return float(np.sqrt(size.mean()))


def directions(run: Run) -> Array:
    """Unit vectors of equal shares of a circle, of a sphere, or of half a circle about an axis."""
    n = DIRECTIONS[3 if run.is_spatial else 2]
    middle = (np.arange(n) + 0.5) / n
    if run.is_axisymmetric:
        # Equal areas of the sphere are equal lengths along its axis
        x = 1.0 - 2.0 * middle
        return np.column_stack([x, np.sqrt(1.0 - x**2)])
    if not run.is_spatial:
        angle = 2.0 * np.pi * middle
        return np.column_stack([np.cos(angle), np.sin(angle)])
    z = 1.0 - 2.0 * middle
    angle = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(n)
    r = np.sqrt(1.0 - z**2)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
