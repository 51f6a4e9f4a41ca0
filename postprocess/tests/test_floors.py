"""Floors of the package: a module knows those of its own floor and of the ones below, in no circle.

The floors are those of the table in `postprocess/README.md`. All imports count, those in functions
and those for types as well.
"""

from __future__ import annotations

import ast
import graphlib
import re
from collections.abc import Mapping
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "src"
PAGE = SOURCE.parent / "README.md"
HIGHEST_OF_CASES = "Reading a run"
"""The package `alewife` knows nothing above it."""


def floors_of(page: str) -> dict[str, tuple[int, str]]:
    """Number and name of the floor of each module in the table."""
    found: dict[str, tuple[int, str]] = {}
    floor = (-1, "")
    for row in re.findall(r"^\| (.+?) \|", page, re.MULTILINE):
        if row.startswith("**"):
            floor = (floor[0] + 1, row.strip("*"))
        else:
            found |= dict.fromkeys(re.findall(r"`(\w+)\.py`", row), floor)
    return found


def imports_of(package: str) -> dict[str, set[str]]:
    """Modules each module of a package imports from both packages, by their full names."""
    files = {
        f"{folder}.{path.stem}": path
        for folder in ("alewife_post", "alewife")
        for path in (SOURCE / folder).glob("*.py")
        if path.stem != "__init__"
    }
    found: dict[str, set[str]] = {}
    for name, path in files.items():
        if name.split(".")[0] != package:
            continue
        known = set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                known |= {one.name for one in node.names}
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{name}: an import relative to its folder"
                known |= {node.module, *(f"{node.module}.{one.name}" for one in node.names)}
        found[name] = known & {*files, "alewife", "alewife_post"} - {name}
        if any(one.startswith(f"{package}.") for one in found[name]):
            # `from alewife_post import style` imports the door, which is no module of a floor
            found[name] -= {package}
    return found


def faults(imports: Mapping[str, set[str]], floors: Mapping[str, tuple[int, str]]) -> list[str]:
    """Imports of a floor above, and a circle."""
    found = [
        f"{name} ({floors[name][1]}) knows {other} ({floors[other][1]})"
        for name, known in imports.items()
        for other in known
        if floors[other][0] > floors[name][0]
    ]
    try:
        graphlib.TopologicalSorter(imports).prepare()
    except graphlib.CycleError as error:
        found.append(f"a circle: {' > '.join(reversed(error.args[1]))}")
    return found


def own_imports() -> dict[str, set[str]]:
    """Imports of `alewife_post` within itself, without its name."""
    return {
        name.partition(".")[2]: {one.partition(".")[2] or one for one in known}
        for name, known in imports_of("alewife_post").items()
    }


def test_every_module_has_a_floor() -> None:
    modules = {path.stem for path in (SOURCE / "alewife_post").glob("*.py")} - {"__init__"}
    assert set(floors_of(PAGE.read_text(encoding="utf-8"))) == modules


def test_no_module_knows_one_of_a_floor_above_and_none_is_in_a_circle() -> None:
    imports = own_imports()
    assert "read" in imports["bodies"]
    assert not faults(imports, floors_of(PAGE.read_text(encoding="utf-8")))


def test_cases_are_run_without_what_draws_them() -> None:
    floors = floors_of(PAGE.read_text(encoding="utf-8"))
    highest = {number for number, name in floors.values() if name == HIGHEST_OF_CASES}.pop()
    known = {one for own in imports_of("alewife").values() for one in own}
    modules = {one.partition(".")[2] for one in known if one.startswith("alewife_post.")}
    assert "read" in modules
    assert {one for one in modules if floors[one][0] > highest} == set()
    assert not any(one == "alewife" for own in own_imports().values() for one in own)


def test_what_breaks_the_rules_is_found() -> None:
    page = "| **Low** | |\n| `a.py`, `b.py` | x |\n| **High** | |\n| `c.py` | y |\n"
    floors = floors_of(page)
    assert floors == {"a": (0, "Low"), "b": (0, "Low"), "c": (1, "High")}
    assert faults({"a": set(), "b": {"a"}, "c": {"a", "b"}}, floors) == []
    assert faults({"a": {"c"}, "b": set(), "c": set()}, floors) == ["a (Low) knows c (High)"]
    (circle,) = faults({"a": {"b"}, "b": {"a"}, "c": set()}, floors)
    assert circle.startswith("a circle: ")
