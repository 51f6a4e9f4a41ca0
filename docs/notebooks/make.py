"""Makes first-look.ipynb: runs its cells and keeps what they print and draw.

Needs `pip install '.[all]' nbclient ipykernel` in a clone:   python docs/notebooks/make.py
"""

from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

CELLS = [
    "# A first look at alewife from Python\n\nA case is loaded, set, run and drawn; the program "
    "`alewife` does the work.",
    "%matplotlib inline\nfrom importlib.util import find_spec\n\n"
    'needed = ["alewife", "matplotlib", "pandas", "pyvista"]\n'
    "missing = [name for name in needed if find_spec(name) is None]\n"
    "if missing:\n"
    "    remedy = \"pip install '.[all]' in a clone of alewife\"\n"
    "    raise ImportError(f\"no {', '.join(missing)} here: {remedy}\")\n\n"
    "import alewife\nfrom alewife_post import figure\n\n"
    'case = alewife.load("three-sphere")\nrun = case.run()\n'
    'run.status["state"], run.status["dofs"]',
    "What was computed beside what is known of the answer:",
    "import pandas\n\n"
    'columns = ["quantity", "computed", "reference", "kind", "verdict"]\n'
    "pandas.DataFrame(run.references)[columns]",
    "The flow at the end of the cycle, as `alewife-post picture` draws it:",
    'figure.picture(run, "speed")',
    "All quantities over time are one table:",
    'run.to_dataframe()[["swimmer-1.x", "swimmer-2.x", "swimmer-3.x", "swimmer.power"]].tail(3)',
    "## Many runs\n\nHow the second mode of a squirmer changes what it spends:",
    'squirmer = alewife.load("squirmer-alone").set("mesh.scale", 2)\n'
    'grid = {"body.0.gait.squirmer.modes.1": [-3.0, -1.5, 0.0, 1.5, 3.0]}\n'
    'table = alewife.sweep(squirmer, grid, quantities=["squirmer.power"])\n'
    'table[["body.0.gait.squirmer.modes.1", "squirmer.power", "squirmer.velocity.x"]]',
    "## Mistakes\n\nA wrong key is told with what is accepted:",
    'try:\n    case.set("fluid.visc", 2.0).check()\nexcept alewife.BadCaseError as error:\n'
    "    print(error)",
]


def main() -> None:
    """Run all cells and write the notebook beside this file."""
    # Text and code in turn
    kinds = [new_markdown_cell, new_code_cell]
    notebook = new_notebook(cells=[kinds[i % 2](text) for i, text in enumerate(CELLS)])
    NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    for number, cell in enumerate(notebook.cells):
        cell["id"] = f"cell-{number}"
        cell["metadata"] = {}
    nbformat.write(notebook, Path(__file__).with_name("first-look.ipynb"))


if __name__ == "__main__":
    main()
