"""A run directory: its files to arrays, each read when it is first asked for."""

from __future__ import annotations

import csv
import json
import struct
import tomllib
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from mcap.exceptions import McapError
from mcap.reader import NonSeekingReader

from alewife_post import checked, packages
from alewife_post.asked import Named
from alewife_post.members import Members, from_case, from_file
from alewife_post.messages import (
    BodyHistory,
    Cloud,
    Message,
    Shape,
    Solid,
    body_history,
    cloud_of,
    shape_of,
)
from alewife_post.units import Given

if TYPE_CHECKING:
    import pandas
    import pyvista

__all__ = [
    "BodyHistory",
    "Cloud",
    "Field",
    "Frame",
    "Message",
    "Run",
    "Shape",
    "Solid",
    "SolidField",
    "check_run",
    "open_run",
    "read_case",
    "read_field",
    "read_solid",
]

Array = np.ndarray

QUADRATIC_TRIANGLE = 22
QUADRATIC_TETRAHEDRON = 24
END_OF_FIELDS = b"</VTKFile>"
"""The last word of a field file."""
OF_FLOW = {"velocity", "pressure", "vorticity"}
"""Fields that every field file has."""
ROUNDING = 1e-9
"""Times that differ by this part are the same: one was read from a text."""
WRITTEN = (".alewife-run", "status.json", "provenance.json", "series.csv", "run.mcap", "fields.pvd")
"""Files of which a run has one at least, and a case none."""


@dataclass(frozen=True)
class Frame:
    """One field file."""

    time: float
    path: Path


@dataclass(frozen=True)
class Field:
    """Flow on the mesh of one time. Nodes are those of quadratic triangles or tetrahedra.

    A triangle lists its vertices counter-clockwise, then the nodes of its edges 01, 12, 20; a
    tetrahedron its vertices, then those of 01, 12, 20, 03, 13, 23. There are `d` dimensions.
    """

    time: float
    nodes: Array
    """Positions, `(n_nodes, d)`."""
    cells: Array
    """Nodes of each cell, `(n_cells, 6)`, in space `(n_cells, 10)`."""
    velocity: Array
    """`(n_nodes, d)`."""
    pressure: Array
    """`(n_nodes,)`."""
    vorticity: Array
    """`(n_nodes,)`, counter-clockwise; in space `(n_nodes, 3)`."""
    derived: Array | None = None
    """Another quantity, made of these, `(n_nodes,)`."""
    scalars: dict[str, Array] = field(default_factory=dict)
    """What the flow carries, by its names, each `(n_nodes,)`."""


@dataclass(frozen=True)
class SolidField:
    """A soft body on its mesh at one time, of quadratic triangles or tetrahedra."""

    time: float
    nodes: Array
    """Places, `(n_nodes, d)`."""
    cells: Array
    """Nodes of each cell, `(n_cells, 6)`, in space `(n_cells, 10)`."""
    at_nodes: dict[str, Array]
    """Vectors `(n_nodes, d)` and numbers `(n_nodes,)` by name."""
    in_cells: dict[str, Array]
    """Numbers of cells `(n_cells,)` by name."""


@dataclass(frozen=True)
class Run:
    """A run directory. Files are read when first asked for."""

    path: Path

    def __post_init__(self) -> None:
        """A text is a path as well."""
        object.__setattr__(self, "path", Path(self.path))

    @cached_property
    def case(self) -> dict[str, Any]:
        """The case as it was run, all defaults filled in."""
        return read_case(self.path)

    @cached_property
    def status(self) -> dict[str, Any]:
        """State, step, time and cost of each stage."""
        return json.loads((self.path / "status.json").read_text())

    @cached_property
    def warnings(self) -> list[dict[str, Any]]:
        """What the run warned of: `message`, `time` (None before its first row) and `count`."""
        return list(self.status.get("warnings", []))

    @cached_property
    def provenance(self) -> dict[str, Any]:
        """Which program ran the case, where and how."""
        return json.loads((self.path / "provenance.json").read_text())

    @cached_property
    def series(self) -> dict[str, Array]:
        """Columns of `series.csv`, `time` among them, each `(n_rows,)`."""
        with (self.path / "series.csv").open(newline="") as file:
            rows = list(csv.reader(file))
        if not rows:
            return Named({"time": np.empty(0)}, "column", "list(run.series)")
        names, rows = rows[0], rows[1:]
        # A row cut short by a full disk is no row.
        values = [[float(text) for text in row] for row in rows if len(row) == len(names)]
        table = np.array(values, dtype=float).reshape(-1, len(names))
        columns = dict(zip(names, table.T, strict=True))
        return Named(columns, "column", "list(run.series)")

    @cached_property
    def quantities(self) -> dict[str, float]:
        """The last value of each quantity, by name."""
        last = {name: float(values[-1]) for name, values in self.series.items() if len(values)}
        return Named(last, "quantity", "list(run.quantities)")

    def to_dataframe(self) -> pandas.DataFrame:
        """The series as a pandas table, indexed by time."""
        pandas = packages.needed("pandas")
        return pandas.DataFrame(self.series).set_index("time")

    @cached_property
    def members(self) -> Members:
        """Which bodies swim together, what joins them, and how each swims."""
        path = self.path / "bodies.json"
        if path.is_file():
            return from_file(json.loads(path.read_text()))
        return from_case(self.case, list(self.bodies), self.shapes)

    @property
    def bodies(self) -> dict[str, BodyHistory]:
        """All bodies of `run.mcap`, by name."""
        return self._bodies_and_shapes[0]

    @property
    def shapes(self) -> dict[str, list[Shape]]:
        """What each body looks like, in the order of time; once if it keeps its shape."""
        return self._bodies_and_shapes[1]

    @cached_property
    def _bodies_and_shapes(self) -> tuple[dict[str, BodyHistory], dict[str, list[Shape]]]:
        reports: dict[str, list[dict[str, Any]]] = {}
        shapes: dict[str, list[Shape]] = {}
        for message in self.messages():
            if message.topic.startswith("/body/"):
                reports.setdefault(message.topic.removeprefix("/body/"), []).append(message.content)
            elif message.topic == "/scene":
                for entity in message.content["entities"]:
                    shapes.setdefault(entity["id"], []).append(shape_of(entity, message.time))
        histories = {name: body_history(found) for name, found in reports.items()}
        return (
            Named(histories, "body", "list(run.bodies)"),
            Named(shapes, "body", "list(run.shapes)"),
        )

    def messages(self) -> Iterator[Message]:
        """All messages of `run.mcap` that were wholly written, in the order they were sent."""
        if not (self.path / "run.mcap").exists():
            # Killed before anything was written.
            return
        with (self.path / "run.mcap").open("rb") as file:
            # The index at the end of the file is missing while the run continues.
            found = NonSeekingReader(file).iter_messages(log_time_order=False)
            try:
                for _schema, channel, message in found:
                    time = message.log_time * 1e-9
                    yield Message(channel.topic, time, json.loads(message.data))
            except (McapError, struct.error):
                return

    def clouds(self, topic: str) -> Iterator[Cloud]:
        """The clouds of points of `run.mcap` under a topic, in the order of time.

        `/scalars/NAME` are as often as fields, `/tracers/NAME` as often as rows.
        """
        for message in self.messages():
            if message.topic == topic:
                yield cloud_of(message.content, message.time)

    @cached_property
    def fields(self) -> list[Frame]:
        """All field files of a flow in the order of time."""
        self.check_flow()
        return self.frames

    @cached_property
    def frames(self) -> list[Frame]:
        """All field files in the order of time, of a flow or of a soft body."""
        listing = self.path / "fields.pvd"
        if not listing.exists():
            return []
        sets = ElementTree.parse(listing).getroot().iter("DataSet")
        frames = [Frame(float(s.attrib["timestep"]), self.path / s.attrib["file"]) for s in sets]
        # Files that were removed since are no frames.
        found = [frame for frame in frames if frame.path.exists()]
        return sorted(found, key=lambda frame: frame.time)

    def field(self, time: float | None = None) -> Field:
        """The flow at the frame nearest to `time`, or at the last one."""
        return read_field(self.frame(time).path)

    def frame(self, time: float | None = None) -> Frame:
        """The frame of a flow nearest to `time`, or the last one."""
        self.check_flow()
        return self.frame_at(time)

    def frame_at(self, time: float | None = None) -> Frame:
        """The same, of a flow or of a soft body."""
        if not self.frames:
            raise FileNotFoundError(
                f"{self.path} has no field files: see output.fields of its case"
            )
        if time is None:
            return self.frames[-1]
        at = checked.time(time)
        return min(self.frames, key=lambda frame: abs(frame.time - at))

    def check_flow(self) -> None:
        """ValueError where there is no flow, but a soft body alone."""
        if "soft" in self.case:
            raise ValueError(
                f"{self.path} is a run of a soft case, which has no flow: alewife-post picture, "
                "film and gallery draw its body, plot its series; ParaView opens its fields.pvd"
            )

    def check_time(self, time: float) -> None:
        """ValueError where no field can be meant: before the first one, or after the last one."""
        times = [frame.time for frame in self.frames]
        if not times:
            return
        first, last = times[0], times[-1]
        slack = ROUNDING * max(abs(first), abs(last))
        if first - slack <= time <= last + slack:
            return
        if len(times) == 1:
            known = f"the only field is at t = {last:.6g} (output.fields of the case asks for more)"
        else:
            known = f"the fields begin at t = {first:.6g} and end at t = {last:.6g}"
        raise ValueError(f"t = {time:.6g} is not in {self.path}: {known}")

    @property
    def title(self) -> str:
        """What the case is called."""
        return self.case["title"]

    @property
    def units(self) -> Given:
        """Its units, as the case names them; an empty text if it names none."""
        return self.case.get("units", "")

    @property
    def scalars(self) -> list[str]:
        """Names of what the flow carries and what diffuses."""
        return [one["name"] for one in self.case.get("scalar", [])]

    @property
    def frame_name(self) -> str | None:
        """The body or swimmer its frame goes with, if there is one."""
        frame = self.case.get("frame")
        return frame if isinstance(frame, str) else None

    @property
    def is_unsteady(self) -> bool:
        """Whether the flow changes in time."""
        return "soft" in self.case or "unsteady" in self.case["time"]

    @property
    def is_axisymmetric(self) -> bool:
        """Whether x is an axis of revolution and y the distance from it."""
        return self.case["geometry"] == "axisymmetric"

    @property
    def is_spatial(self) -> bool:
        """Whether there are three dimensions."""
        return self.case["geometry"] == "spatial"


def read_case(directory: Path) -> dict[str, Any]:
    """The case in a directory, as it is written."""
    return tomllib.loads((directory / "case.toml").read_text())


def open_run(path: str | Path) -> Run:
    """Open a run directory, finished or not."""
    path = Path(path)
    if not (path / "case.toml").is_file():
        raise FileNotFoundError(_is_no_run(path))
    if not any((path / name).exists() for name in WRITTEN):
        raise FileNotFoundError(
            f"{path} is a case, not a run of it: alewife run {path} --out DIRECTORY makes one"
        )
    return Run(path)


def check_run(value: object, *, is_spatial: bool | None = None, instead: str = "") -> None:
    """TypeError where a value is no run; ValueError where it is one of the other dimension."""
    if not isinstance(value, Run):
        cure = f"alewife_post.open_run({str(value)!r})" if isinstance(value, str | Path) else None
        raise TypeError(f"{value!r} is no run: {cure or 'alewife_post.open_run(DIRECTORY)'} is one")
    if is_spatial is not None and value.is_spatial != is_spatial:
        kind = "in space" if value.is_spatial else "in the plane or about an axis"
        raise ValueError(f"{value.path} is a run {kind}: {instead} draws it")


def _is_no_run(path: Path) -> str:
    if not path.exists():
        return f"{path} does not exist"
    if path.is_file():
        return f"{path} is a file: name the directory of a run"
    if (path / "sweep.json").is_file():
        return f"{path} is a sweep: compare it, or name one of its points, such as points/0001"
    inside = sorted(one.name for one in path.iterdir() if (one / "case.toml").is_file())
    hint = f"; there is {inside[0]} inside" if inside else ""
    return f"{path} is not a run: it has no case.toml{hint}"


def read_solid(path: str | Path) -> SolidField:
    """Read one field file of a soft body."""
    grid = _read_grid(Path(path))
    cells, n = _cells(grid, path)

    def all_of(data: object) -> dict[str, Array]:
        return {name: np.array(values, dtype=float) for name, values in data.items()}

    at_nodes = {
        name: values[:, :n] if values.ndim > 1 else values
        for name, values in all_of(grid.point_data).items()
    }
    return SolidField(
        time=float(grid.field_data.get("TimeValue", [0.0])[0]),
        nodes=np.array(grid.points[:, :n], dtype=float),
        cells=cells,
        at_nodes=at_nodes,
        in_cells=all_of(grid.cell_data),
    )


def _cells(grid: pyvista.UnstructuredGrid, path: str | Path) -> tuple[Array, int]:
    """Nodes of all cells, and the number of dimensions."""
    by_type = grid.cells_dict
    dimensions = {QUADRATIC_TRIANGLE: 2, QUADRATIC_TETRAHEDRON: 3}
    if len(by_type) != 1 or set(by_type) - set(dimensions):
        raise ValueError(
            f"{path}: cells of VTK types {sorted(by_type)}; 22 or 24 alone can be drawn"
        )
    ((kind, cells),) = by_type.items()
    return np.array(cells), dimensions[kind]


def read_field(path: str | Path) -> Field:
    """Read one field file."""
    grid = _read_grid(Path(path))
    cells, n = _cells(grid, path)
    missing = OF_FLOW - set(grid.point_data.keys())
    if missing:
        found = ", ".join(sorted(grid.point_data.keys())) or "nothing"
        raise ValueError(
            f"{path} has no {' and no '.join(sorted(missing))} at nodes; it has {found}"
        )
    time = grid.field_data.get("TimeValue", [0.0])[0]
    return Field(
        time=float(time),
        nodes=np.array(grid.points[:, :n], dtype=float),
        cells=cells,
        velocity=np.array(grid.point_data["velocity"][:, :n], dtype=float),
        pressure=np.array(grid.point_data["pressure"], dtype=float),
        vorticity=np.array(grid.point_data["vorticity"], dtype=float),
        scalars={
            name: np.array(values, dtype=float)
            for name, values in grid.point_data.items()
            if name not in OF_FLOW and values.ndim == 1
        },
    )


def _read_grid(path: Path) -> pyvista.UnstructuredGrid:
    """What VTK reads from a file; ValueError in place of VTK's own messages where it is damaged."""
    # VTK takes seconds to load, and series need none of it.
    pyvista = packages.needed("pyvista")
    from vtkmodules.vtkCommonCore import vtkObject

    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - len(END_OF_FIELDS) - 8))
        if not file.read().rstrip().endswith(END_OF_FIELDS):
            raise ValueError(f"{path} is not whole: it does not end with {END_OF_FIELDS.decode()}")
    is_shown = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        reader = pyvista.get_reader(path)
        grid = reader.read()
        error = reader.reader.GetErrorCode()
    finally:
        vtkObject.SetGlobalWarningDisplay(is_shown)
    if error or not isinstance(grid, pyvista.UnstructuredGrid) or not grid.n_cells:
        raise ValueError(f"{path} is damaged: VTK cannot read a mesh from it")
    return grid
