"""What the commands that draw say where packages are missing."""

from __future__ import annotations

import pytest

from alewife import pictures


def test_missing_packages_are_one_line_with_the_remedy(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert pictures.missing() is None
    monkeypatch.setattr(pictures, "NEEDED", ("matplotlib", "no_such_package"))
    assert pictures.main(["picture", "run"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "needs no_such_package: pip install 'alewife[pictures]' (835 MB" in said
