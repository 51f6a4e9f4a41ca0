"""A report of a run: one HTML file with a scene to turn, series, verdicts and how it was made."""

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

from alewife_post import figure, gallery, scene, scenery, series, stills, style, summary
from alewife_post.read import Run, check_run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = np.ndarray

STEPS = 65535
"""Places are written in so many steps over the extent of a part: thinner than any line."""
COLOURS = 256


def report(run: Run, time: float | None = None) -> str:
    """The page, which needs no network: all that it shows is in it.

    `time` is that of the scene, the last frame if absent.
    """
    check_run(run)
    run.check_flow()
    found = summary.summary(run)
    body = [f"<h1>{_text(run.title)}</h1>", _at_a_glance(found)]
    body += _scene(run, time)
    body += _series(run)
    body += _values(found)
    body += _references(found)
    body += _made(run)
    title = _text(run.title)
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
    parts = [_table((), plain)]
    parts += [f'<p class="warning">{_text(one)}</p>' for one in warnings]
    return "\n".join(parts)


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
    if not run.fields:
        said = "The run has no field files: output.fields of its case asks for them."
        return [f"<h2>Flow</h2><p>{_text(said)}</p>"]
    if time is not None:
        run.check_time(time)
    shown = scenery.scenery(run, time)
    at = f", {style.time_text(shown.time, run.units)}" if run.is_unsteady else ""
    on = f"Fluid on {shown.text}. " if shown.text else ""
    given = json.dumps(_given(run, shown), separators=(",", ":")).replace("<", "\\u003c")
    still = ""
    if scene.can_render():
        if run.is_spatial:
            drawn = stills.figure_of(run, shown)
        else:
            drawn = figure.picture(run, "speed", time=shown.time)
        png = base64.b64encode(gallery.small_png(drawn)).decode()
        still = f'<img alt="the flow" src="data:image/png;base64,{png}">'
    return [
        f"<h2>Flow{_text(at)}</h2>",
        '<div id="tools"></div>',
        '<div id="scene"><canvas></canvas><svg></svg></div>',
        f'<div id="still" hidden>{still}</div>',
        f'<div id="legends"></div><p>{_text(on)}Drag to turn, with the right button to shift; '
        "turn the wheel to enlarge.</p>",
        f'<script type="application/json" id="given">{given}</script>',
        f"<script>\n{_script('three.min.js')}</script>",
        f"<script>\n{_script('viewer.js')}</script>",
    ]


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
    chosen = {scenery.FLUID: "speed", scenery.BODIES: "pressure"}.get(part.name, "")
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


def _made(run: Run) -> list[str]:
    rows = []
    if (run.path / "provenance.json").is_file():
        rows = [
            (name, " ".join(map(str, value)) if isinstance(value, list) else value)
            for name, value in run.provenance.items()
            if not isinstance(value, dict) and name not in ("legs",)
        ]
    case = (run.path / "case.toml").read_text(encoding="utf-8")
    return [
        "<h2>How it was made</h2>",
        _table((), rows),
        f"<details><summary>case.toml, all defaults filled in</summary><pre>{_text(case)}</pre>"
        "</details>",
    ]
