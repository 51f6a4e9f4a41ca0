"""Sessions: a run that waits for what is asked of it, in this process."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType, TracebackType
from typing import TYPE_CHECKING, Any, Self, TypeVar

import numpy as np

from alewife.case import Case
from alewife.program import AlewifeWarning, error_of

if TYPE_CHECKING:
    import numpy.typing as npt

    #: A quantity, or a field.
    Observed = float | npt.NDArray[Any]

T = TypeVar("T")

#: What `Session.observe` calls the fields: arrays with a row a node, or a cell.
FIELDS = ("nodes", "velocity", "pressure", "cells")


@dataclass(frozen=True)
class State:
    """A state of a session, to go back to or to write to a file."""

    _inner: Any

    @property
    def time(self) -> float:
        """Time (s)."""
        return self._inner.time

    def write(self, path: str | Path) -> None:
        """Write it to a file, from which `alewife run --resume` and sessions continue."""
        _call(self._inner.write, str(path))


class Session:
    """A run that waits: strokes that are a `command` do what is asked for, step by step.

    It is open from the beginning, at time 0 with the flow there, and closed by `with` or `close`.
    Times are those of the case; several sessions may be open at once, each in a thread of its own.
    """

    def __init__(self, inner: object) -> None:
        """Take over a session of the extension module; `session` opens one."""
        self._inner = inner

    def command(self, name: str | Mapping[str, float], target: float | None = None) -> None:
        """Ask for a target of a command from now on, or for targets of several by their names.

        A target is clipped to the limits of the command, and followed through its filter.
        """
        targets = name if isinstance(name, Mapping) else {name: target}
        for one, value in targets.items():
            if not isinstance(one, str) or value is None:
                raise TypeError(f"{one!r}: the name of a command and a number are accepted")
        _call(self._inner.command, [(one, float(value)) for one, value in targets.items()])

    def advance(self, duration: float) -> None:
        """Make steps for a time (s); see `advance_to`."""
        self.advance_to(self.time + float(duration))

    def advance_to(self, time: float) -> None:
        """Make steps up to a time (s), at which the last one ends.

        Choose multiples of a fixed step, or a shorter step is made. Other threads of Python go on;
        an interrupt ends it after a step, and it may be called again.
        """
        _call(self._inner.advance_to, float(time))

    def observe(self, names: str | Iterable[str]) -> Observed | dict[str, Observed]:
        """Give one quantity by its name in `series.csv`, or a dictionary of several.

        Fields are `nodes` (m), `velocity` (m/s) at them, `pressure` (Pa) at the first of them, and
        `cells`, nodes by number: arrays of your own, which do not change later.
        """
        if isinstance(names, str):
            return self.observe([names])[names]
        names = list(names)
        values = [name for name in names if name not in FIELDS]
        found: dict[str, Any] = dict(
            zip(values, _call(self._inner.observe, values) if values else [], strict=True)
        )
        if len(values) < len(names):
            found |= {name: array for name, array in self._fields().items() if name in names}
        return {name: found[name] for name in names}

    def _fields(self) -> dict[str, npt.NDArray[Any]]:
        rows = zip(FIELDS, _call(self._inner.fields), strict=True)
        return {
            name: np.frombuffer(data, dtype=np.uint64 if name == "cells" else np.float64).reshape(
                (-1, width) if width > 1 else -1
            )
            for name, (data, width) in rows
        }

    def commanded(self, name: str) -> dict[str, float]:
        """Give value and rate of a command at present, and the target that is asked for."""
        return dict(
            zip(("value", "rate", "target"), _call(self._inner.commanded, name), strict=True)
        )

    @property
    def commands(self) -> list[str]:
        """Names of all commands."""
        return _call(self._inner.names)[0]

    @property
    def quantities(self) -> list[str]:
        """Names of all quantities."""
        return _call(self._inner.names)[1]

    @property
    def time(self) -> float:
        """Time (s)."""
        return _call(self._inner.status)[0]

    @property
    def end(self) -> float:
        """Time at which the case ends (s)."""
        return _call(self._inner.status)[1]

    @property
    def step(self) -> int:
        """Steps made."""
        return _call(self._inner.status)[2]

    @property
    def is_over(self) -> bool:
        """Whether the case has come to its end."""
        return _call(self._inner.status)[3]

    @property
    def recording(self) -> str:
        """All that was asked for, as `commands.csv` has it, for `alewife run --replay`."""
        return _call(self._inner.recording)

    def save(self) -> State:
        """Give all that evolves at present, with what was asked for."""
        return State(_call(self._inner.save))

    def restore(self, state: State) -> None:
        """Go back, or forth, to a state of this case; not where a run directory is written."""
        _call(self._inner.restore, state._inner)

    def fork(self) -> Session:
        """Open another session at the same state, without a directory."""
        return Session(_call(self._inner.fork))

    def close(self) -> None:
        """End it: a run directory is finished, or continues from here later."""
        _call(self._inner.close)

    def __enter__(self) -> Self:
        """Give itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it."""
        self.close()


def session(
    case: Case | str | Path,
    out: str | Path | None = None,
    *,
    threads: int = 1,
    resume: str | Path | None = None,
    overwrite: bool = False,
) -> Session:
    """Open a session of a case, by its name or as `alewife.load` gives it.

    With `out` it writes a run directory, `commands.csv` in it; without, nothing. `resume` names a
    state, or a run that holds one, to continue from. BadCaseError where the case is wrong.
    """
    module = _module()
    if not isinstance(case, Case):
        case = Case(str(case))
    if not isinstance(threads, int) or threads < 1:
        raise ValueError(f"{threads!r} threads: a whole number from 1 on is accepted")
    _, *settings = case.arguments()
    inner, odd = _call(
        module.Session.open,
        case.name,
        [setting for setting in settings if setting != "--set"],
        None if out is None else str(out),
        None if resume is None else str(resume),
        overwrite,
        threads,
    )
    for message in odd:
        warnings.warn(message, AlewifeWarning, stacklevel=2)
    return Session(inner)


def _module() -> ModuleType:
    try:
        import alewife_session
    except ImportError as error:
        raise ImportError(
            "sessions need the extension module: pip install alewife-session, "
            "or pip install ./solver/python in a clone"
        ) from error
    return alewife_session


def _call(function: Callable[..., T], *arguments: object) -> T:
    """Call the extension module, and raise what the program would say as its exceptions."""
    try:
        return function(*arguments)
    except _module().SessionError as error:
        message, code = error.args
        raise error_of(message, code) from None
