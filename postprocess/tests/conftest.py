"""A small run made here in the format of alewife, and one by alewife if `ALEWIFE_BIN` names it."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from alewife_post import Run, figure, open_run, scene, slices, space, stage, stills

matplotlib.use("Agg")
# Before anything loads VTK.
CAN_RENDER = scene.can_render()

TIMES = np.linspace(0.0, 4.0, 41)

CASE = """
title = "A disc in a shear"
geometry = "{geometry}"
units = "SI"
[fluid]
model = "stokes"
viscosity = 1.0
[domain.disc]
radius = 2.0
[[body]]
name = "disc"
center = {center}
angle = 0.0
[body.shape.{shape}]
radius = 1.0
[time.unsteady]
step = 0.1
end = 4.0
[statistics]
window = [2.0, 4.0]
[[reference]]
quantity = "disc.speed"
statistic = "max"
value = 0.5
per = 2.0
relative = 0.1
kind = "literature"
source = "nobody2000"
"""


def ring(n: int = 12, end: float = 2 * np.pi) -> tuple[np.ndarray, np.ndarray]:
    """Quadratic triangles between the circles of radius 1 and 2, as nodes and cells."""
    nodes: list[tuple[float, float]] = []
    number: dict[tuple[int, int], int] = {}
    is_closed = end > 6.0

    def node(i: int, j: int) -> int:
        """Node at the angle end * i / 2n and the radius 1 + j / 2."""
        key = (i % (2 * n) if is_closed else i, j)
        if key not in number:
            number[key] = len(nodes)
            angle, radius = end * i / (2 * n), 1.0 + j / 2
            on_axis = not is_closed and i in (0, 2 * n)
            nodes.append((radius * np.cos(angle), 0.0 if on_axis else radius * np.sin(angle)))
        return number[key]

    cells = []
    for i in range(0, 2 * n, 2):
        for a, b, c in [((i, 0), (i, 2), (i + 2, 0)), ((i + 2, 0), (i, 2), (i + 2, 2))]:
            middle = [((p[0] + q[0]) // 2, (p[1] + q[1]) // 2) for p, q in [(a, b), (b, c), (c, a)]]
            cells.append([node(*corner) for corner in [a, b, c, *middle]])
    return np.array(nodes), np.array(cells)


def velocity(nodes: np.ndarray) -> np.ndarray:
    """A flow without sources whose vorticity is -2 y."""
    return np.stack([nodes[:, 1] ** 2, 0.0 * nodes[:, 0]], axis=1)


def write_vtu(
    path: Path, nodes: np.ndarray, cells: np.ndarray, time: float, scale: float = 1.0
) -> None:
    """One field file, as text, its pressure multiplied."""

    def array(name: str, values: np.ndarray, kind: str = "Float64") -> str:
        components = 1 if values.ndim == 1 else values.shape[1]
        text = " ".join(map(repr, values.ravel().tolist()))
        attributes = f'type="{kind}" Name="{name}" NumberOfComponents="{components}"'
        return f'<DataArray {attributes} format="ascii">{text}</DataArray>\n'

    def spatial(values: np.ndarray) -> np.ndarray:
        return np.column_stack([values, np.zeros(len(values))])

    offsets = 6 * np.arange(1, len(cells) + 1)
    path.write_text(
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">\n'
        "<UnstructuredGrid><FieldData>"
        f'<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{time}'
        f"</DataArray></FieldData>\n"
        f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{len(cells)}"><PointData>\n'
        + array("velocity", spatial(velocity(nodes)))
        + array("pressure", scale * nodes[:, 0])
        + array("vorticity", -2 * nodes[:, 1])
        + "</PointData><Points>\n"
        + array("Points", spatial(nodes))
        + "</Points><Cells>\n"
        + array("connectivity", cells.ravel(), "Int64")
        + array("offsets", offsets, "Int64")
        + array("types", np.full(len(cells), 22), "UInt8")
        + "</Cells></Piece></UnstructuredGrid></VTKFile>\n"
    )


EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))


def block() -> tuple[np.ndarray, np.ndarray]:
    """Quadratic tetrahedra in a box of 27 cubes without the one in the middle."""
    nodes: list[tuple[float, ...]] = []
    number: dict[tuple[float, ...], int] = {}

    def node(at: np.ndarray) -> int:
        key = tuple(at.tolist())
        if key not in number:
            number[key] = len(nodes)
            nodes.append(key)
        return number[key]

    cells = []
    for corner in np.ndindex(3, 3, 3):
        if corner == (1, 1, 1):
            continue
        for order in [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]:
            steps = np.eye(3)[list(order)]
            vertices = np.array(corner) + np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])
            if np.linalg.det(vertices[1:] - vertices[0]) < 0:
                vertices[[2, 3]] = vertices[[3, 2]]
            middles = [0.5 * (vertices[i] + vertices[j]) for i, j in EDGES]
            cells.append([node(point) for point in [*vertices, *middles]])
    return np.array(nodes), np.array(cells)


def body_message(time: float) -> dict:
    """A body that moves along x and turns once in 2 pi."""
    still = {"x": 0.0, "y": 0.0, "z": 0.0}
    angle = (time + np.pi) % (2 * np.pi) - np.pi
    return {
        "step": round(10 * time),
        "time": time,
        "pose": {
            "center": {"x": 0.5 * time, "y": 0.0, "z": 0.0},
            "rotation": {"x": 0.0, "y": 0.0, "z": np.sin(angle / 2), "w": np.cos(angle / 2)},
            "angle": angle,
        },
        "twist": {"linear": {"x": 0.5, "y": 0.0, "z": 0.0}, "angular": {**still, "z": 1.0}},
        "load": {"force": {**still, "x": None}, "torque": still},
        "surface_load": {"force": still, "torque": still},
        "power": 0.25,
    }


def write_mcap(path: Path) -> None:
    """Messages of one body, in chunks of a few."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=2048, compression=CompressionType.ZSTD)
        writer.start()
        schema = writer.register_schema("alewife.Body", "jsonschema", b"{}")
        channel = writer.register_channel("/body/disc", "json", schema)
        for time in TIMES:
            data = json.dumps(body_message(float(time))).encode()
            stamp = round(time * 1e9)
            writer.add_message(channel, stamp, data, stamp)
        writer.finish()


def write_run(path: Path, *, is_axisymmetric: bool) -> None:
    """A run directory with two frames."""
    geometry, shape, center = ("planar", "disc", "[0.0, 0.0]")
    nodes, cells = ring()
    if is_axisymmetric:
        geometry, shape, center = ("axisymmetric", "sphere", "[0.0]")
        nodes, cells = ring(end=np.pi)
    (path / "fields").mkdir(parents=True)
    (path / "case.toml").write_text(CASE.format(geometry=geometry, shape=shape, center=center))
    body = {"name": "disc", "gait": None, "heading": None, "deforms": False}
    bodies = {"frame": None, "bodies": [body], "swimmers": [], "joints": []}
    (path / "bodies.json").write_text(json.dumps(bodies))
    (path / "status.json").write_text('{"state": "finished", "step": 40}\n')
    (path / "provenance.json").write_text('{"alewife": "0.1.0"}\n')
    rows = "".join(f"{time!r},{float(np.sin(time))!r}\n" for time in TIMES.tolist())
    (path / "series.csv").write_text("time,disc.speed\n" + rows)
    write_mcap(path / "run.mcap")
    sets = ""
    for step, time in [(0, 0.0), (40, 4.0)]:
        write_vtu(path / f"fields/{step:06}.vtu", nodes, cells, time)
        sets += f'<DataSet timestep="{time}" part="0" file="fields/{step:06}.vtu"/>\n'
    (path / "fields.pvd").write_text(
        f'<VTKFile type="Collection" version="1.0"><Collection>\n{sets}</Collection></VTKFile>\n'
    )


@pytest.fixture(scope="session", autouse=True)
def _coarse_images() -> Iterator[None]:
    """Images of the flow in few pixels: most of a test would be spent on those of papers.

    What is drawn by commands, as for the pages of tutorials, has all of them.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(figure, "IMAGE_WIDTH", 600)
        patch.setattr(slices, "IMAGE_WIDTH", 400)
        patch.setattr(space, "IMAGE_SIZE", (400, 300))
        patch.setattr(stage, "FINER", 1)
        patch.setattr(stills, "PIXELS", 100)
        yield


@pytest.fixture(scope="session")
def planar_run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Flow around a disc."""
    path = tmp_path_factory.mktemp("planar") / "run"
    write_run(path, is_axisymmetric=False)
    return open_run(path)


@pytest.fixture(scope="session")
def axisymmetric_run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Flow around a sphere, on the half plane."""
    path = tmp_path_factory.mktemp("axisymmetric") / "run"
    write_run(path, is_axisymmetric=True)
    return open_run(path)


@pytest.fixture(scope="session")
def computed_run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The case `squirmer-alone`, computed by the program `ALEWIFE_BIN` names."""
    program = os.environ.get("ALEWIFE_BIN")
    if not program:
        pytest.skip("ALEWIFE_BIN names no program")
    path = tmp_path_factory.mktemp("computed") / "run"
    subprocess.run([program, "run", "squirmer-alone", "--out", str(path)], check=True, timeout=300)
    return open_run(path)
