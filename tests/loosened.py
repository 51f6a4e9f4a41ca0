#!/usr/bin/env python3
"""Refuses commits that loosen a number which a test or a reference is held to, unless they say why.

    tests/loosened.py [COMMIT]

looks at each commit since COMMIT; without it since `origin/main`, or at the last one alone. A
number is looser where it is larger behind `<`, smaller behind `>`, or a larger tolerance of a case,
in a line that is otherwise the same, wherever the commit moved it. A commit may do so that has a
line

    Loosened: why this number is right

Lines that change otherwise, too, are left to whoever reads the commit.
"""

from __future__ import annotations

import csv
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator

FILES = ["*.rs", "cases/*.toml", "cases/*.csv"]
TESTS = re.compile(r"(^|/)tests?(\.rs$|/)")
NUMBER = re.compile(r"(?<![\w.])-?\d[\d_]*(?:\.\d+)?(?:e-?\d+)?(?:_?[fu]\d+)?(?![\w])")
LIMIT = re.compile(r"(<|>)=?\s*\(?$")
TOLERANCE = re.compile(r"\b(absolute|relative|tolerance)\s*=\s*$")
REASON = re.compile(r"^Loosened: \S", re.MULTILINE)


def git(*arguments: str) -> str:
    """What git prints."""
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True).stdout


def is_commit(name: str) -> bool:
    """Whether a name is that of a commit in this clone."""
    found = ["git", "rev-parse", "--quiet", "--verify", f"{name}^{{commit}}"]
    return subprocess.run(found, check=False, capture_output=True).returncode == 0


def limits(file: str, line: str, table: list[str]) -> Iterator[tuple[str, float]]:
    """The numbers of a line that are limits, the sign of each such that more is looser.

    `table` has the names of the columns where the file is one.
    """
    if file.endswith(".csv"):
        cells = next(csv.reader([line], skipinitialspace=True), [])
        for name, cell in zip(table, cells, strict=False):
            if name.strip() in ("absolute", "relative") and NUMBER.fullmatch(cell.strip()):
                yield cell.strip(), float(cell)
        return
    for number in NUMBER.finditer(line):
        before = line[: number.start()]
        value = float(re.sub(r"_?[fu]\d+$", "", number[0]).replace("_", ""))
        limit = LIMIT.search(before) if TESTS.search(file) else None
        if limit:
            yield number[0], value if limit[1] == "<" else -value
        elif file.endswith(".toml") and TOLERANCE.search(before):
            yield number[0], value


def columns(commit: str, file: str) -> list[str]:
    """Names of the columns of a table, as a commit has it or had it before."""
    for version in (commit, f"{commit}~1"):
        if is_commit(version):
            shown = ["git", "show", f"{version}:{file}"]
            text = subprocess.run(shown, check=False, capture_output=True, text=True).stdout
            if text:
                return next(csv.reader([text.splitlines()[0]], skipinitialspace=True), [])
    return []


def changes(commit: str) -> dict[str, list[tuple[str, list[tuple[str, float]]]]]:
    """Limits of the lines a commit takes and adds, by the lines with their limits left out."""
    patch = git("show", "--format=", "--unified=0", "--no-renames", commit, "--", *FILES)
    found = defaultdict(list)
    file = ""
    table: list[str] = []
    for line in patch.splitlines():
        if line.startswith(("--- ", "+++ ")):
            file = line[6:]
            table = columns(commit, file) if file.endswith(".csv") else []
        elif line.startswith(("-", "+")):
            held = list(limits(file, line[1:], table))
            if held:
                rest = NUMBER.sub("#", line[1:]).strip()
                found[rest].append((line[0], held))
    return found


def loosened(commit: str) -> list[str]:
    """What a commit loosens."""
    messages = []
    for rest, sides in changes(commit).items():
        taken = [held for side, held in sides if side == "-"]
        added = [held for side, held in sides if side == "+"]
        for old in list(taken):
            if old in added:
                taken.remove(old)
                added.remove(old)
        for old, new in zip(taken, added, strict=False):
            for (was, before), (now, after) in zip(old, new, strict=True):
                if after > before:
                    messages.append(f"{commit[:10]}: {was} became {now} in: {rest}")
    return messages


def main() -> int:
    """Tell what is loosened without a reason."""
    asked = [*sys.argv[1:], "origin/main", "HEAD~1"]
    since = next((name for name in asked if is_commit(name) and git("log", f"{name}..HEAD")), None)
    commits = git("rev-list", "--no-merges", f"{since}..HEAD").split() if since else []
    messages = []
    for commit in commits:
        if not REASON.search(git("show", "--no-patch", "--format=%B", commit)):
            messages += loosened(commit)
    for line in messages:
        print(line, file=sys.stderr)
    if messages:
        print("say why in a line of the commit, `Loosened: ...`, or take it back", file=sys.stderr)
    return int(bool(messages))


if __name__ == "__main__":
    sys.exit(main())
