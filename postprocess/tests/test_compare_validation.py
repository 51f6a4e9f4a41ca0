"""The script that compares two files of `alewife validate --json`."""

import importlib.util
import json
import math
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def script() -> ModuleType:
    path = ROOT / "tests" / "compare_validation.py"
    spec = importlib.util.spec_from_file_location("compare_validation", path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def row(computed: float | None, **changes: Any) -> dict[str, Any]:  # noqa: ANN401
    plain = {
        "case": "tube",
        "quantity": "sphere.force.x",
        "minus": None,
        "statistic": "final",
        "at": None,
        "level": None,
        "of": None,
        "computed": computed,
        "reference": 2.0,
        "tolerance": 0.01,
        "is_relative": True,
        "reason": None if computed is not None else "it diverged",
        "dofs": 100,
    }
    return plain | changes


def test_equal_values_pass(script: ModuleType) -> None:
    rows = [row(2.0), row(2.0, quantity="sphere.power"), row(None, statistic="max")]
    assert script.compare(rows, rows) == ([], [], 3)


def test_a_value_may_differ_by_a_part_of_itself(script: ModuleType) -> None:
    assert not script.compare([row(2.0)], [row(2.0 + 1.9e-9)]).failures
    (failure,) = script.compare([row(2.0)], [row(2.0 + 2.1e-9)]).failures
    assert "different" in failure and "sphere.force.x" in failure


def test_a_value_near_zero_may_differ_by_a_part_of_its_tolerance(script: ModuleType) -> None:
    zero = {"reference": 0.0, "tolerance": 1e-3, "is_relative": False}
    assert not script.compare([row(1e-15, **zero)], [row(9e-13, **zero)]).failures
    assert script.compare([row(1e-15, **zero)], [row(2e-12, **zero)]).failures


def test_values_of_one_file_only_are_listed(script: ModuleType) -> None:
    before, after = [row(2.0), row(3.0, at=1.0)], [row(2.0), row(3.0, at=2.0)]
    assert [line.split()[0] for line in script.compare(before, after).failures] == [
        "missing",
        "additional",
    ]


def test_a_value_that_is_no_longer_computed_differs(script: ModuleType) -> None:
    (failure,) = script.compare([row(2.0)], [row(None)]).failures
    assert "it diverged" in failure
    assert script.compare([row(2.0)], [row(math.nan)]).failures


def test_equal_references_are_told_apart_by_their_number(script: ModuleType) -> None:
    assert script.compare([row(2.0), row(2.0)], [row(2.0)]).failures
    assert script.compare([row(2.0), row(3.0)], [row(2.0), row(3.5)]).failures


def test_unknowns_are_a_note(script: ModuleType) -> None:
    report = script.compare([row(2.0)], [row(2.0, dofs=101)])
    assert not report.failures and len(report.notes) == 1


def test_the_exit_code_says_whether_files_agree(
    script: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = {"a": [row(2.0)], "b": [row(2.1)]}
    for name, rows in files.items():
        (tmp_path / name).write_text(json.dumps({"comparisons": rows}))
    a, b = (str(tmp_path / name) for name in files)
    assert script.main([a, a]) == 0
    assert script.main([a, b]) == 1
    assert script.main([a, b, "--tolerance", "0.1"]) == 0
    assert "1 values compared, 1 failures" in capsys.readouterr().out
    assert script.main([a, str(tmp_path / "none")]) == 2
