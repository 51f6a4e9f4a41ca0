"""Preprocessor of the book: pages of cases and references, links, formulas and citations.

mdBook calls it with the book as JSON on the standard input, and takes the book it prints. The pages
stay where they are in the repository, where their links lead to files; in the book a link to
`cases/NAME` is one to its page, and a link to a file that is no page is its text. Formulas, `$...$`
and blocks of `math`, become MathML, which browsers draw by themselves; `@key` becomes authors and
year, with a link to the page of references that is made of `references.bib`.
"""

from __future__ import annotations

import json
import posixpath
import re
import sys
import unicodedata
from pathlib import Path
from urllib.parse import quote

from latex2mathml.converter import convert

ROOT = Path(__file__).resolve().parent.parent
# Pages of the repository outside docs, and the pages of the book that hold them.
PAGES = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "cases": "cases.md",
    "cases/README.md": "cases.md",
    "postprocess/README.md": "postprocess.md",
}
REFERENCES = "references.md"
NOTEBOOK = "docs/notebooks/first-look.ipynb"
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
CODE = re.compile(r"(^```.*?^\s*```|^~~~.*?^~~~|`[^`\n]*`)", re.DOTALL | re.MULTILINE)
BLOCK = re.compile(r"^```math\n(.*?)^```$|\$\$(.+?)\$\$", re.DOTALL | re.MULTILINE)
FORMULA = re.compile(r"(?<![\\$])\$([^$\n]+)\$(?!\$)([,.;:)]*)")
TAG = re.compile(r"\\tag\{([^}]*)\}")
# Functions that are written by their names stand apart from what is before and behind them.
NAMED = r"<m[io]>(?:sin|cos|tan|ln|log|exp|max|min|det|div|diag)</m[io]>"
BEFORE = re.compile(rf"(?<=</m[in]>)(?={NAMED})")
BEHIND = re.compile(rf"({NAMED})(?=<m[in])")
SPACE = "<mspace width='0.17em'/>"
CITATION = re.compile(r"@([a-z]+\d{4}[a-z]?)\b")
ENTRY = re.compile(r"^@\w+\{(\w+),\n(.*?)^\}", re.DOTALL | re.MULTILINE)
FIELD = re.compile(r"(\w+)\s*=\s*\{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\}")
ACCENTS = {"'": "\u0301", "`": "\u0300", '"': "\u0308", "v": "\u030c", "c": "\u0327"}
LETTERS = {r"\o": "ø", r"\O": "Ø", r"\ss": "ß", r"\aa": "å", r"\&": "&"}


def in_book(target: str, folder: str, page: str) -> str | None:
    """Where a link of a page in a folder of the repository leads in the book, None if nowhere."""
    if re.match(r"[a-z]+:", target) or target.startswith("#"):
        return target
    path, hash_mark, anchor = target.partition("#")
    path = posixpath.normpath(posixpath.join(folder, path))
    case = re.fullmatch(r"cases/([a-z0-9-]+)(/README\.md|/case\.toml)?", path)
    if path == "docs/references.bib":
        to = REFERENCES
    elif path == NOTEBOOK:
        to = path.removeprefix("docs/").replace(".ipynb", ".md")
    elif path.startswith("docs/") and (ROOT / path).is_file():
        to = path.removeprefix("docs/")
    elif path in PAGES:
        to = PAGES[path]
    elif case and (ROOT / "cases" / case[1] / "README.md").is_file():
        to = f"cases/{case[1]}.md"
    else:
        return None
    return posixpath.relpath(to, posixpath.dirname(page) or ".") + hash_mark + anchor


def mathml(formula: str, display: str) -> str:
    """A formula of LaTeX as MathML, in which Markdown finds nothing to do."""
    drawn = convert(formula.strip(), display=display)
    # What is not understood is taken for a text
    unknown = re.search(r"\\[A-Za-z]+", drawn)
    if unknown:
        raise SystemExit(f"formula `{formula}`: {unknown[0]} is not understood")
    drawn = BEHIND.sub(rf"\1{SPACE}", BEFORE.sub(SPACE, drawn))
    return re.sub(r"[*_\[\]`]", lambda mark: f"&#{ord(mark[0])};", drawn)


def formula_block(match: re.Match[str]) -> str:
    """A formula on lines of its own, its number beside it."""
    formula = match[1] or match[2]
    tag = TAG.search(formula)
    number = f'<span class="number">({tag[1]})</span>' if tag else ""
    drawn = mathml(TAG.sub("", formula), "block")
    return f'\n<div class="formula">{drawn}{number}</div>\n'


def formula_in_text(match: re.Match[str]) -> str:
    """A formula within a line, kept together with the punctuation behind it."""
    drawn = mathml(match[1], "inline")
    return f'<span class="kept">{drawn}{match[2]}</span>' if match[2] else drawn


def rewritten(text: str, folder: str, page: str) -> str:
    """The text of a page with its links within the book, its formulas and its citations."""

    def link(match: re.Match[str]) -> str:
        mark, label, target = match.groups()
        to = in_book(target, folder, page)
        if to is None:
            return label
        # A picture within a link
        return f"{mark}[{LINK.sub(link, label)}]({to})"

    def citation(match: re.Match[str]) -> str:
        entry = ENTRIES.get(match[1])
        if entry is None:
            raise SystemExit(f"{page}: {match[0]} is not in docs/references.bib")
        to = posixpath.relpath(REFERENCES, posixpath.dirname(page) or ".")
        return f"[{cited(entry)}]({to}#{match[1]})"

    # Links may have code in their text, so that they are rewritten before the code is left out.
    joined = "".join(
        part if part.startswith("```") else LINK.sub(link, part) for part in blocks(text)
    )
    parts = CODE.split(BLOCK.sub(formula_block, joined))
    for number in range(0, len(parts), 2):
        part = CITATION.sub(citation, parts[number])
        parts[number] = FORMULA.sub(formula_in_text, part)
    return "".join(parts)


def blocks(text: str) -> list[str]:
    """The text cut into blocks of code and what is between them."""
    return re.split(r"(^```.*?^```\s*?$)", text, flags=re.DOTALL | re.MULTILINE)


def plain(text: str) -> str:
    """A text of BibTeX without braces and commands."""

    def accented(match: re.Match[str]) -> str:
        letter = match[2].replace("\\i", "i")
        return unicodedata.normalize("NFC", letter + ACCENTS[match[1]])

    text = re.sub(r"\\(['`\"vc])\s*\{?(\\?[A-Za-z])\}?", accented, text)
    for command, letter in LETTERS.items():
        text = text.replace(command, letter)
    return " ".join(re.sub(r"[{}]", "", text).replace("--", "\u2013").split())


def bibliography() -> dict[str, dict[str, str]]:
    """The entries of the bibliography by their keys."""
    text = (ROOT / "docs" / "references.bib").read_text(encoding="utf-8")
    return {
        key: {name: plain(value) for name, value in FIELD.findall(fields)}
        for key, fields in ENTRY.findall(text)
    }


ENTRIES = bibliography()


def cited(entry: dict[str, str]) -> str:
    """Authors and year of an entry, as a text cites it."""
    families = [author.partition(",")[0] for author in entry["author"].split(" and ")]
    names = " and ".join(families) if len(families) < 3 else f"{families[0]} et al."
    return f"{names} {entry['year']}"


def reference_page() -> str:
    """The page of all references."""
    rows = ["# References\n"]
    for key, entry in sorted(ENTRIES.items(), key=lambda item: cited(item[1]).lower()):
        authors = [" ".join(a.split(", ")[::-1]) for a in entry["author"].split(" and ")]
        where = [entry.get(name, "") for name in ("journal", "booktitle", "publisher")]
        where.append(entry.get("institution", ""))
        numbers = ", ".join(entry[name] for name in ("volume", "pages") if name in entry)
        parts = [*(part for part in where if part), *([numbers] if numbers else [])]
        doi = f" [doi](https://doi.org/{quote(entry['doi'])})." if "doi" in entry else ""
        row = f'<span id="{key}"></span>{", ".join(authors)} ({entry["year"]}): '
        rows.append(f"{row}*{entry['title']}*. {', '.join(parts)}.{doi}\n")
    return "\n".join(rows)


def chapter(name: str, page: str, content: str, parents: list[str]) -> dict:
    """A page of the book that is no file of docs."""
    return {
        "Chapter": {
            "name": name,
            "content": content,
            "number": None,
            "sub_items": [],
            "path": page,
            "source_path": None,
            "parent_names": parents,
        }
    }


def of_file(name: str, file: str, page: str, parents: list[str]) -> dict:
    """A page of the book made of a file of the repository."""
    text = (ROOT / file).read_text(encoding="utf-8")
    return chapter(name, page, rewritten(text, posixpath.dirname(file), page), parents)


def shown(output: dict) -> str:
    """An output of a cell of a notebook: a picture, a table, or text."""
    data = output.get("data", {})
    if "image/png" in data:
        picture = "".join("".join(data["image/png"]).split())
        return f'<img alt="" src="data:image/png;base64,{picture}">'
    if "text/html" in data:
        table = re.search(r"<table.*</table>", "".join(data["text/html"]), re.DOTALL)
        return re.sub(r"\n\s*", "", table[0]) if table else ""
    text = "".join(data.get("text/plain", output.get("text", "")))
    return f"```text\n{text.rstrip()}\n```"


def notebook_page() -> dict:
    """The notebook as a page: its text, its code, and what that has printed and drawn."""
    cells = json.loads((ROOT / NOTEBOOK).read_text(encoding="utf-8"))["cells"]
    parts = []
    for cell in cells:
        source = "".join(cell["source"])
        parts.append(f"```python\n{source}\n```" if cell["cell_type"] == "code" else source)
        parts += map(shown, cell.get("outputs", []))
    page = NOTEBOOK.removeprefix("docs/").replace(".ipynb", ".md")
    return chapter("A notebook", page, "\n\n".join(parts) + "\n", [])


def case_pages() -> list[dict]:
    """The page of each case, below the table that leads there: the sidebar leaves them out."""
    names = sorted(path.parent.name for path in (ROOT / "cases").glob("*/case.toml"))
    parents = ["Table of cases"]
    return [of_file(n, f"cases/{n}/README.md", f"cases/{n}.md", parents) for n in names]


def insert(book: dict, after: str, item: dict) -> None:
    """Puts a page behind that of a path."""
    items = book["items"]
    paths = [item["Chapter"]["path"] if "Chapter" in item else None for item in items]
    items.insert(paths.index(after) + 1, item)


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
            held = of_file(page["name"], "CONTRIBUTING.md", path, [])
            page["content"] = held["Chapter"]["content"]
            continue
        folder = posixpath.join("docs", posixpath.dirname(path))
        page["content"] = rewritten(page["content"], folder, path)
    table = of_file("Table of cases", "cases/README.md", "cases.md", [])
    table["Chapter"]["sub_items"] = case_pages()
    insert(book, "gallery.md", table)
    insert(book, "python.md", notebook_page())
    insert(
        book, "output.md", of_file("alewife-post", "postprocess/README.md", "postprocess.md", [])
    )
    insert(book, "performance.md", chapter("References", REFERENCES, reference_page(), []))
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
