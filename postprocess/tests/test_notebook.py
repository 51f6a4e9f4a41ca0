"""The notebook of the documentation: what its cells say can be run, and gives what it shows."""

import importlib.util
import json
import os
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).parents[2] / "docs" / "notebooks" / "first-look.ipynb"


@pytest.mark.skipif("ALEWIFE_BIN" not in os.environ, reason="needs the program: see test.sh")
def test_the_cells_of_the_notebook_run_and_print_what_it_shows(
    capsys: pytest.CaptureFixture[str],
) -> None:
    names: dict[str, object] = {}
    for cell in json.loads(NOTEBOOK.read_text())["cells"]:
        if cell["cell_type"] != "code":
            continue
        code = "".join(cell["source"]).replace("%matplotlib inline\n", "")
        exec(code, names)
        shown = [one["text"] for one in cell["outputs"] if one["output_type"] == "stream"]
        assert capsys.readouterr().out == "".join("".join(text) for text in shown)
    assert list(names["table"]["state"]) == ["finished"] * 5


def test_the_first_cell_says_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    code = next("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    found = importlib.util.find_spec

    def without_pandas(name: str) -> object:
        return None if name == "pandas" else found(name)

    monkeypatch.setattr(importlib.util, "find_spec", without_pandas)
    with pytest.raises(ImportError, match=r"no pandas here: pip install '\.\[all\]' in a clone"):
        exec(code.replace("%matplotlib inline\n", ""), {})
