"""Every message of runs of many kinds is what viewers expect: by the schemas Foxglove publishes.

Those in `foxglove/` are of the package `@foxglove/schemas` 2.1.0 (MIT).
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from mcap.reader import make_reader

from alewife_post import open_run
from alewife_post.members import from_case
from alewife_post.messages import cloud_of

PUBLISHED = {
    f"foxglove.{path.stem}": json.loads(path.read_text())
    for path in (Path(__file__).parent / "foxglove").glob("*.json")
}

# What the flow of two squirmers carries
CARRIED = [
    "scalar=[{ name = 'dye', diffusivity = 0.1, initial = 'x^2 - y' }]",
    "tracer=[{ name = 'beads', points = [[0.5, 4.25], [-0.5, 3.5]] }]",
    "output.fields={ steps = 2 }",
]

# Case, settings that make it short, and the topics of scenes beside /scene, /walls and /forces
CASES = {
    "rigid": ("squirmer-pair", ["time.unsteady.end=0.06", "mesh.scale=2", *CARRIED], set()),
    "fish": ("carangiform", ["time.unsteady.end=0.02", "mesh.scale=2"], set()),
    "flagellate": ("sperm-2d", ["time.unsteady.end=0.04", "mesh.scale=2"], set()),
    "axis": ("three-sphere", ["time.unsteady.end=0.3", "mesh.scale=2"], {"/arms"}),
    "space": ("squirmer-in-time-3d", ["time.unsteady.end=0.02", "mesh.scale=3"], set()),
    "linked in space": ("three-sphere-3d", ["time.unsteady.end=0.2", "mesh.scale=2.5"], {"/arms"}),
}
DEFORMING = {"fish", "flagellate"}

pytestmark = pytest.mark.skipif("ALEWIFE_BIN" not in os.environ, reason="needs ALEWIFE_BIN")


@pytest.fixture(scope="module", params=CASES)
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    case, settings, scenes = CASES[request.param]
    out = tmp_path_factory.mktemp("messages") / "run"
    command = [Path(os.environ["ALEWIFE_BIN"]).resolve(), "run", case, "--quiet", "--threads", "1"]
    command += ["--no-references", "--out", out]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return request.param, out, scenes


def messages(out: Path) -> list[tuple]:
    with (out / "run.mcap").open("rb") as file:
        found = make_reader(file).iter_messages()
        return [(s.name, s.data, channel.topic, json.loads(m.data)) for s, channel, m in found]


def test_messages_are_valid_by_published_and_by_own_schemas(made: tuple) -> None:
    kind, out, scenes = made
    validators, seen = {}, {}
    for name, schema, topic, content in messages(out):
        if topic not in validators:
            known = [json.loads(schema)]
            if name.startswith("foxglove."):
                known.append(PUBLISHED[name])
            validators[topic] = [jsonschema.Draft7Validator(one) for one in known]
        for validator in validators[topic]:
            validator.validate(content)
        seen.setdefault(topic, []).append(content)
    assert {"/scene", "/walls", "/forces", "/tf", "/step", "/log", *scenes} <= set(seen)
    n_rows = len(seen["/step"])
    assert n_rows > 1
    assert len(seen["/scene"]) == (n_rows if kind in DEFORMING else 1)
    for topic in {"/forces", *scenes}:
        assert len(seen[topic]) == n_rows


def test_bodies_are_told_as_names_and_case_tell_them(made: tuple) -> None:
    _, out, _ = made
    run = open_run(out)
    assert (out / "bodies.json").is_file()
    named = from_case(run.case, list(run.bodies), run.shapes)
    written = run.members
    assert written.swimmers == named.swimmers
    assert written.gaits == named.gaits
    assert written.deforming == named.deforming
    assert written.headings.keys() == named.headings.keys()
    for name, heading in written.headings.items():
        np.testing.assert_allclose(heading, named.headings[name], atol=2e-3)
    pairs = [{frozenset((one.parent, one.child)) for one in of.joints} for of in (written, named)]
    assert pairs[0] == pairs[1]


def test_quantities_are_those_of_the_series(made: tuple) -> None:
    _, out, _ = made
    series = open_run(out).series
    found: dict[str, list[float]] = {}

    def walk(path: str, content: dict) -> None:
        for key, value in content.items():
            if isinstance(value, dict):
                walk(f"{path}.{key}", value)
            else:
                name = path if key == "value" else f"{path}.{key}"
                found.setdefault(name, []).append(np.nan if value is None else value)

    groups: dict[str, dict] = {}
    for name, schema, topic, content in messages(out):
        if topic.startswith("/quantities/"):
            assert name == f"alewife.Quantities.{topic.removeprefix('/quantities/')}"
            groups[topic] = json.loads(schema)["properties"]
            assert set(groups[topic]) == set(content)
            walk(topic.removeprefix("/quantities/"), content)
    assert set(found) == set(series) - {"time"}
    for name, values in found.items():
        np.testing.assert_array_equal(values, series[name], err_msg=name)


def test_bodies_that_deform_are_where_the_mesh_has_them(made: tuple) -> None:
    kind, out, _ = made
    if kind not in DEFORMING:
        return
    run = open_run(out)
    ((name, shapes),) = run.shapes.items()
    body = run.bodies[name]
    assert len(shapes) == len(body.time)
    field = run.field()
    turn = body.angle[-1]
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    outline = shapes[-1].lines[0] @ rotation.T + body.center[-1, :2]
    distance = np.linalg.norm(field.nodes[None] - outline[:, None], axis=2).min(axis=1)
    assert distance.max() < 1e-6 * np.ptp(outline)
    # Its nodes one after the other: the outline does not jump
    sides = np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)
    assert sides.max() < 0.2 * np.ptp(outline)
    assert np.abs(shapes[-1].lines[0] - shapes[0].lines[0]).max() > 0


def test_clouds_are_what_files_have_at_nodes_and_of_particles(made: tuple) -> None:
    kind, out, _ = made
    run = open_run(out)
    if kind != "rigid":
        assert not list(run.clouds("/scalars/dye"))
        return
    clouds = list(run.clouds("/scalars/dye"))
    assert [cloud.time for cloud in clouds] == pytest.approx([one.time for one in run.frames])
    assert 1 < len(clouds) < len(run.series["time"])
    for cloud in clouds:
        field = run.field(cloud.time)
        assert np.ptp(field.scalars["dye"]) > 1
        np.testing.assert_array_equal(cloud.values, field.scalars["dye"].astype(np.float32))
        np.testing.assert_array_equal(cloud.points[:, :2], field.nodes.astype(np.float32))
        assert not cloud.points[:, 2].any()
    beads = list(run.clouds("/tracers/beads"))
    assert len(beads) == len(run.series["time"])
    assert all(len(cloud.points) == 2 and not cloud.values.any() for cloud in beads)
    np.testing.assert_allclose(beads[0].points, [[0.5, 4.25, 0], [-0.5, 3.5, 0]], rtol=1e-7)


def test_a_cloud_that_is_not_one_of_a_run_is_refused() -> None:
    fields = [{"name": name, "offset": 4 * n} for n, name in enumerate("xyzw")]
    content = {"fields": fields, "point_stride": 16, "data": "AAAAAAAAgD8AAABAAABAQA=="}
    cloud = cloud_of(content, 2.0)
    assert (cloud.time, cloud.points.tolist(), cloud.values.tolist()) == (2, [[0, 1, 2]], [3])
    with pytest.raises(ValueError, match="a cloud of x, y, z, w is not one"):
        cloud_of(content | {"point_stride": 20}, 2.0)


def test_arms_end_on_bodies(made: tuple) -> None:
    _, out, scenes = made
    if "/arms" not in scenes:
        return
    last = [content for _, _, topic, content in messages(out) if topic == "/arms"][-1]
    points = last["entities"][0]["lines"][0]["points"]
    ends = np.array([[point[axis] for axis in "xyz"] for point in points])
    centers = np.array([body.center[-1] for body in open_run(out).bodies.values()])
    assert len(ends) == 4
    assert np.linalg.norm(centers[None] - ends[:, None], axis=2).min(axis=1).max() < 1e-9
