"""A case with its settings."""

from __future__ import annotations

import json
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from alewife.program import AlewifeWarning, call
from alewife.run import CaseRun, open_case_run

#: What a key of a case may be set to.
Value = bool | int | float | str | Sequence[Any] | Mapping[str, Any]


class Gradient(NamedTuple):
    """A quantity of a steady flow, and what it changes by with numbers of the case."""

    value: float
    #: Its derivative by the number of each key.
    by: dict[str, float]


@dataclass(frozen=True)
class Case:
    """A case: the name of a shipped one or a file, and keys that are set."""

    name: str
    settings: dict[str, Value] = field(default_factory=dict)

    def set(self, key: str | Mapping[str, Value], value: Value | None = None) -> Case:
        """Give a key, such as `fluid.viscosity` or `body.0.center`, or several, other values.

        The case itself stays as it is; the new one is returned.
        """
        new = dict(key) if isinstance(key, Mapping) else _one(key, value)
        if any(value is None for value in new.values()):
            raise TypeError(f"{' and '.join(new)}: a value is missing")
        for name, one in new.items():
            _check_setting(name, one)
        return Case(self.name, {**self.settings, **new})

    def arguments(self) -> list[str]:
        """Give what the command line says of this case: its name, and `--set` for each key."""
        settings = [f"{key}={to_toml(value)}" for key, value in self.settings.items()]
        return [self.name, *(part for setting in settings for part in ("--set", setting))]

    def check(self) -> str:
        """Read and mesh the case and return what there is to say of it; BadCaseError if wrong."""
        return call("check", *self.arguments())

    def gradient(self, of: str, by: Sequence[str]) -> Gradient:
        """Return a load, power or velocity of the steady flow, and its derivatives by some numbers.

        `of` is its column, such as `ball.force.x`, and `by` are keys of numbers that are written
        in the case. They cost little more than the flow, however many there are.
        """
        keys = ",".join([by] if isinstance(by, str) else by)
        found = json.loads(call("gradient", *self.arguments(), "--json", "--of", of, "--by", keys))
        quantity = found["quantities"][0]
        by_key = {entry["key"]: entry["derivative"] for entry in quantity["by"]}
        return Gradient(quantity["value"], by_key)

    def run(
        self,
        out: str | Path | None = None,
        *,
        threads: int | None = None,
        overwrite: bool = False,
        progress: bool = False,
    ) -> CaseRun:
        """Run the case into the directory `out` and open it.

        Without `out` the run is in a temporary directory, which goes away with the object that is
        returned. A run in `out` that was stopped continues; one of another case, or one that is
        finished, is refused unless `overwrite` is set. `progress` shows the program's messages.
        """
        kept = None
        if out is None:
            kept = tempfile.TemporaryDirectory(prefix="alewife-")
            out = Path(kept.name) / "run"
        options: list[str | Path] = ["--out", out]
        if threads is not None:
            options += ["--threads", str(threads)]
        if overwrite:
            options.append("--overwrite")
        if not progress:
            options.append("--quiet")
        call("run", *self.arguments(), *options, progress=progress)
        run = open_case_run(Path(out), kept)
        for one in run.warnings:
            times = f" ({one['count']} times)" if one["count"] > 1 else ""
            warnings.warn(one["message"] + times, AlewifeWarning, stacklevel=2)
        return run


def load(name: str | Path) -> Case:
    """Load a case: the name of a shipped one (`three-sphere`), a `NAME/VARIANT`, or a file.

    BadCaseError if there is none or if it is wrong.
    """
    call("check", "--no-mesh", str(name))
    return Case(str(name))


def _one(key: str, value: Value | None) -> dict[str, Value | None]:
    if not isinstance(key, str):
        raise TypeError(
            f"{key!r}: a key such as 'fluid.viscosity' and its value are accepted, or a dictionary"
        )
    return {key: value}


def _check_setting(key: object, value: Value) -> None:
    if not isinstance(key, str):
        raise TypeError(f"{key!r} is no key: a text such as 'fluid.viscosity' is accepted")
    try:
        to_toml(value)
    except TypeError as error:
        raise TypeError(f"{key}: {error}") from None


def to_toml(value: Value) -> str:
    """Write a value as TOML, on one line."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    if isinstance(value, Mapping):
        items = (f"{to_toml(str(key))} = {to_toml(item)}" for key, item in value.items())
        return f"{{ {', '.join(items)} }}"
    if isinstance(value, (Sequence, np.ndarray)) and not isinstance(value, (bytes, bytearray)):
        return f"[{', '.join(to_toml(item) for item in value)}]"
    raise TypeError(f"{value!r}: a number, a text, a truth value, a list or a mapping is accepted")
