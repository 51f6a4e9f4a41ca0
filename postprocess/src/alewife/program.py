"""The program: where it is, how it is called, and what its exit codes mean."""

from __future__ import annotations

import os
import shutil
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

    With `progress` its messages go to the terminal as they come. Ctrl-C reaches the program, too,
    which writes its state and ends; KeyboardInterrupt is raised once it has.
    """
    command = [str(find_program()), *map(str, arguments)]
    errors = None if progress else subprocess.PIPE
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=errors, text=True, encoding="utf-8"
    ) as process:
        try:
            output, messages = process.communicate()
        except KeyboardInterrupt:
            # The terminal has signalled the program, too: it ends after its step
            process.wait()
            raise
    if process.returncode != 0:
        raise _error(messages or "", process.returncode, command)
    return output


def _error(messages: str, code: int, command: list[str]) -> AlewifeError:
    text = messages.strip() or f"{' '.join(command)} ended with code {code}"
    for kind, codes in (
        (BadCaseError, _BAD_CASE),
        (SolverError, _SOLVER),
        (StoppedError, _STOPPED),
    ):
        if code in codes:
            return kind(text, code)
    return AlewifeError(text, code)
