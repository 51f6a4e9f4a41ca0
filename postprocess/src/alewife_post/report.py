"""Reports of runs and searches: one HTML file with a scene, series, verdicts, how it was made."""

from __future__ import annotations

import base64
import html
import json
import zlib
from collections.abc import Iterable
from importlib import resources
from io import BytesIO
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np

from alewife_post import (
    calibration,
    evidence,
    figure,
    gallery,
    records,
    scene,
    scenery,
    searches,
    series,
    soft,
    soft_scene,
    stills,
    style,
    summary,
)
from alewife_post.read import Run, check_run, open_run

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.figure import Figure

Array = np.ndarray

STEPS = 65535
"""Places are written in so many steps over the extent of a part: thinner than any line."""
COLOURS = 256
CHOSEN = {
    scenery.FLUID: "speed",
    scenery.BODIES: "pressure",
    soft_scene.BODY: soft_scene.QUANTITIES[0],
}
"""What parts are coloured by at first."""


def report(run: Run, time: float | None = None) -> str:
    """The page, which needs no network: all that it shows is in it.

    `time` is that of the scene, the last frame if absent.
    """
    check_run(run)
    found = summary.summary(run)
    body = [_at_a_glance(found)]
    body += _scene(run, time)
    body += _series(run)
    body += _tracks(run)
    body += _values(found)
    body += _references(found)
    body += _made(run.path)
    return _page(run.title, body)


def search_report(path: Path) -> str:
    """The page of a finished search: its numbers, how they were found, what they are worth."""
    search = searches.open_search(path)
    found = search.report
    word = "objective" if search.is_large else "loss"
    rows = [
        ("search", search.kind), ("evaluations", found["evaluations"]), ("ended", found["ended"]),
        (f"{word} at the start", found["start"]), (word, found["objective"]),
    ]  # fmt: skip
    body = [_table((), rows), *_warnings(searches.warnings(search))]
    names = ("number", "start", "found", "at least", "at most", "reach", "slope", "determined")
    numbers = [
        (one["name"], one["start"], one["value"], *one["bounds"], one.get("reach"),
         one.get("slope"), "yes" if one["determined"] else "no")
        for one in search.parameters
    ]  # fmt: skip
    said = (
        f"Reach: how far a number, by its scale or as a logarithm, may go before the {word} is "
        "worse by 5 % of that at the start, the others following."
    )
    body += ["<h2>Numbers</h2>", _table(names, numbers), f"<p>{_text(said)}</p>"]
    if len(search.objectives):
        body += ["<h2>Evaluations</h2>", _svg(searches.search_figure(search))]
    body += _references({"references": [evidence.of_soft(one) for one in found["comparison"]]})
    return _page(search.title, body + _made(path))


def calibration_report(path: Path) -> str:
    """The page of a calibrated reduced model: its coefficients, its tracks, its errors."""
    found = calibration.open_calibration(path)
    facts = found.facts
    plain = [(name, value) for name, value in facts.items() if not _is_table(value)]
    coefficients = facts.get("coefficient", [])
    doubts = [f"{one['name']}: {one['doubt']}" for one in coefficients if one.get("doubt")]
    body = [_table((), [(name, _listed(value)) for name, value in plain]), *_warnings(doubts)]
    names = ("coefficient", "found", "uncertainty", "at least", "at most")
    rows = [
        (one["name"], one["value"], one.get("uncertainty"), *one.get("bounds", (None, None)))
        for one in coefficients
    ]
    body += ["<h2>Coefficients</h2>", _table(names, rows)]
    body += ["<h2>Tracks and errors</h2>", _svg(calibration.calibration_figure(found))]
    names = ("from", "held out", "quantity", "model", "recorded", "relative")
    rows = [
        (one["from"], "yes" if one["holdout"] else "no", one["quantity"], one["model"],
         one["recorded"], one["relative"])
        for one in facts.get("error", [])
    ]  # fmt: skip
    body += [_table(names, rows), *_made(path)]
    return _page(f"Calibration of {facts.get('case', path.resolve().name)}", body)


def report_of(path: Path, time: float | None = None) -> str:
    """The page of a directory of a run, a search or a calibration."""
    if searches.is_search(path) or (path / "calibrated.toml").is_file():
        if time is not None:
            raise ValueError(f"{path} is a search, which has no scene: leave --time out")
        is_one = searches.is_search(path)
        return search_report(path) if is_one else calibration_report(path)
    return report(open_run(path), time)


def _is_table(value: object) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _listed(value: object) -> object:
    return ", ".join(map(str, value)) if isinstance(value, list) else value


def _page(title: str, body: list[str]) -> str:
    title = _text(title)
    body = [f"<h1>{title}</h1>", *body]
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>\n{_file('page.css')}</style></head>\n<body>\n"
        + "\n".join(body)
        + "\n</body></html>\n"
    )


def _text(value: object) -> str:
    return html.escape(str(value))


def _file(name: str) -> str:
    return (resources.files("alewife_post") / "browser" / name).read_text(encoding="utf-8")


# ---- State and warnings --------------------------------------------------------------------------


def _at_a_glance(found: dict[str, Any]) -> str:
    """State and cost, and what the run warned of."""
    lines = summary.as_text(found).splitlines()
    # The head of the summary, down to the tables
    end = lines.index("", 3) if "" in lines[3:] else len(lines)
    rows = [line.partition(" ") for line in lines[3:end]]
    plain = [(name, rest.strip()) for name, _, rest in rows if name != "warning"]
    warnings = [rest.strip() for name, _, rest in rows if name == "warning"]
    return "\n".join([_table((), plain), *_warnings(warnings)])


def _warnings(texts: Iterable[str]) -> list[str]:
    return [f'<p class="warning">{_text(one)}</p>' for one in texts]


def _table(names: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    head = "".join(f"<th>{_text(name)}</th>" for name in names)
    lines = [f"<tr>{head}</tr>"] if head else []
    for row in rows:
        lines.append("<tr>" + "".join(map(_cell, row)) + "</tr>")
    return "<table>" + "\n".join(lines) + "</table>"


def _cell(value: object) -> str:
    if value is None:
        return "<td></td>"
    if isinstance(value, float):
        return f'<td class="number">{value:.6g}</td>'
    if value in ("within", "outside") or str(value).startswith("outside"):
        kind = "within" if value == "within" else "outside"
        return f'<td class="{kind}">{_text(value)}</td>'
    return f"<td>{_text(value)}</td>"


# ---- The scene -----------------------------------------------------------------------------------


def _scene(run: Run, time: float | None) -> list[str]:
    head = "Body" if soft.is_soft(run) else "Flow"
    if not run.frames:
        if _is_reduced(run):
            return []
        said = "The run has no field files: output.fields of its case asks for them."
        return [f"<h2>{head}</h2><p>{_text(said)}</p>"]
    if time is not None:
        run.check_time(time)
    made = soft_scene.soft_scenery if soft.is_soft(run) else scenery.scenery
    shown = made(run, time)
    at = f", {style.time_text(shown.time, run.units)}" if run.is_unsteady else ""
    on = f"Fluid on {shown.text}. " if shown.text else ""
    given = json.dumps(_given(run, shown), separators=(",", ":")).replace("<", "\\u003c")
    still = ""
    if scene.can_render():
        if soft.is_soft(run):
            drawn = soft.picture(run, time=shown.time)
        elif run.is_spatial:
            drawn = stills.figure_of(run, shown)
        else:
            drawn = figure.picture(run, "speed", time=shown.time)
        png = base64.b64encode(gallery.small_png(drawn)).decode()
        still = f'<img alt="{head.lower()}" src="data:image/png;base64,{png}">'
    return [
        f"<h2>{head}{_text(at)}</h2>",
        '<div id="tools"></div>',
        '<div id="scene"><canvas></canvas><svg></svg></div>',
        f'<div id="still" hidden>{still}</div>',
        f'<div id="legends"></div><p>{_text(on)}Drag to turn, with the right button to shift; '
        "turn the wheel to enlarge.</p>",
        f'<script type="application/json" id="given">{given}</script>',
        f"<script>\n{_script('three.min.js')}</script>",
        f"<script>\n{_script('viewer.js')}</script>",
    ]


def _is_reduced(run: Run) -> bool:
    """Whether a run is one of a reduced model, which has no fields."""
    return (run.path / "status.json").is_file() and run.status.get("fidelity") == "reduced"


def _script(name: str) -> str:
    # What would end the script within a text of it
    return _file(name).replace("</script", "<\\/script")


def _given(run: Run, shown: scenery.Scenery) -> dict[str, Any]:
    right = np.cross(shown.up, shown.towards)
    right = right / np.linalg.norm(right)
    across = np.array([right, np.cross(shown.towards, right)])
    # A page about the plane has the view of its picture
    seen = [part.points for part in shown.parts] if run.is_spatial else [shown.box]
    places = np.vstack(seen) @ across.T
    low, high = places.min(axis=0), places.max(axis=0)
    focus = shown.box.mean(axis=0)
    focus = focus + (0.5 * (low + high) - focus @ across.T) @ across
    half = 0.5 * (high - low)
    # 2 % around it are free
    return {
        "is_spatial": run.is_spatial,
        "focus": focus.tolist(),
        "half": (1.02 * half).tolist(),
        "radius": float(np.linalg.norm(np.ptp(shown.box, axis=0))),
        "towards": np.asarray(shown.towards).tolist(),
        "up": np.asarray(shown.up).tolist(),
        "parts": [_part(run, shown, part) for part in shown.parts],
    }


def _part(run: Run, shown: scenery.Scenery, part: scenery.Part) -> dict[str, Any]:
    low, high = part.points.min(axis=0), part.points.max(axis=0)
    extent = np.maximum(high - low, 1e-300)
    steps = np.round(STEPS * (part.points - low) / extent).astype("<u2")
    quantities = {
        name: _quantity(run, values, shown.scales[part.name, name], name)
        for name, values in part.values.items()
    }
    chosen = CHOSEN.get(part.name, "")
    return {
        "name": part.name,
        "is_lines": part.cells.shape[1] == 2,
        "colour": part.colour,
        "opacity": part.opacity,
        "low": low.tolist(),
        "extent": extent.tolist(),
        "points": _packed(steps),
        "cells": _packed(part.cells.astype("<u4")),
        "quantities": quantities,
        "chosen": chosen,
    }


def _quantity(run: Run, values: Array, scale: scenery.Scale, name: str) -> dict[str, Any]:
    low, high = scale.limits
    share = np.clip((values - low) / ((high - low) or 1.0), 0.0, 1.0)
    colours = matplotlib.colormaps[scale.colour_map](np.linspace(0.0, 1.0, COLOURS))
    return {
        "label": style.label(name, run.units),
        "low": f"{low:.3g}",
        "high": f"{high:.3g}",
        "note": style.beyond(name, scale.limits, scale.ends, scale.tail),
        "colours": [matplotlib.colors.to_hex(one) for one in colours],
        "values": _packed(np.round((COLOURS - 1) * share).astype("u1")),
    }


def _packed(numbers: Array) -> str:
    return base64.b64encode(zlib.compress(np.ascontiguousarray(numbers).tobytes(), 9)).decode()


# ---- Series, values, references ------------------------------------------------------------------


def _series(run: Run) -> list[str]:
    if not (run.path / "series.csv").is_file() or len(run.series["time"]) < 2:
        return []
    try:
        drawn = series.series_figure(run)
    except (KeyError, ValueError) as error:
        return [f"<h2>Series</h2><p>{_text(error)}</p>"]
    return ["<h2>Series</h2>", _svg(drawn)]


def _tracks(run: Run) -> list[str]:
    """Recorded places of markers beside those of the run."""
    recorded = records.records(run)
    if not recorded:
        return []
    drawn, rows = series.stacked(len(recorded), "")
    for axes, one in zip(rows, recorded, strict=True):
        records.draw_record(axes, one)
        curve = (run.series["time"], run.series[one.name])
        series.draw(axes, curve, colour=style.SERIES[0], label="run")
        axes.set_ylabel(style.length_label(one.name, run.units))
        axes.legend(loc="best", fontsize="small")
    rows[-1].set_xlabel("time (s)")
    return ["<h2>Markers and their record</h2>", _svg(drawn)]


def _svg(drawn: Figure) -> str:
    """A figure as an image: within the page, names of its parts would be those of others."""
    with matplotlib.rc_context({"svg.hashsalt": "alewife"}):
        written = BytesIO()
        drawn.savefig(written, format="svg", bbox_inches="tight", metadata={"Date": None})
    text = base64.b64encode(written.getvalue()).decode()
    return f'<img alt="series" src="data:image/svg+xml;base64,{text}">'


def _values(found: dict[str, Any]) -> list[str]:
    if not found.get("values"):
        return []
    names = ("quantity", "final", "mean", "min", "max")
    averaged = found["averaged"]
    said = f"Means over {averaged['what']}: t = {averaged['from']:.6g} to {averaged['to']:.6g}."
    rows = [[one.get(name) for name in names] for one in found["values"]]
    if found.get("defects"):
        worst = (f"{name} {value:.1e}" for name, value in found["defects"].items())
        said += f" Defects at most {', '.join(worst)}."
    return ["<h2>Values</h2>", f"<p>{_text(said)}</p>", _table(names, rows)]


def _references(found: dict[str, Any]) -> list[str]:
    if not found["references"]:
        return []
    names = ("quantity", "computed", "reference", "difference", "accepted", "verdict", "kind",
             "source")  # fmt: skip
    rows = []
    for one in found["references"]:
        row = {**one, **summary.reference_row(one)}
        rows.append([row.get(name) for name in names])
    return ["<h2>References</h2>", _table(names, rows)]


def _made(path: Path) -> list[str]:
    rows = []
    if (path / "provenance.json").is_file():
        made = json.loads((path / "provenance.json").read_text(encoding="utf-8"))
        rows = [
            (name, " ".join(map(str, value)) if isinstance(value, list) else value)
            for name, value in made.items()
            if not isinstance(value, dict) and name not in ("legs",)
        ]
    elif (path / searches.JOURNAL).is_file():
        with (path / searches.JOURNAL).open(encoding="utf-8") as journal:
            rows = [("search", journal.readline().strip())]
    body = ["<h2>How it was made</h2>", _table((), rows)]
    for name, what in (("case.toml", ", all defaults filled in"), ("calibrated.toml", "")):
        if (path / name).is_file():
            text = _text((path / name).read_text(encoding="utf-8"))
            body.append(f"<details><summary>{name}{what}</summary><pre>{text}</pre></details>")
    return body
