"""Commits that loosen what a test or a case is held to are found, unless they say why."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "tests" / "loosened.py"
TEST = 'assert!(error < 1e-6 && order > 1.9, "{error}");\nlet n = 5;\n'
CASE = "[[reference]]\nvalue = 1.0\nrelative = 1e-3\n"
TABLE = "quantity, value, absolute, kind\nsphere.x, 1.0, 3e-4, exact\n"


class Clone:
    """A repository with a test, a case and its table, and what a change of them is answered."""

    def __init__(self, place: Path) -> None:
        """Start with all."""
        self.place = place
        self.git("init", "--quiet")
        self.commit("start", TEST, CASE)

    def git(self, *arguments: str) -> None:
        """Call git."""
        who = ["-c", "user.name=a", "-c", "user.email=a@b.c"]
        subprocess.run(["git", *who, *arguments], cwd=self.place, check=True)

    def commit(self, message: str, test: str, case: str, table: str = TABLE) -> None:
        """Commit all as they are to be."""
        files = {"tests/a.rs": test, "cases/b/case.toml": case, "cases/b/references.csv": table}
        for name, text in files.items():
            file = self.place / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        self.git("add", ".")
        self.git("commit", "--quiet", "--message", message)

    def messages(self) -> list[str]:
        """What is said of the last commit."""
        done = subprocess.run(
            [sys.executable, SCRIPT], cwd=self.place, capture_output=True, text=True, check=False
        )
        assert done.returncode == (1 if done.stderr else 0), done.stderr
        return done.stderr.splitlines()[:-1]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("1e-6", "2e-6", "1e-6 became 2e-6"),
        ("1.9", "1.8", "1.9 became 1.8"),
        ("relative = 1e-3", "relative = 0.002", "1e-3 became 0.002"),
        ("3e-4", "4e-4", "3e-4 became 4e-4"),
    ],
)
def test_what_is_loosened_needs_a_reason(tmp_path: Path, old: str, new: str, message: str) -> None:
    clone = Clone(tmp_path)
    looser = [text.replace(old, new) for text in (TEST, CASE, TABLE)]
    clone.commit("change", *looser)
    (found,) = clone.messages()
    assert message in found
    clone.commit("back", TEST, CASE)
    assert clone.messages() == []
    clone.commit("change\n\nLoosened: the mesh is coarser", *looser)
    assert clone.messages() == []


def test_what_is_no_limit_may_change(tmp_path: Path) -> None:
    clone = Clone(tmp_path)
    tighter = TEST.replace("1e-6", "1e-7").replace("1.9", "1.95").replace("n = 5", "n = 6")
    clone.commit("tighter", tighter, CASE.replace("1e-3", "5e-4").replace("1.0", "3.0"))
    assert clone.messages() == []
    clone.commit("moved", "// first\n" + "".join(reversed(tighter.splitlines(True))), CASE)
    assert clone.messages() != []
