"""Makes first-look.ipynb: runs its cells and keeps what they print and draw.

Needs `pip install '.[all]' nbclient ipykernel` in a clone:   python docs/notebooks/make.py
"""

from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

# Text and code in turn
CELLS = [
    """
# A first look at alewife from Python

A case is loaded, run and compared with what is known of it; then it is drawn, and run again with other
values. The program `alewife` does the work. Everything needed is installed by `pip install '.[all]'` in a
clone of the repository:
""",
    """
%matplotlib inline
from importlib.util import find_spec

needed = ["alewife", "matplotlib", "pandas", "pyvista"]
missing = [name for name in needed if find_spec(name) is None]
if missing:
    remedy = "pip install '.[all]' in a clone of alewife"
    raise ImportError(f"no {', '.join(missing)} here: {remedy}")
""",
    """
## One run

`three-sphere` is the swimmer of Najafi and Golestanian: three spheres on two arms that shorten and lengthen
in turn. One cycle takes a few seconds.
""",
    """
import alewife

case = alewife.load("three-sphere")
run = case.run()
run.status["state"], run.status["dofs"]
""",
    """
Its references: the displacement over the cycle is known from an independent computation, and the error of the
balance of energy should be zero.
""",
    """
import pandas

columns = ["quantity", "computed", "reference", "kind", "verdict"]
pandas.DataFrame(run.references)[columns]
""",
    """
## A picture

The flow at the end of the cycle, as `alewife-post picture` draws it. Colours are the speed of the fluid seen
from the laboratory; the arrow is the direction in which the swimmer has moved.
""",
    """
from alewife_post import figure

figure.picture(run, "speed")
""",
    """
## Quantities over time

All of them are one table, a row for each step. Its last rows, for the three spheres:
""",
    """
series = run.to_dataframe()
series[["swimmer-1.x", "swimmer-2.x", "swimmer-3.x", "swimmer.power"]].tail(3)
""",
    """
## Many runs

The second mode of a squirmer does not change its speed, but it costs power. `set` gives a new case, `sweep`
runs it with each of the values:
""",
    """
squirmer = alewife.load("squirmer-alone").set("mesh.scale", 2)
second = "body.0.gait.squirmer.modes.1"
values = [-3.0, -1.5, 0.0, 1.5, 3.0]

table = alewife.sweep(squirmer, {second: values}, quantities=["squirmer.power"])
table[[second, "squirmer.power", "squirmer.velocity.x"]]
""",
    """
## Mistakes

A wrong key is an exception whose text says what is accepted:
""",
    """
try:
    case.set("fluid.visc", 2.0).check()
except alewife.BadCaseError as error:
    print(error)
""",
    """
More: the page *Python* of the documentation, and the tutorials.
""",
]


def main() -> None:
    """Run all cells and write the notebook beside this file."""
    kinds = [new_markdown_cell, new_code_cell]
    cells = [kinds[i % 2](text.strip()) for i, text in enumerate(CELLS)]
    notebook = new_notebook(cells=cells)
    NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    for number, cell in enumerate(notebook.cells):
        cell["id"] = f"cell-{number}"
        cell["metadata"] = {}
    nbformat.write(notebook, Path(__file__).with_name("first-look.ipynb"))


if __name__ == "__main__":
    main()
