"""A run at a glance: its case, state, cost, last values, references and files."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from alewife_post import asked, evidence, quantities
from alewife_post.read import Run

MOST_VALUES = 16
"""Quantities shown where the case has references for none."""
LEFT_OUT = ("angle", "acceleration", "surface_force", "surface_torque", "moment_coefficient")
"""Quantities of bodies that say little at a glance, with their components."""


def summary(run: Run) -> dict[str, Any]:
    """All of it, as JSON can hold it; what is not there yet is left out or `None`."""
    series = run.series if (run.path / "series.csv").is_file() else {"time": np.empty(0)}
    time = series["time"]
    found: dict[str, Any] = {"run": str(run.path), "title": run.title}
    found["case"] = _case(run)
    found["state"] = _state(run)
    found["program"] = _program(run)
    found["series"] = {
        "rows": len(time),
        "from": float(time[0]) if len(time) else None,
        "to": float(time[-1]) if len(time) else None,
        "quantities": [name for name in series if name != "time"],
    }
    found["fields"] = [frame.time for frame in run.frames]
    if len(time):
        start, end, what = evidence.cycle(run)
        found["averaged"] = {"from": start, "to": end, "what": what}
        found["values"] = [_value(series, name, start, end) for name in _shown(run)]
        found["defects"] = {
            name: float(np.nanmax(np.abs(values)))
            for name, values in series.items()
            if name.endswith("_defect") and np.isfinite(values).any()
        }
    found["references"] = [
        {key: one.get(key) for key in REFERENCE_KEYS} for one in evidence.comparisons(run)
    ]
    return found


REFERENCE_KEYS = (
    "quantity", "minus", "statistic", "at", "computed", "reference", "difference", "is_relative",
    "tolerance", "verdict", "kind", "source",
)  # fmt: skip


def _case(run: Run) -> dict[str, Any]:
    case = run.case
    return {
        "geometry": case["geometry"],
        "units": case.get("units"),
        "fluid": "soft" if "soft" in case else case.get("fluid", {}).get("model"),
        "time": next(iter(case.get("time", {"unsteady": {}})), None),
        "bodies": [body.get("name") for body in case.get("body", case.get("solid", []))],
        "swimmers": [swimmer.get("name") for swimmer in case.get("swimmer", [])],
    }


def _state(run: Run) -> dict[str, Any]:
    if not (run.path / "status.json").is_file():
        return {"state": "not begun"}
    status = run.status
    keys = ("state", "reason", "step", "time", "end", "dofs", "peak_memory", "updated_at")
    found = {key: status.get(key) for key in keys}
    for kind in ("cpu_seconds", "wall_seconds"):
        found[kind] = status.get(kind, {}).get("total")
    found["warnings"] = [one["message"] for one in run.warnings]
    found["restarts"] = status.get("restarts", {}).get("count")
    return found


def _program(run: Run) -> dict[str, Any]:
    if not (run.path / "provenance.json").is_file():
        return {}
    keys = ("alewife", "git", "threads", "host", "started_at", "case_hash")
    return {key: run.provenance.get(key) for key in keys}


def _shown(run: Run) -> list[str]:
    """Quantities with a reference, else those of bodies and swimmers that vary."""
    series = run.series
    of_references = evidence.compared(run)
    if of_references:
        return of_references
    own = [
        name
        for name, values in series.items()
        if name != "time"
        and not name.endswith(evidence.DEFECT)
        and asked.ending(name).split(".")[0] not in LEFT_OUT
        and np.isfinite(values).any()
        and (len(values) == 1 or np.nanmax(values) > np.nanmin(values))
    ]
    # The same quantity of all bodies before the next one.
    endings = list(dict.fromkeys(asked.ending(name) for name in own))
    return sorted(own, key=lambda name: endings.index(asked.ending(name)))[:MOST_VALUES]


def _value(series: dict[str, Any], name: str, start: float, end: float) -> dict[str, Any]:
    (line,) = asked.lines(series, name)
    kept = np.isfinite(line.values)
    time, values = series["time"][kept], line.values[kept]
    found: dict[str, Any] = {"quantity": name}
    if len(values) == 0:
        return found
    found |= {"final": float(values[-1]), "min": float(values.min()), "max": float(values.max())}
    late, of_late = quantities.within(time, values, start, end)
    if len(late):
        found["mean"] = quantities.mean(late, of_late)
    return found


# ---- Text ----------------------------------------------------------------------------------------


def as_text(found: dict[str, Any]) -> str:
    """The same to be read."""
    case, state, program = found["case"], found["state"], found["program"]
    lines = [found["title"], found["run"], ""]
    members = f"bodies: {_listed(case['bodies'])}" if case["bodies"] else "no bodies"
    if case["swimmers"]:
        members += f"; swimmers: {_listed(case['swimmers'])}"
    lines.append(f"case      {case['geometry']}, {case['fluid']}, {case['time']}; {members}")
    lines.append(f"state     {_state_text(state)}")
    if state.get("cpu_seconds") is not None:
        lines.append(f"cost      {_cost_text(state)}")
    lines += [f"warning   {message}" for message in state.get("warnings", [])]
    if program:
        lines.append(
            f"program   alewife {program['alewife']} ({program['git']}), "
            f"threads: {program['threads']}, begun {program['started_at']}"
        )
    series = found["series"]
    span = f", t = {series['from']:.6g} to {series['to']:.6g}" if series["rows"] else ""
    lines.append(f"series    {series['rows']} rows of {len(series['quantities'])} quantities{span}")
    fields = found["fields"]
    span = f", t = {fields[0]:.6g} to {fields[-1]:.6g}" if fields else ""
    lines.append(f"fields    {len(fields)} files{span}")
    if found.get("defects"):
        worst = (f"{name} {value:.1e}" for name, value in found["defects"].items())
        lines.append(f"defects   at most {', '.join(worst)}")
    if found.get("values"):
        averaged = found["averaged"]
        lines += ["", f"means over {averaged['what']}: t = {averaged['from']:.6g} to "
                  f"{averaged['to']:.6g}"]  # fmt: skip
        lines += _columns(found["values"], ("quantity", "final", "mean", "min", "max"))
    if found["references"]:
        lines += ["", _verdicts(found["references"])]
        lines += _columns(
            [reference_row(one) for one in found["references"]],
            ("quantity", "computed", "reference", "difference", "accepted", "verdict", "kind"),
        )
    return "\n".join(lines)


def _listed(names: list[str], most: int = 6) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(str(name) for name in names[:most]) + more


def _state_text(state: dict[str, Any]) -> str:
    text = state["state"] + (f" ({state['reason']})" if state.get("reason") else "")
    if state.get("time") is not None:
        text += f", t = {state['time']:.6g}"
    if state.get("end") is not None:
        text += f" of {state['end']:.6g}"
    if state.get("step") is not None:
        text += f", step {state['step']}"
    if state.get("restarts"):
        text += f", resumed {state['restarts']} times"
    return text


def _cost_text(state: dict[str, Any]) -> str:
    parts = [f"{state['cpu_seconds']:.4g} s of CPU"]
    if state.get("wall_seconds") is not None:
        parts.append(f"{state['wall_seconds']:.4g} s on the clock")
    if state.get("dofs"):
        parts.append(f"{state['dofs']} unknowns")
    if state.get("peak_memory"):
        parts.append(f"{state['peak_memory'] / 1e6:.0f} MB at most")
    return ", ".join(parts)


def _verdicts(references: Iterable[dict[str, Any]]) -> str:
    verdicts = [one["verdict"] for one in references]
    counts = (f"{verdicts.count(one)} {one}" for one in dict.fromkeys(verdicts))
    return f"{len(verdicts)} references: {', '.join(counts)}"


def reference_row(one: dict[str, Any]) -> dict[str, Any]:
    """A reference and what came of it, as a row of texts."""
    statistic = f"at {one['at']:g}" if one["statistic"] == "at" else one["statistic"]
    name = one["quantity"] + (f"{asked.MINUS}{one['minus']}" if one["minus"] else "")
    sign = " %" if one["is_relative"] else ""
    scale = 100.0 if one["is_relative"] else 1.0

    def share(value: float | None) -> str:
        return "" if value is None else f"{scale * value:.2g}{sign}"

    return {
        "quantity": f"{name}, {statistic}",
        "computed": one["computed"],
        "reference": one["reference"],
        "difference": share(one["difference"]),
        "accepted": share(one["tolerance"]),
        "verdict": one["verdict"],
        "kind": evidence.KINDS.get(one["kind"], one["kind"]),
    }


def _columns(rows: list[dict[str, Any]], names: tuple[str, ...]) -> list[str]:
    def cell(value: object) -> str:
        return "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)

    table = [list(names), *([cell(row.get(name)) for name in names] for row in rows)]
    widths = [max(len(row[nth]) for row in table) for nth in range(len(names))]
    words = ("quantity", "verdict", "kind")
    return [
        "  "
        + "  ".join(
            text.ljust(width) if name in words else text.rjust(width)
            for text, width, name in zip(row, widths, names, strict=True)
        ).rstrip()
        for row in table
    ]
