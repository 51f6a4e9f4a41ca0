"""A run with its last values and what they are compared with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from alewife_post.evidence import comparisons
from alewife_post.read import Run


@dataclass(frozen=True)
class CaseRun(Run):
    """A run that a case made: all that `alewife_post.Run` has, and the following."""

    #: Holds a temporary directory as long as the run is used.
    kept: TemporaryDirectory[str] | None = None

    @cached_property
    def references(self) -> list[dict[str, Any]]:
        """What was computed beside each reference of the case, with its verdict."""
        return comparisons(self)


def open_case_run(path: Path, kept: TemporaryDirectory[str] | None = None) -> CaseRun:
    """Open the directory of a run."""
    return CaseRun(path, kept)
