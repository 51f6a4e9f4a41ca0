"""What the pages say to type works, and what they link to is there.

Blocks of `sh` of a page run one after the other in a new folder, and so do blocks of `python`. A
comment `<!-- file: NAME -->` before a block writes it to that file, `<!-- from: PATH -->` copies a
file of the repository, and `<!-- not run: REASON -->` leaves a block out. `<!-- add to: NAME -->`
adds a block to a file. In the end files are those of their names in the folder of tutorials.

`cargo run --release -- ...` is not a build here: a command `cargo` that comes first on the path
runs the program that is built already.

Rows with a verdict in a block of `text`, and unknowns and steps of a run, are as the block before
it has printed them.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from alewife_post import published

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = ROOT / "docs" / "tutorials"
PAGES = [
    "README.md",
    "docs/start.md",
    *(f"docs/tutorials/{p.name}" for p in sorted(TUTORIALS.glob("*.md"))),
]
STEP = re.compile(
    r"<!-- (?P<mark>file|add to|from|not run): (?P<value>.+?) -->\n"
    r"|^```(?P<language>\w+)\n(?P<code>.*?)^```",
    re.DOTALL | re.MULTILINE,
)
CASE_PAGES = sorted((ROOT / "cases").glob("*/README.md"))
PICTURE = re.compile(r"^ *!\[[^\]]+\]\(([^)\s]+)\)$", re.MULTILINE)
NEAR_THE_TOP = 6
"""Lines of a case page within which its picture is."""
LARGEST_DOCS = 10_000_000
"""Bytes of all pictures of the documentation."""
PIXELS = 64
"""Pixels of a side to which pictures are reduced before they are compared."""
LARGEST_DIFFERENCE = 1.8
"""Of colours from 0 to 255, in the mean: fewer pixels and colours make less."""
LINK = re.compile(r"\]\(([^)\s]+)\)")
FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)


def program() -> Path:
    """The program, beside whose name `alewife` is looked up."""
    given = os.environ.get("ALEWIFE_BIN")
    return Path(given) if given else ROOT / "target" / "release" / "alewife"


CARGO = """#!/bin/sh
if [ "$1 $2 $3" != "run --release --" ]; then
    echo "cargo $*: pages are tested with the program that is built" >&2
    exit 2
fi
shift 3
exec {program} "$@"
"""
SCRIPTS = {"sh": ["bash", "-euo", "pipefail", "-c"], "python": [sys.executable, "-c"]}
COST = re.compile(r"\d+ unknowns, \d+ steps(?=,)")
VERDICTS = ("within", "outside", "OUTSIDE")
ROUNDING = 1e-10
"""Smaller numbers, and their differences, are rounding errors: another one on each machine."""


def without_rounding(row: str) -> list[str]:
    """The words of a row of the table, the words of rounding errors replaced."""
    words = row.split()
    kept = []
    for word in words:
        try:
            is_rounding = 0.0 < abs(float(word)) < ROUNDING
        except ValueError:
            is_rounding = False
        kept.append("~0" if is_rounding else word)
    return kept


def not_printed(shown: str, printed: str) -> list[str]:
    """What a page shows of verdicts, unknowns and steps, and its command has not printed."""
    there = [without_rounding(row) for row in printed.splitlines()]
    rows = [row for row in shown.splitlines() if row.split()[-1:] and row.split()[-1] in VERDICTS]
    costs = [cost for cost in COST.findall(shown) if cost not in printed]
    return [row for row in rows if without_rounding(row) not in there] + costs


def surroundings(tools: Path) -> dict[str, str]:
    """The variables commands run with: our own `cargo` first, then the program, then Python."""
    tools.mkdir()
    cargo = tools / "cargo"
    cargo.write_text(CARGO.format(program=shlex.quote(str(program().resolve()))), encoding="utf-8")
    cargo.chmod(0o755)
    commands = [str(tools), str(program().parent), str(Path(sys.executable).parent)]
    return os.environ | {
        "PATH": os.pathsep.join([*commands, os.environ["PATH"]]),
        "ALEWIFE_BIN": str(program().resolve()),
        "MPLBACKEND": "agg",
    }


def follow(text: str, folder: Path) -> int:
    """Does what a page says, and counts the blocks that ran."""
    folder.mkdir(exist_ok=True)
    environment = surroundings(folder / "tools")
    file, is_left_out, count, printed = None, False, 0, ""
    added, written = None, {}
    for step in STEP.finditer(text):
        mark, value, code = step["mark"], step["value"], step["code"]
        if mark == "file":
            file = value
        elif mark == "add to":
            added = value
        elif mark == "from":
            shutil.copy(ROOT / value, folder)
        elif mark == "not run":
            is_left_out = True
        elif file is not None:
            written[file] = code
            (folder / file).write_text(code, encoding="utf-8")
            file = None
        elif added is not None:
            written[added] += code
            (folder / added).write_text(written[added], encoding="utf-8")
            added = None
        elif step["language"] in SCRIPTS:
            if not is_left_out:
                script = [*SCRIPTS[step["language"]], code]
                done = subprocess.run(
                    script, cwd=folder, env=environment, capture_output=True, text=True
                )
                assert done.returncode == 0, f"{code}\n{done.stdout}{done.stderr}"
                count, printed = count + 1, done.stdout
            is_left_out = False
        elif step["language"] == "text":
            missing = not_printed(code, printed)
            assert not missing, "\n".join(["not printed:", *missing, "but:", printed])
    for name, content in written.items():
        shipped = TUTORIALS / name
        assert shipped.read_text(encoding="utf-8") == content, f"{name} is not as on its page"
    return count


def reduced(picture: Path) -> np.ndarray:
    """A picture in few pixels, shape (PIXELS, PIXELS, 3)."""
    with Image.open(picture) as image:
        small = image.convert("RGB").resize((PIXELS, PIXELS), Image.Resampling.BOX)
        return np.asarray(small, dtype=float)


def unlike(page: Path, folder: Path) -> list[str]:
    """Pictures of a page that are not what its commands have drawn in a folder."""
    pairs = [(picture, folder / picture.name) for picture in shown(page)]
    drawn = [(ours, theirs) for ours, theirs in pairs if theirs.is_file()]
    differences = {a.name: np.abs(reduced(a) - reduced(b)).mean() for a, b in drawn}
    return [name for name, by in differences.items() if by > LARGEST_DIFFERENCE]


@pytest.mark.skipif(not program().is_file(), reason="the program is not built")
@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_run_and_draw_its_pictures(page: str, tmp_path: Path) -> None:
    assert follow((ROOT / page).read_text(encoding="utf-8"), tmp_path) > 0
    assert not unlike(ROOT / page, tmp_path)


def test_another_picture_is_found(tmp_path: Path) -> None:
    (tmp_path / "drawn").mkdir()
    page = tmp_path / "page.md"
    page.write_text("![A picture](a.png)\n\n![Another](b.png)\n", encoding="utf-8")
    for name, colour in (("a.png", 100), ("b.png", 103)):
        Image.new("RGB", (90, 60), (100, 100, 100)).save(tmp_path / name)
        Image.new("RGB", (180, 120), (colour, 100, colour)).save(tmp_path / "drawn" / name)
    assert unlike(page, tmp_path / "drawn") == ["b.png"]


def test_a_command_that_fails_is_found(tmp_path: Path) -> None:
    page = "```sh\nfalse\n```\n"
    with pytest.raises(AssertionError):
        follow(page, tmp_path)
    assert follow(f"<!-- not run: it fails -->\n{page}", tmp_path / "other") == 0


def test_a_build_is_not_made(tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match="pages are tested with the program"):
        follow("```sh\ncargo build --release\n```\n", tmp_path)


def test_a_row_that_is_not_printed_is_found() -> None:
    printed = "case-a  flow.defect  5.9e-15  0  property  +5.9e-15  6.7e-5  within\n"
    assert (
        not_printed("case-a flow.defect -1.2e-16 0 property -1.2e-16 6.7e-5 within", printed) == []
    )
    row = "case-a flow.defect -1.2e-16 0 property -1.2e-16 6.8e-5 within"
    assert not_printed(f"a line\n\n{row}\n", printed) == [row]
    printed = "8887 unknowns, 40 steps, 1.73 s of CPU time; written to runs/a\n"
    assert not_printed("8887 unknowns, 40 steps, 1.97 s of CPU time, ...\n", printed) == []
    other = "8887 unknowns, 41 steps"
    assert not_printed(f"{other}, 1.97 s of CPU time, ...\n", printed) == [other]


def anchors(page: Path) -> set[str]:
    """The anchors of a page: its headings as GitHub and mdBook name them, and `id`s."""
    text = page.read_text(encoding="utf-8")
    found = set(re.findall(r'id="([^"]+)"', text))
    for heading in re.findall(r"^#+ (.*)$", FENCED.sub("", text), re.MULTILINE):
        words = re.sub(r"[^\w\- ]", "", heading.lower())
        found.add(words.strip().replace(" ", "-"))
    return found


def broken_links(page: Path) -> list[str]:
    """Relative links of a page that lead nowhere."""
    text = re.sub(r"`[^`\n]*`", "", FENCED.sub("", page.read_text(encoding="utf-8")))
    broken = []
    for target in LINK.findall(text):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        to = (page.parent / path).resolve() if path else page
        is_there = to.exists() and (not anchor or to.suffix != ".md" or anchor in anchors(to))
        if not is_there:
            broken.append(f"{page.relative_to(ROOT)}: {target}")
    return broken


def test_relative_links_lead_somewhere() -> None:
    pages = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", *CASE_PAGES]
    assert len(pages) > 100
    broken = [link for page in pages for link in broken_links(page)]
    assert not broken, "\n".join(broken)


def test_a_broken_link_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules[__name__], "ROOT", tmp_path)
    page = tmp_path / "page.md"
    page.write_text("# A `b` c\n[x](#a-b-c) [y](#d) [z](no.md)\n", encoding="utf-8")
    assert broken_links(page) == ["page.md: #d", "page.md: no.md"]


def shown(page: Path, lines: int | None = None) -> list[Path]:
    """The pictures of a page, or of its first lines."""
    text = "\n".join(page.read_text(encoding="utf-8").splitlines()[:lines])
    return [(page.parent / target).resolve() for target in PICTURE.findall(text)]


def test_every_case_page_has_its_picture_near_the_top() -> None:
    pictures = ROOT / "docs" / "pictures"
    for page in CASE_PAGES:
        assert pictures / f"{page.parent.name}.png" in shown(page, NEAR_THE_TOP), page.parent.name


def test_every_case_page_shows_what_is_published_beside_the_computed() -> None:
    curves = ROOT / "docs" / "pictures" / "curves"
    cases = [page.parent for page in CASE_PAGES if published.is_published(page.parent)]
    assert len(cases) > 10
    missing = [
        case.name for case in cases if curves / f"{case.name}.png" not in shown(case / "README.md")
    ]
    assert not missing, missing


def test_pictures_are_used_and_small() -> None:
    pages = [*(ROOT / "docs").rglob("*.md"), *CASE_PAGES, ROOT / "README.md"]
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    files = [path for path in (ROOT / "docs" / "pictures").rglob("*") if path.is_file()]
    assert sum(path.stat().st_size for path in files) < LARGEST_DOCS
    assert not [path.name for path in files if path.name not in text]
