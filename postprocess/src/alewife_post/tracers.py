"""Paths of particles as files, and as lines of a film: streak lines, or the end of each way."""

from __future__ import annotations

import csv
import io
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from alewife_post.carried import Paths
from alewife_post.periodic import trail
from alewife_post.planes import AXES
from alewife_post.read import Run
from alewife_post.whole import replacing

Array = np.ndarray

PATHS, PARTICLES, LINES = "paths.csv", "particles.csv", "paths.vtp"
"""Files of a directory."""
CARRIED = "tracers.pvd"
"""The list of a run with particles of its own."""
GAP = 2.0
"""Neighbours on a streak line that are so many times as far apart as usual are not joined."""
TAIL = 0.12
"""Part of the time of all paths that a particle has behind it, where there is no streak line."""


def write_paths(run: Run, found: Paths, out: Path) -> list[Path]:
    """Write all places, a row a particle, and lines for ParaView."""
    out.mkdir(parents=True, exist_ok=True)
    for name, text in ((PATHS, _places(found)), (PARTICLES, _particles(found))):
        with replacing(out / name) as unfinished:
            unfinished.write_text(text, encoding="utf-8")
    with replacing(out / LINES) as unfinished:
        _lines(run, found).save(unfinished)
    return [out / name for name in (PATHS, PARTICLES, LINES)]


def _places(found: Paths) -> str:
    names = AXES[: found.place.shape[2]]
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["seed", "released", "time", *names])
    for n in range(len(found.seed)):
        for time, place in zip(found.time, found.place[:, n], strict=True):
            if np.isfinite(place).all():
                numbers = [f"{value:.10g}" for value in (found.released[n], time, *place)]
                rows.writerow([found.seed[n], *numbers])
    return text.getvalue()


def _particles(found: Paths) -> str:
    names = AXES[: found.place.shape[2]]
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(
        ["seed", "released", "left", "residence", "stretching"]
        + [f"first.{name}" for name in names]
        + [f"last.{name}" for name in names]
    )
    for n in range(len(found.seed)):
        way = found.place[np.isfinite(found.place[:, n]).all(axis=1), n]
        ends = (way[0], way[-1]) if len(way) else (np.full(len(names), np.nan),) * 2
        values = [found.released[n], found.left[n], found.residence[n], found.stretching[n]]
        row = ["" if np.isnan(one) else f"{one:.10g}" for one in [*values, *ends[0], *ends[1]]]
        rows.writerow([found.seed[n], *row])
    return text.getvalue()


def _lines(run: Run, found: Paths):  # noqa: ANN202  (loads VTK)
    import pyvista

    points, cells, data, start = [], [], {"time": [], "seed": [], "stretching": []}, 0
    d = found.place.shape[2]
    for n in range(len(found.seed)):
        is_there = np.isfinite(found.place[:, n]).all(axis=1)
        way = np.zeros((is_there.sum(), 3))
        way[:, :d] = found.place[is_there, n]
        times = found.time[is_there]
        at = 0
        for piece in trail(run.case, way):
            k = len(piece)
            points.append(piece)
            cells.append(np.append(k, start + np.arange(k)))
            data["time"].append(times[at : at + k])
            data["seed"].append(np.full(k, found.seed[n]))
            data["stretching"].append(np.full(k, found.stretching[n]))
            start, at = start + k, at + k
    if not points:
        return pyvista.PolyData()
    mesh = pyvista.PolyData(np.concatenate(points), lines=np.concatenate(cells))
    for name, parts in data.items():
        mesh.point_data[name] = np.concatenate(parts)
    return mesh


@dataclass(frozen=True)
class Tracks:
    """Ways of particles as they were written."""

    seed: list[int]
    released: list[float]
    time: list[Array]
    """Of each, `(k,)`, increasing."""
    place: list[Array]
    """Of each, `(k, 3)`."""

    def shown(self, run: Run, time: float) -> tuple[list[Array], Array]:
        """Lines `(k, 3)` and particles `(n, 3)` at a time.

        Of places at which particles were released again and again lines are streak lines, of others
        the last part of the ways.
        """
        span = max(at[-1] for at in self.time) - min(at[0] for at in self.time)
        own = [n for n, at in enumerate(self.time) if at[0] <= time <= at[-1]]
        now = {n: _at(self.time[n], self.place[n], time) for n in own}
        lines = []
        if len(set(self.released)) > 1:
            for seed in dict.fromkeys(self.seed[n] for n in own):
                last = [n for n in own if self.seed[n] == seed]
                last.sort(key=lambda n: self.released[n])
                lines.append(np.array([now[n] for n in last]))
            lines = _parted(lines)
        else:
            for n in own:
                kept = (self.time[n] > time - TAIL * span) & (self.time[n] < time)
                lines.append(np.vstack([self.place[n][kept], now[n]]))
        parted = [piece for line in lines for piece in trail(run.case, line)]
        points = [piece[-1:] for n in own for piece in trail(run.case, now[n][None])]
        heads = np.concatenate(points) if points else np.zeros((0, 3))
        return [piece for piece in parted if len(piece) > 1], heads

    def still(self, run: Run, time: float | None) -> tuple[list[Array], Array]:
        """The same for a picture, at a time or at the last one: ways are whole up to then.

        Those of particles that have left the fluid are among them.
        """
        last = max(float(at[-1]) for at in self.time)
        now = last if time is None else time
        lines, heads = self.shown(run, now)
        if len(set(self.released)) > 1:
            return lines, heads
        whole = []
        for at, place in zip(self.time, self.place, strict=True):
            way = place[at <= now * (1 + 1e-12) + 1e-300]
            if at[0] < now < at[-1]:
                way = np.vstack([way, _at(at, place, now)])
            whole += [piece for piece in trail(run.case, way) if len(piece) > 1]
        return whole, heads

    def check_time(self, time: float, path: Path) -> None:
        """ValueError where no particle is known at a time."""
        first = min(float(at[0]) for at in self.time)
        last = max(float(at[-1]) for at in self.time)
        slack = 1e-9 * (abs(first) + abs(last))
        if not first - slack <= time <= last + slack:
            raise ValueError(
                f"t = {time:.6g} is not in {path}: its particles are known from t = {first:.6g} to "
                f"{last:.6g}"
            )


def _parted(lines: list[Array]) -> list[Array]:
    """Streak lines without the gaps between particles that the flow has taken far apart."""
    steps = [np.linalg.norm(np.diff(line, axis=0), axis=1) for line in lines]
    every = np.concatenate(steps) if steps else np.zeros(0)
    if not len(every):
        return lines
    most = GAP * float(np.median(every))
    return [
        piece
        for line, step in zip(lines, steps, strict=True)
        for piece in np.split(line, np.flatnonzero(step > most) + 1)
    ]


def _at(times: Array, places: Array, time: float) -> Array:
    return np.array([np.interp(time, times, places[:, axis]) for axis in range(3)])


def read_run(path: Path) -> Tracks:
    """The particles of `[[tracer]]` of a run, by the files of `tracers.pvd`."""
    import pyvista

    sets = ElementTree.parse(path / CARRIED).getroot().iter("DataSet")
    rows: dict[tuple[int, float, int], list[Array]] = {}
    for one in sets:
        file = path / one.attrib["file"]
        if not file.is_file():
            continue
        time, data = float(one.attrib["timestep"]), pyvista.read(file).point_data
        keys = zip(data["tracer"], data["released"], data["seed"], strict=True)
        for key, left, place in zip(keys, data["left"], data["position"], strict=True):
            if left == 0:
                row = np.append(time, place)
                rows.setdefault((int(key[0]), float(key[1]), int(key[2])), []).append(row)
    if not rows:
        raise ValueError(f"{path / CARRIED} has no particle in the fluid")
    # A seed is one place of one of several [[tracer]]
    seeds = {key: n for n, key in enumerate(dict.fromkeys((k[0], k[2]) for k in rows))}
    ways = [np.array(way) for way in rows.values()]
    return Tracks(
        [seeds[cloud, seed] for cloud, _, seed in rows],
        [released for _, released, _ in rows],
        [way[:, 0] for way in ways],
        [way[:, 1:] for way in ways],
    )


def read_paths(path: Path) -> Tracks:
    """What `write_paths` wrote, the directory or its table of places, or a run with tracers."""
    if (path / CARRIED).is_file():
        return read_run(path)
    path = path / PATHS if path.is_dir() else path
    if not path.is_file():
        raise FileNotFoundError(
            f"{path} does not exist: alewife-post trace writes it, and runs with [[tracer]] have "
            f"{CARRIED}"
        )
    table = np.genfromtxt(path, delimiter=",", names=True, ndmin=1)
    names = table.dtype.names or ()
    missing = {"seed", "released", "time", "x", "y"} - set(names)
    if missing or not len(table):
        what = f"has no column {', '.join(sorted(missing))}" if missing else "has no particle"
        raise ValueError(f"{path} {what}")
    place = np.zeros((len(table), 3))
    for axis, name in enumerate(AXES):
        if name in names:
            place[:, axis] = table[name]
    order = np.lexsort((table["time"], table["released"], table["seed"]))
    keys = np.column_stack([table["seed"], table["released"]])[order]
    cuts = np.flatnonzero((np.diff(keys, axis=0) != 0).any(axis=1)) + 1
    parts = np.split(order, cuts)
    return Tracks(
        [int(table["seed"][own[0]]) for own in parts],
        [float(table["released"][own[0]]) for own in parts],
        [table["time"][own] for own in parts],
        [place[own] for own in parts],
    )
