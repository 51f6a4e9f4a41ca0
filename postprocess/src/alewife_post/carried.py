"""Particles that a stored flow carries: paths, residence, stretching."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from alewife_post.cells import Cells
from alewife_post.periodic import wrapped
from alewife_post.quantities import speed
from alewife_post.read import Field, Run, check_run, read_field

Array = np.ndarray

STEP = 0.25
"""Length of a step over the size of cells, where most of the fluid is not faster."""
FAST = 2.0
"""Per cent of cells that are crossed faster."""
MOST_STEPS = 100_000
HALVINGS = 8
"""Of a step that ends outside of the fluid: so far particles are followed to where they leave."""
KEPT_FIELDS = 3


@dataclass(frozen=True)
class Paths:
    """Ways of particles, at times that all have in common."""

    time: Array
    """`(t,)`, in the order they were followed."""
    place: Array
    """`(t, n, d)`; not a number before a particle is released, and after it has left the fluid.

    Of a periodic domain a way goes on beyond the sides.
    """
    seed: Array
    """Number of the place each was released at, `(n,)`."""
    released: Array
    """Time of release, `(n,)`."""
    left: Array
    """Time at which it left the fluid, `(n,)`; not a number if it did not."""
    stretching: Array
    """Finite-time Lyapunov exponent, `(n,)`: growth rate of the distance of near particles."""

    @property
    def residence(self) -> Array:
        """Time each was in the fluid, `(n,)`."""
        return np.abs(np.where(np.isfinite(self.left), self.left, self.time[-1]) - self.released)


class StoredFlow:
    """The velocity of a run between its field files.

    Where the cells of two files are the same, nodes and velocities go linearly from one to the
    other: what is in a moving mesh stays beside its bodies. After remeshing both flows are taken at
    the place itself, and mixed; where one of them has a body there, the other alone counts.
    """

    def __init__(self, run: Run) -> None:
        """Files are read when they are needed."""
        self.run = run
        self.times = np.array([frame.time for frame in run.fields])
        self.read = lru_cache(KEPT_FIELDS)(self._read)
        self.cells = lru_cache(2 * KEPT_FIELDS)(self._cells)
        self.mixed = lru_cache(KEPT_FIELDS)(self._mixed)
        self.crossing = lru_cache(None)(self._crossing)
        self.before: Array | None = None

    def _read(self, number: int) -> Field:
        return read_field(self.run.fields[number].path)

    def _cells(self, number: int) -> Cells:
        return Cells(self.read(number), self.run.case)

    def around(self, time: float) -> tuple[int, int, float]:
        """Numbers of the files before and after a time, and the share of the second one."""
        if len(self.times) == 1:
            return 0, 0, 0.0
        after = int(np.clip(np.searchsorted(self.times, time), 1, len(self.times) - 1))
        first, last = self.times[after - 1 : after + 1]
        return after - 1, after, float(np.clip((time - first) / (last - first), 0.0, 1.0))

    def _mixed(self, first: int, last: int, share: float) -> Cells | None:
        """The mesh between two files of the same cells, with its velocity; else none."""
        one, other = self.read(first), self.read(last)
        if one.cells.shape != other.cells.shape or not np.array_equal(one.cells, other.cells):
            return None
        velocity = (1.0 - share) * one.velocity + share * other.velocity
        if np.array_equal(one.nodes, other.nodes):
            # One tree for all times
            known = self.cells(first)
            moved = Cells(replace(one, velocity=velocity), self.run.case)
            moved.__dict__.update({k: v for k, v in known.__dict__.items() if k not in OWN})
            return moved
        nodes = (1.0 - share) * one.nodes + share * other.nodes
        return Cells(replace(one, nodes=nodes, velocity=velocity), self.run.case)

    def at(self, points: Array, time: float) -> tuple[Array, Array]:
        """Velocity `(n, d)` and its gradient `(n, d, d)`; not a number outside of the fluid."""
        d = points.shape[1]
        sign = np.ones(points.shape)
        places = points
        if self.run.is_axisymmetric:
            sign[:, 1] = np.where(points[:, 1] < 0.0, -1.0, 1.0)
            places = points * sign
        whole = np.zeros((len(points), 3))
        whole[:, :d] = places
        places = wrapped(self.run.case, whole)[:, :d]
        first, last, share = self.around(time)
        mixed = self.mixed(first, last, share)
        if mixed is not None:
            velocity, gradient = self._of(mixed, places)
        else:
            velocity, gradient = self._of(self.cells(first), places)
            other, slope = self._of(self.cells(last), places)
            velocity, gradient = (
                np.where(np.isnan(a), b, np.where(np.isnan(b), a, (1.0 - share) * a + share * b))
                for a, b in ((velocity, other), (gradient, slope))
            )
        return velocity * sign, gradient * sign[:, :, None] * sign[:, None, :]

    def _of(self, cells: Cells, places: Array) -> tuple[Array, Array]:
        before = self.before
        if before is not None and len(before) != len(places):
            before = None
        found = cells.find(places, before)
        self.before = found.cell
        velocity = cells.field.velocity
        return cells.at(found, velocity), cells.gradient(found, velocity)

    def _crossing(self, number: int) -> tuple[float, float]:
        """Time in which the fluid of a file crosses a part of a cell, and the size of that cell."""
        field = self.read(number)
        size = np.ptp(field.nodes[field.cells], axis=1).min(axis=1)
        fast = speed(field.velocity)[field.cells].max(axis=1)
        moving = np.flatnonzero(fast > 0.0)
        if not len(moving):
            return np.inf, np.inf
        crossing = size[moving] / fast[moving]
        wanted = float(np.percentile(crossing, FAST))
        nearest = moving[np.argmin(np.abs(crossing - wanted))]
        return STEP * wanted, float(size[nearest])

    def usual_step(self, time: float) -> tuple[float, int]:
        """The step around a time, of the two files beside it, and the file that has it."""
        first, last, _ = self.around(time)
        return min((self.crossing(number)[0], number) for number in (first, last))


OWN = ("field", "case")


def carried(
    run: Run,
    seeds: Array,
    *,
    start: float,
    end: float,
    outputs: int = 100,
    step: float | None = None,
    release: float | None = None,
) -> Paths:
    """Follow particles from places `(n, d)` and a time to another one, which may be earlier.

    By the method of Runge and Kutta of fourth order, with steps of `step` at most that end at field
    files; without it, between two files, of a part of their cells over the velocity there. The
    is quadratic in cells and linear in time between files. With `release` particles begin at the
    same places again and again, so much time apart: those of one place are a streak line.
    """
    check_run(run)
    flow = StoredFlow(run)
    if not len(flow.times):
        raise FileNotFoundError(f"{run.path} has no field files: see output.fields of its case")
    time = np.linspace(start, end, outputs + 1)
    way = 1.0 if end > start else -1.0
    releases = np.array([start])
    if release is not None:
        releases = start + way * np.arange(0.0, abs(end - start) * (1 - 1e-12), release)
    seed = np.tile(np.arange(len(seeds)), len(releases))
    released = np.repeat(releases, len(seeds))
    swarm = _Swarm(flow, np.tile(np.asarray(seeds, dtype=float), (len(releases), 1)), released, way)
    place = [swarm.shown(start)]
    stops = np.unique(np.concatenate([time, releases, flow.times]))
    stops = stops[(stops >= min(start, end)) & (stops <= max(start, end))]
    stops = stops if way > 0.0 else stops[::-1]
    counts = _counts(flow, stops, step)
    wanted = 1
    for (before, after), n in zip(pairwise(stops), counts, strict=True):
        for k in range(n):
            swarm.advance(before + k * (after - before) / n, (after - before) / n)
        if wanted < len(time) and abs(after - time[wanted]) <= 1e-12 * (abs(end) + abs(start)):
            place.append(swarm.shown(float(after)))
            wanted += 1
    return Paths(time, np.array(place), seed, released, swarm.left, swarm.stretching(end))


def _counts(flow: StoredFlow, stops: Array, step: float | None) -> list[int]:
    """Steps between stops; ValueError where they are too many, which says what asks for them."""
    spans = np.abs(np.diff(stops))
    if step is not None:
        most, files = np.full(len(spans), step), []
    else:
        usual = [flow.usual_step(0.5 * (before + after)) for before, after in pairwise(stops)]
        most, files = np.array([one for one, _ in usual]), [number for _, number in usual]
    if (most > 0.0).all():
        exact = spans / most
        if exact.sum() <= MOST_STEPS:
            return np.maximum(1, np.ceil(exact - 1e-9)).astype(int).tolist()
    else:
        exact = np.where(most > 0.0, 0.0, np.inf)
    text = (
        f"{exact.sum():.3g} steps from t = {stops[0]:g} to {stops[-1]:g}: at most {MOST_STEPS} are "
        "made"
    )
    if step is not None:
        raise ValueError(f"{text}; --step sets another one than {step:g}")
    worst = int(np.argmax(exact))
    frame = flow.run.fields[files[worst]]
    raise ValueError(
        f"{text}; steps of {most[worst]:.3g} between t = {stops[worst]:g} and "
        f"{stops[worst + 1]:g} are a quarter of the time to cross cells of "
        f"{flow.crossing(files[worst])[1]:.3g} in {frame.path}, t = {frame.time:g}: --from and "
        f"--to leave it out, --step sets another step"
    )


class _Swarm:
    """Particles under way."""

    def __init__(self, flow: StoredFlow, place: Array, released: Array, way: float) -> None:
        n, d = place.shape
        self.flow, self.place, self.released, self.way = flow, place, released, way
        self.left = np.full(n, np.nan)
        self.deformed = np.tile(np.eye(d), (n, 1, 1))

    def is_out(self, time: float) -> Array:
        """Which are released and have not left."""
        return (self.way * (time - self.released) >= -1e-12 * (1 + abs(time))) & np.isnan(self.left)

    def shown(self, time: float) -> Array:
        return np.where(self.is_out(time)[:, None], self.place, np.nan)

    def advance(self, time: float, step: float) -> None:
        own = np.flatnonzero(self.is_out(time))
        if not len(own):
            return
        at = np.full(len(own), time)
        place, deformed, is_in = self._stepped(own, time, step)
        self.place[own[is_in]], self.deformed[own[is_in]] = place[is_in], deformed[is_in]
        own, at = own[~is_in], at[~is_in]
        # Those that leave are followed by shorter and shorter steps, each from where it is
        for _ in range(HALVINGS):
            step = 0.5 * step
            for nth, one in enumerate(own):
                place, deformed, is_in = self._stepped(own[nth : nth + 1], float(at[nth]), step)
                if is_in[0]:
                    self.place[one], self.deformed[one] = place[0], deformed[0]
                    at[nth] += step
        self.left[own] = at

    def _stepped(self, own: Array, time: float, step: float) -> tuple[Array, Array, Array]:
        """Places and deformations after a step, and which of them are in the fluid."""
        place, deformed = self.place[own], self.deformed[own]
        total, bent = np.zeros(place.shape), np.zeros(deformed.shape)
        k, slope = np.zeros(place.shape), np.zeros(deformed.shape)
        for share, weight in ((0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)):
            at = place + share * step * k
            k, gradient = self.flow.at(at, time + share * step)
            slope = gradient @ (deformed + share * step * slope)
            total, bent = total + weight * k, bent + weight * slope
        after = place + step / 6.0 * total
        is_in = np.isfinite(after).all(axis=1)
        # The end has to be in the fluid as well
        ends, _ = self.flow.at(np.where(is_in[:, None], after, place), time + step)
        return after, deformed + step / 6.0 * bent, is_in & np.isfinite(ends).all(axis=1)

    def stretching(self, end: float) -> Array:
        last = np.where(np.isfinite(self.left), self.left, end)
        span = np.abs(last - self.released)
        largest = np.linalg.norm(self.deformed, ord=2, axis=(1, 2))
        return np.where(span > 0.0, np.log(largest) / np.where(span > 0.0, span, 1.0), np.nan)


def in_fluid(run: Run, places: Array, time: float) -> Array:
    """Those of some places that are in the fluid at a time; ValueError where none is."""
    velocity, _ = StoredFlow(run).at(places, time)
    kept = places[np.isfinite(velocity).all(axis=1)]
    if not len(kept):
        raise ValueError(f"none of {len(places)} places is in the fluid at t = {time:g}")
    return kept


# ---- Seeds ---------------------------------------------------------------------------------------


def seeds(text: str, n: int, d: int) -> Array:
    """Places `(k, d)`: `box=x0,x1,y0,y1`, `line=x0,y0,x1,y1` or a CSV file with columns x, y (, z).

    About `n` of a box, evenly spaced; `n` of a line with both its ends.
    """
    kind, found, rest = text.partition("=")
    if found and kind in ("box", "line"):
        try:
            numbers = np.array([float(one) for one in rest.split(",")])
        except ValueError:
            numbers = np.zeros(0)
        if len(numbers) != 2 * d or not np.isfinite(numbers).all():
            wanted = ",".join(f"{axis}0,{axis}1" for axis in "xyz"[:d])
            if kind == "line":
                wanted = ",".join(f"{axis}{end}" for end in (0, 1) for axis in "xyz"[:d])
            raise ValueError(f"{text}: write {2 * d} numbers, {kind}={wanted}")
        return _box(numbers.reshape(d, 2), n) if kind == "box" else _line(numbers.reshape(2, d), n)
    path = Path(text)
    if not path.is_file():
        raise FileNotFoundError(
            f"{text} is no file, and neither box=... nor line=...: places to begin at"
        )
    table = np.genfromtxt(path, delimiter=",", names=True, ndmin=1)
    missing = set("xyz"[:d]) - set(table.dtype.names or ())
    if missing:
        raise ValueError(f"{path} has no column {', '.join(sorted(missing))}")
    return np.column_stack([table[axis] for axis in "xyz"[:d]]).astype(float)


def _line(ends: Array, n: int) -> Array:
    return ends[0] + np.linspace(0.0, 1.0, n)[:, None] * (ends[1] - ends[0])


def _box(ends: Array, n: int) -> Array:
    across = ends[:, 1] - ends[:, 0]
    if (across < 0.0).any():
        raise ValueError("a box begins at its lower end along each axis")
    flat = across == 0.0
    room = np.prod(across[~flat]) if (~flat).any() else 1.0
    spacing = (room / n) ** (1.0 / max(1, (~flat).sum()))
    counts = [max(1, round(side / spacing)) for side in across]
    sides = [
        low + (np.arange(k) + 0.5) / k * side
        for low, side, k in zip(ends[:, 0], across, counts, strict=True)
    ]
    return np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, len(ends))
