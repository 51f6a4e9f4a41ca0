"""Maturin as the build backend, with the commands executable.

The source distribution that maturin makes keeps no bits of execution, and `pip install` leaves
commands as they are in the wheel.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import maturin
from maturin import (
    build_sdist,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

COMMANDS = Path(__file__).resolve().parents[1] / "commands" / "scripts"


def make_executable() -> None:
    """Set the bits of the commands."""
    for command in COMMANDS.iterdir():
        command.chmod(0o755)


def build_wheel(*arguments: Any, **options: Any) -> str:
    """Build a wheel."""
    make_executable()
    return maturin.build_wheel(*arguments, **options)


def build_editable(*arguments: Any, **options: Any) -> str:
    """Build a wheel that refers to the sources."""
    make_executable()
    return maturin.build_editable(*arguments, **options)
