"""The program: where it is, how it is called, and what its exit codes mean."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

#: Exit codes of cases that are wrong: the command line, the case file, no such case.
_BAD_CASE = (2, 65, 66)
#: Of solvers that diverge, and meshes that cannot be made.
_SOLVER = (10, 11)
#: Of runs that were stopped, or make no progress.
_STOPPED = (75, 76)


class AlewifeError(RuntimeError):
    """The program ended with an error: `code` is its exit code, the text what it said."""

    def __init__(self, message: str, code: int) -> None:
        """Take over what the program said and its exit code."""
        super().__init__(message)
        self.code = code


class AlewifeWarning(UserWarning):
    """Something odd in a case, or that a run warned of."""


class BadCaseError(AlewifeError):
    """A case is wrong; the message names file, line and key, and what would be accepted."""


class SolverError(AlewifeError):
    """The solver diverged, or a mesh cannot be made; the run directory keeps the last state."""


class StoppedError(AlewifeError):
    """A run was stopped; run again into the same directory to continue it."""


def find_program() -> Path:
    """Find the program: `ALEWIFE_BIN`, else beside the Python interpreter, else on the path.

    Raises FileNotFoundError where it is in none of these places.
    """
    named = os.environ.get("ALEWIFE_BIN")
    if named:
        if not Path(named).is_file():
            raise FileNotFoundError(f"ALEWIFE_BIN names {named}, which is no file")
        return Path(named)
    name = "alewife.exe" if os.name == "nt" else "alewife"
    beside = Path(sys.executable).parent / name
    if beside.is_file():
        return beside
    on_path = shutil.which(name)
    if on_path is None:
        raise FileNotFoundError(
            "the program alewife is neither beside this Python nor on the path: "
            "pip install alewife, or cargo install --path solver in a clone, or set ALEWIFE_BIN"
        )
    return Path(on_path)


def call(*arguments: str | Path, progress: bool = False) -> str:
    """Call the program and return what it prints.

    With `progress` its messages go to the terminal as they come. An interrupt is passed on: the
    program ends at its next step and writes its state; KeyboardInterrupt is raised once it has. A
    second one ends it at once. Where this process dies, the program is stopped, too (on Linux).
    """
    command = [str(find_program()), *map(str, arguments)]
    errors = None if progress else subprocess.PIPE
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=errors,
        text=True,
        encoding="utf-8",
        env={**os.environ, "ALEWIFE_PARENT": str(os.getpid())},
    ) as process:
        try:
            output, messages = process.communicate()
        except KeyboardInterrupt:
            _interrupt(process)
            raise
    if process.returncode != 0:
        raise _error(messages or "", process.returncode, command)
    return output


def _interrupt(process: subprocess.Popen[str]) -> None:
    """Interrupt a process until it has ended: in a notebook no terminal has signalled it."""
    while process.poll() is None:
        # One within half a second of that of a terminal counts as the same
        process.send_signal(signal.SIGINT)
        try:
            process.communicate()
        except KeyboardInterrupt:
            continue


def _error(messages: str, code: int, command: list[str]) -> AlewifeError:
    return error_of(messages.strip() or f"{' '.join(command)} ended with code {code}", code)


def error_of(text: str, code: int) -> AlewifeError:
    """Make the exception for what the program says, by its exit code."""
    for kind, codes in (
        (BadCaseError, _BAD_CASE),
        (SolverError, _SOLVER),
        (StoppedError, _STOPPED),
    ):
        if code in codes:
            return kind(text, code)
    return AlewifeError(text, code)
