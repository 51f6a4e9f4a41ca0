"""Figures of a calibration: tracks over tracks, and errors by quantity and run."""

from __future__ import annotations

import csv
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from alewife_post import style

Array = np.ndarray

MOST_TRACKS = 6
"""Tracks that are drawn, the fitted ones first."""
ERRORS = ("in all", "apart, rms", "cycle.speed", "cycle.power", "way", "yaw")
"""Endings of the quantities whose errors are drawn."""


@dataclass(frozen=True)
class Track:
    """A track of a record over that of the model."""

    record: str
    is_held_out: bool
    name: str
    times: Array
    """Seconds, `(n,)`."""
    model: Array
    """By the model (m, rad), `(n,)`."""
    recorded: Array
    """As it was, `(n,)`."""


@dataclass(frozen=True)
class Calibration:
    """What `alewife calibrate` wrote about a reduced model."""

    path: Path
    facts: Mapping[str, Any]
    """The table `calibrated` of `calibrated.toml`."""
    tracks: list[Track]


def open_calibration(path: str | Path) -> Calibration:
    """Open a directory of `alewife calibrate`."""
    path = Path(path)
    for name in ("calibrated.toml", "tracks.csv"):
        if not (path / name).is_file():
            raise FileNotFoundError(
                f"{path} is no calibration of a reduced model: it has no {name}; write it by "
                "alewife calibrate CASE --out DIR"
            )
    file = tomllib.loads((path / "calibrated.toml").read_text(encoding="utf-8"))
    if "calibrated" not in file:
        raise ValueError(f"{path / 'calibrated.toml'} has no table [calibrated]")
    return Calibration(path, file["calibrated"], _tracks(path / "tracks.csv"))


def _tracks(path: Path) -> list[Track]:
    rows: dict[tuple[str, bool, str], list[tuple[float, float, float]]] = {}
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        wanted = {"from", "holdout", "track", "time", "model", "recorded"}
        if not wanted <= set(reader.fieldnames or ()):
            raise ValueError(f"{path} does not have the columns {', '.join(sorted(wanted))}")
        for row in reader:
            key = (row["from"], row["holdout"] == "true", row["track"])
            numbers = (float(row["time"]), float(row["model"]), float(row["recorded"]))
            rows.setdefault(key, []).append(numbers)
    return [Track(*key, *np.array(values).T) for key, values in rows.items()]


def calibration_figure(calibration: Calibration) -> Figure:
    """Tracks of records over those of the model, and errors, fitted and held out in two colours."""
    style.use()
    tracks = sorted(calibration.tracks, key=lambda track: track.is_held_out)[:MOST_TRACKS]
    if not tracks:
        raise ValueError(f"{calibration.path} has no tracks")
    figure = Figure(figsize=(6.4, 3.0 + 1.9 * len(tracks)), layout="constrained")
    heights = [1.0] * len(tracks) + [1.3]
    rows = list(figure.subplots(len(tracks) + 1, 1, height_ratios=heights, squeeze=False)[:, 0])
    title = str(calibration.facts.get("case", ""))
    figure.suptitle(title, fontsize=style.PARAMETERS["axes.titlesize"])
    for axes, track in zip(rows, tracks, strict=False):
        colour = _colour(track.is_held_out)
        axes.plot(track.times, track.recorded, color=style.REFERENCE, lw=2.4, label="recorded")
        axes.plot(track.times, track.model, "--", color=colour, lw=1.2, label="model")
        axes.set_ylabel(f"{track.name} ({'rad' if track.name.endswith('.angle') else 'm'})")
        axes.set_title(_title(track.record, track.is_held_out), fontsize="small", loc="left")
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(loc="best", fontsize="small")
    rows[len(tracks) - 1].set_xlabel("time (s)")
    _errors(rows[-1], calibration)
    return figure


def _title(record: str, is_held_out: bool) -> str:
    return f"{record}, {'held out' if is_held_out else 'fitted'}"


def _colour(is_held_out: bool) -> str:
    return style.SERIES[1 if is_held_out else 0]


def errors(calibration: Calibration) -> list[Mapping[str, Any]]:
    """Rows of the errors that are drawn: `from`, `holdout`, `quantity`, `relative`."""
    rows = calibration.facts.get("error", [])
    return [row for row in rows if str(row["quantity"]).endswith(ERRORS)]


def _errors(axes: Axes, calibration: Calibration) -> None:
    rows = sorted(errors(calibration), key=lambda row: (row["holdout"], row["from"]))
    places = np.arange(len(rows))
    for is_held_out in (False, True):
        own = [k for k, row in enumerate(rows) if row["holdout"] is is_held_out]
        sizes = [100 * abs(float(rows[k]["relative"])) for k in own]
        label = "held out" if is_held_out else "fitted"
        axes.bar(places[own], sizes, color=_colour(is_held_out), label=label)
    axes.set_xlim(-0.6, len(rows) - 0.4)
    names = [f"{row['quantity']}\n{row['from']}" for row in rows]
    axes.set_xticks(places, names, rotation=60, ha="right", fontsize="x-small")
    axes.set_ylabel("error (%)")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(loc="best", fontsize="small")
