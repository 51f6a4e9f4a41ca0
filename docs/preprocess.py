"""Preprocessor of the book: adds the pages of the cases, and keeps all links within the book.

mdBook calls it with the book as JSON on the standard input, and takes the book it prints. The pages
stay where they are in the repository, where their links lead to files; in the book a link to
`cases/NAME` is one to a page of the gallery, and a link to a file that is no page is its text.
"""

from __future__ import annotations

import json
import posixpath
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Pages of the repository outside docs, and the pages of the book that hold them.
PAGES = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "cases": "gallery.md",
    "cases/README.md": "cases.md",
    "postprocess/README.md": "postprocess.md",
}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
CODE = re.compile(r"(```.*?^\s*```|`[^`\n]*`)", re.DOTALL | re.MULTILINE)
FORMULA = re.compile(r"(?<![\\$])\$([^$\n]+)\$(?!\$)")


def in_book(target: str, folder: str, page: str) -> str | None:
    """Where a link of a page in a folder of the repository leads in the book, None if nowhere."""
    if re.match(r"[a-z]+:", target) or target.startswith("#"):
        return target
    path, hash_mark, anchor = target.partition("#")
    path = posixpath.normpath(posixpath.join(folder, path))
    case = re.fullmatch(r"cases/([a-z0-9-]+)(/README\.md|/case\.toml)?", path)
    if path.startswith("docs/") and (ROOT / path).is_file():
        to = path.removeprefix("docs/")
    elif path in PAGES:
        to = PAGES[path]
    elif case and (ROOT / "cases" / case[1] / "README.md").is_file():
        to = f"cases/{case[1]}.md"
    else:
        return None
    return posixpath.relpath(to, posixpath.dirname(page) or ".") + hash_mark + anchor


def rewritten(text: str, folder: str, page: str) -> str:
    """The text of a page with its links within the book, and formulas as MathJax reads them."""

    def link(match: re.Match[str]) -> str:
        mark, label, target = match.groups()
        to = in_book(target, folder, page)
        if to is None:
            return label
        # A picture within a link
        return f"{mark}[{LINK.sub(link, label)}]({to})"

    parts = CODE.split(text)
    # Links may have code in their text, so that they are rewritten before the code is left out.
    joined = "".join(
        part if part.startswith("```") else LINK.sub(link, part) for part in blocks(text)
    )
    parts = CODE.split(joined)
    for number in range(0, len(parts), 2):
        parts[number] = FORMULA.sub(lambda match: rf"\\({escaped(match[1])}\\)", parts[number])
    return "".join(parts)


def escaped(formula: str) -> str:
    """A formula in which Markdown finds nothing to do."""
    return re.sub(r"([\\_*])", r"\\\1", formula)


def blocks(text: str) -> list[str]:
    """The text cut into blocks of code and what is between them."""
    return re.split(r"(^```.*?^```\s*?$)", text, flags=re.DOTALL | re.MULTILINE)


def chapter(name: str, file: str, page: str, parents: list[str]) -> dict:
    """A page of the book made of a file of the repository."""
    text = (ROOT / file).read_text(encoding="utf-8")
    return {
        "Chapter": {
            "name": name,
            "content": rewritten(text, posixpath.dirname(file), page),
            "number": None,
            "sub_items": [],
            "path": page,
            "source_path": None,
            "parent_names": parents,
        }
    }


def case_pages() -> list[dict]:
    """The page of each case."""
    names = sorted(path.parent.name for path in (ROOT / "cases").glob("*/case.toml"))
    parents = ["All shipped cases"]
    table = chapter("Table of cases", "cases/README.md", "cases.md", parents)
    pages = [chapter(n, f"cases/{n}/README.md", f"cases/{n}.md", parents) for n in names]
    return [table, *pages]


def main() -> None:
    """Answers mdBook."""
    if sys.argv[1:2] == ["supports"]:
        return
    _, book = json.load(sys.stdin)
    pages = [
        item["Chapter"] for item in book["items"] if isinstance(item, dict) and "Chapter" in item
    ]
    for page in pages:
        path = page["path"]
        if path == "contributing.md":
            held = chapter(page["name"], "CONTRIBUTING.md", path, [])
            page["content"] = held["Chapter"]["content"]
            continue
        folder = posixpath.join("docs", posixpath.dirname(path))
        page["content"] = rewritten(page["content"], folder, path)
        if path == "gallery.md":
            page["sub_items"] = case_pages()
        if path == "output.md":
            name = "alewife-post"
            held = chapter(name, "postprocess/README.md", "postprocess.md", [page["name"]])
            page["sub_items"] = [held]
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
