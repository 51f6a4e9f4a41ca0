"""Meshes of other programs as files of Gmsh, with the groups of their cells as physical groups.

Read by meshio: MED, VTU, XDMF, Abaqus, Nastran and more. Written as MSH 2.2, text, which
`domain.mesh` reads.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

# Kinds of meshio that are kept: their number in Gmsh, and their dimension.
KINDS = {
    "line": (1, 1),
    "line3": (8, 1),
    "triangle": (2, 2),
    "triangle6": (9, 2),
    "tetra": (4, 3),
    "tetra10": (11, 3),
}
CORNERS = {"line": 2, "line3": 2, "triangle": 3, "triangle6": 3, "tetra": 4, "tetra10": 4}
# Gmsh has the last two inner nodes of a quadratic tetrahedron the other way round.
TETRAHEDRON = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
# Names of whole numbers by which formats mark cells.
MARKS = ("gmsh:physical", "cell_tags", "medit:ref", "nastran:ref", "su2:tag", "CellEntityIds")
NAMELESS = "boundary"


@dataclass
class Converted:
    """Elements with their groups, each group of one dimension."""

    points: np.ndarray
    elements: list[tuple[str, np.ndarray, list[str]]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def dimension(self) -> int:
        """Dimension of the cells."""
        return max(KINDS[kind][1] for kind, _, _ in self.elements)


def convert(source: Path, target: Path) -> list[str]:
    """Write a mesh as MSH 2.2; what was made of it, a sentence each."""
    if target.suffix.lower() != ".msh":
        raise ValueError(f"{target}: the name of the new file ends in .msh")
    if not source.is_file():
        raise FileNotFoundError(f"{source}: no such file")
    if target.exists() and target.samefile(source):
        raise ValueError(f"{target} is the file that is read: give the new one another name")
    converted = _read(source)
    _name_bare_facets(converted)
    text = _text(converted)
    target.write_text(text, encoding="utf-8")
    groups = sorted({name for _, _, names in converted.elements for name in names})
    cells = sum(KINDS[kind][1] == converted.dimension for kind, _, _ in converted.elements)
    kind = "triangles" if converted.dimension == 2 else "tetrahedra"
    converted.notes.append(f"{cells} {kind}, groups: {', '.join(groups)}")
    return converted.notes


def _read(source: Path) -> Converted:
    import meshio

    try:
        mesh = meshio.read(source)
    except SystemExit as error:
        # Meshio ends the program where it knows no format.
        raise ValueError(f"{source}: meshio does not read this format") from error
    except meshio.ReadError as error:
        raise ValueError(f"{source}: meshio cannot read it: {error}") from error
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    converted = Converted(points)
    dropped: dict[str, int] = {}
    for block, cells in enumerate(mesh.cells):
        names = _names(mesh, block, len(cells.data))
        kind, data = cells.type, np.asarray(cells.data)
        if kind == "quad":
            data, names = _triangles(points, data), [name for name in names for _ in (0, 1)]
            kind = "triangle"
            converted.notes.append(f"{len(cells.data)} quadrangles divided into triangles")
        if kind not in KINDS:
            if kind != "vertex":
                dropped[kind] = dropped.get(kind, 0) + len(data)
            continue
        converted.elements += [(kind, nodes, own) for nodes, own in zip(data, names, strict=True)]
    solid = {kind for kind in dropped if not kind.startswith("line")}
    if solid:
        raise ValueError(
            f"{source}: {', '.join(sorted(solid))} are neither triangles nor tetrahedra "
            "of order 1 or 2: mesh it again with these"
        )
    if not any(KINDS[kind][1] >= 2 for kind, _, _ in converted.elements):
        raise ValueError(f"{source}: no triangles, no tetrahedra")
    return converted


def _names(mesh: object, block: int, n: int) -> list[list[str]]:
    """Groups of each cell of a block."""
    names: list[list[str]] = [[] for _ in range(n)]
    for name, members in (mesh.cell_sets or {}).items():
        if members[block] is None or ":" in name:
            continue
        for cell in np.asarray(members[block], dtype=int):
            names[cell].append(str(name))
    if any(names):
        return names
    dimension = KINDS.get(mesh.cells[block].type, (0, -1))[1]
    by_number = {
        int(tag): name for name, (tag, of) in mesh.field_data.items() if int(of) == dimension
    }
    families = getattr(mesh, "cell_tags", None) or {}
    marks = next((mesh.cell_data[mark] for mark in MARKS if mark in mesh.cell_data), None)
    if marks is None:
        # A format without names of its own: the only whole numbers there are
        whole = [
            values
            for values in mesh.cell_data.values()
            if all(np.issubdtype(np.asarray(part).dtype, np.integer) for part in values)
        ]
        marks = whole[0] if len(whole) == 1 else None
    if marks is None:
        return names
    for cell, number in enumerate(np.asarray(marks[block]).ravel()):
        tag = int(number)
        if tag in families:
            names[cell] = [str(name).strip() for name in families[tag]]
        elif tag != 0:
            names[cell] = [by_number.get(tag, str(abs(tag)))]
    return names


def _triangles(points: np.ndarray, quads: np.ndarray) -> np.ndarray:
    """Two triangles of each quadrangle, along its shorter diagonal."""
    a, b, c, d = (quads[:, corner] for corner in range(4))
    along = np.linalg.norm(points[a] - points[c], axis=1)
    across = np.linalg.norm(points[b] - points[d], axis=1)
    first = np.where((along <= across)[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    other = np.where((along <= across)[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.stack([first, other], 1).reshape(-1, 3)


def _name_bare_facets(converted: Converted) -> None:
    """Give facets of the boundary that are in no group one of their own."""
    dimension = converted.dimension
    bare = "line" if dimension == 2 else "triangle"
    counts: dict[tuple[int, ...], int] = {}
    for kind, nodes, _ in converted.elements:
        if KINDS[kind][1] != dimension:
            continue
        corners = nodes[: CORNERS[kind]]
        for left_out in range(dimension + 1):
            facet = tuple(sorted(np.delete(corners, left_out).tolist()))
            counts[facet] = counts.get(facet, 0) + 1
    named = {
        tuple(sorted(nodes[: CORNERS[kind]].tolist()))
        for kind, nodes, names in converted.elements
        if KINDS[kind][1] == dimension - 1 and names
    }
    found = [facet for facet, n in counts.items() if n == 1 and facet not in named]
    converted.elements += [(bare, np.array(facet), [NAMELESS]) for facet in found]
    if found:
        converted.notes.append(f'{len(found)} facets without a group are the side "{NAMELESS}"')


def _text(converted: Converted) -> str:
    dimension = converted.dimension
    tags: dict[tuple[int, str], int] = {}
    rows = []
    for kind, nodes, names in converted.elements:
        number, own = KINDS[kind]
        if own < dimension - 1:
            continue
        nodes = nodes[TETRAHEDRON] if kind == "tetra10" else nodes
        nodes = " ".join(str(node + 1) for node in nodes.tolist())
        for name in names or ([""] if own == dimension else []):
            tag = tags.setdefault((own, name), len(tags) + 1) if name else 0
            rows.append(f"{len(rows) + 1} {number} 2 {tag} {tag} {nodes}")
    named = [f'{of} {tag} "{_plain(name)}"' for (of, name), tag in tags.items()]
    points = [
        f"{index + 1} {x!r} {y!r} {z!r}"
        for index, (x, y, z) in enumerate(converted.points.tolist())
    ]
    sections = {
        "MeshFormat": ["2.2 0 8"],
        "PhysicalNames": [str(len(named)), *named],
        "Nodes": [str(len(points)), *points],
        "Elements": [str(len(rows)), *rows],
    }
    lines = [[f"${name}", *body, f"$End{name}"] for name, body in sections.items()]
    return "\n".join(line for section in lines for line in section) + "\n"


def _plain(name: str) -> str:
    return name.replace('"', "'").strip()
