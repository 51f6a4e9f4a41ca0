"""Meshes of other programs become files of Gmsh with the same cells and groups."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

meshio = pytest.importorskip("meshio")

from alewife_post import cli  # noqa: E402
from alewife_post.convert import convert  # noqa: E402

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]])
TRIANGLES = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
LINES = np.array([[3, 0], [2, 5], [0, 1], [1, 2], [3, 4], [4, 5]])
SIDES = {"left": [0], "right": [1], "wall": [2, 3, 4, 5]}


def channel(**more: object) -> meshio.Mesh:
    return meshio.Mesh(POINTS, [("line", LINES), ("triangle", TRIANGLES)], **more)


def groups(path: Path) -> dict[str, int]:
    """Number of facets in each group of a file."""
    mesh = meshio.read(path)
    names = {tag: name for name, (tag, _) in mesh.field_data.items()}
    found: dict[str, int] = {}
    for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"], strict=True):
        for tag in tags if block.type == "line" else []:
            found[names[tag]] = found.get(names[tag], 0) + 1
    return found


def test_sets_of_abaqus_become_groups(tmp_path: Path) -> None:
    sets = {name: [np.array(lines), np.array([], int)] for name, lines in SIDES.items()}
    channel(cell_sets=sets).write(tmp_path / "a.inp")
    notes = convert(tmp_path / "a.inp", tmp_path / "a.msh")
    assert groups(tmp_path / "a.msh") == {"left": 1, "right": 1, "wall": 4}
    assert "4 triangles, groups: left, right, wall" in notes[-1]


@pytest.mark.parametrize("ending", ["vtu", "xdmf", "vtk"])
def test_numbers_become_names(tmp_path: Path, ending: str) -> None:
    marks = [np.array([1, 2, 3, 3, 3, 3]), np.array([9, 9, 9, 9])]
    channel(cell_data={"side": marks}).write(tmp_path / f"a.{ending}")
    convert(tmp_path / f"a.{ending}", tmp_path / "a.msh")
    assert groups(tmp_path / "a.msh") == {"1": 1, "2": 1, "3": 4}


def test_families_of_med_become_groups(tmp_path: Path) -> None:
    pytest.importorskip("h5py")
    mesh = channel(cell_data={"cell_tags": [np.array([-1, -2, -3, -3, -3, -3]), np.zeros(4, int)]})
    mesh.cell_tags = {-1: ["left"], -2: ["right"], -3: ["wall"]}
    mesh.write(tmp_path / "a.med")
    convert(tmp_path / "a.med", tmp_path / "a.msh")
    assert groups(tmp_path / "a.msh") == {"left": 1, "right": 1, "wall": 4}


def test_quadrangles_are_divided_and_bare_facets_get_a_name(tmp_path: Path) -> None:
    quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])
    meshio.Mesh(POINTS, [("quad", quads)]).write(tmp_path / "a.vtu")
    notes = convert(tmp_path / "a.vtu", tmp_path / "a.msh")
    assert groups(tmp_path / "a.msh") == {"boundary": 6}
    assert "2 quadrangles divided" in notes[0] and "4 triangles" in notes[-1]


def test_what_cannot_be_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cube = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    cube += [[x, y, 1.0] for x, y, _ in cube]
    meshio.Mesh(np.array(cube), [("hexahedron", np.arange(8)[None])]).write(tmp_path / "a.vtu")
    (tmp_path / "b.vtu").write_text("nothing")
    for arguments, words in [
        (["a.vtu", "a.msh"], "hexahedron"),
        (["none.vtu", "a.msh"], "no such file"),
        (["b.vtu", "a.msh"], "b.vtu"),
        (["a.vtu", "a.vtk"], "ends in .msh"),
    ]:
        paths = [str(tmp_path / name) for name in arguments]
        assert cli.main(["convert", *paths]) == 2
        assert words in capsys.readouterr().err
