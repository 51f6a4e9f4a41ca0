"""What pages name is there: runs are of shipped cases or made on the page, words are keys."""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT / "cases"
PAGES = sorted(
    [
        ROOT / "README.md",
        ROOT / "postprocess" / "README.md",
        *CASES.rglob("README.md"),
        *(ROOT / "docs").rglob("*.md"),
    ]
)
NAMED = re.compile(r"\b(runs|sweeps|cases)/([A-Za-z0-9][A-Za-z0-9_-]*)")
PLACEHOLDERS = {"CASE", "CASE-VARIANT", "NAME"}
MADE = (
    # A file of the reader's own, and directories that commands and calls write
    r"alewife (?:sweep )?(?:run|script) +{name}\.toml",
    r"--out {folder}/{name}\b",
    r"out=\"{folder}/{name}\"",
    r"(?:run|copytree)\([^()\n]*\"{folder}/{name}\"",
)


def known_names() -> set[str]:
    """What a run of a shipped case or of a variant of it is called."""
    found = set(PLACEHOLDERS)
    for file in CASES.glob("*/case.toml"):
        case, name = tomllib.loads(file.read_text(encoding="utf-8")), file.parent.name
        found |= {name, *(f"{name}-{variant['name']}" for variant in case.get("variant", []))}
    return found


def unknown(text: str, known: set[str]) -> list[str]:
    """Runs, sweeps and cases a page names that are neither shipped nor made on it."""
    missing = []
    for folder, name in dict.fromkeys(NAMED.findall(text)):
        is_made = folder != "cases" and any(
            re.search(pattern.format(folder=folder, name=re.escape(name)), text) for pattern in MADE
        )
        is_file = folder == "cases" and (CASES / name).exists()
        if not (name in known or is_made or is_file or name == "README"):
            missing.append(f"{folder}/{name}")
    return missing


def test_runs_that_pages_name_are_of_cases_or_made_on_the_page() -> None:
    known = known_names()
    assert len(known) > 200
    missing = {
        str(page.relative_to(ROOT)): found
        for page in PAGES
        if (found := unknown(page.read_text(encoding="utf-8"), known))
    }
    assert not missing


def test_a_run_of_nothing_is_found() -> None:
    known = {"three-sphere"}
    assert unknown("plot runs/three-sphere; inspect runs/falling", known) == ["runs/falling"]
    assert unknown("alewife run my.toml\nalewife plot runs/my", known) == []
    assert unknown("alewife run my.toml\nalewife plot runs/your", known) == ["runs/your"]
    assert unknown("--out runs/more\nruns/more/fields", known) == []
    assert unknown("--out sweeps/more\nruns/more", known) == ["runs/more"]
    assert unknown("compare sweeps/three-sphere cases/four-cube", known) == ["cases/four-cube"]


def words(text: str) -> set[str]:
    return set(re.findall(r"[A-Za-z][A-Za-z0-9_-]*", text))


def test_words_on_their_page_are_those_of_cases_and_commands() -> None:
    page = (ROOT / "docs" / "notation.md").read_text(encoding="utf-8")
    _, _, own = page.partition("## Words of other programs")
    own, _, _ = own.partition("| Here | ParaView |")
    sources = ["docs/case-file.md", "docs/keys.md", "docs/output.md", "README.md"]
    known = words("\n".join((ROOT / file).read_text(encoding="utf-8") for file in sources))
    first = [row.split("|")[1] for row in own.splitlines() if row.startswith("| ")]
    terms = re.findall(r"`([^`]+)`", "\n".join(first))
    assert len(terms) > 25
    assert words(" ".join(terms)) <= known


# Blocks of code, but for those that a comment in the line before says are not run
BLOCK = re.compile(r"(?<!-->\n)^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)
SHOWN = re.compile(r"#> (.*)$", re.MULTILINE)


@pytest.mark.skipif("ALEWIFE_BIN" not in os.environ, reason="needs the program: see test.sh")
def test_the_code_of_the_page_on_python_runs_and_prints_what_it_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    program = Path(os.environ["ALEWIFE_BIN"]).resolve()
    monkeypatch.setenv("ALEWIFE_BIN", str(program))
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    shown = 0
    for code in BLOCK.findall((ROOT / "docs" / "python.md").read_text(encoding="utf-8")):
        exec(code, names)
        printed = capsys.readouterr().out
        for text in SHOWN.findall(code):
            assert text.removesuffix(" ...") in printed, printed
            shown += 1
    plt.close("all")
    assert shown >= 3
    assert (tmp_path / "swimmer.png").stat().st_size > 10_000
