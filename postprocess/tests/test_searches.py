"""Reports of soft runs, of finished searches and of calibrated reduced models."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import CAN_RENDER
from test_soft import write_run as write_frames

from alewife_post import open_run, records, report, searches, soft_scene
from alewife_post.cli import main

CASE = """title = 'a twin'
geometry = 'planar'
[soft]
frame = 0.5
frames = 2
[[marker]]
name = 'tip'
at = [1.0, 0.0]
columns = { x = 'x (mm)', y = '-y (mm)' }
[record]
file = 'record.csv'
time_unit = 1e-3
length_unit = 1e-3
begins_with = 'pull'
"""
RECORD = """time (ms),x (mm),y (mm),pull
0,9,9,
500,10,1,2
1000,10,1,3
1500,110,3,4
2000,310,,5
2500,999,9,6
"""


def write_run(place: Path, geometry: str) -> Path:
    write_frames(place, geometry)
    (place / "status.json").write_text('{"state": "finished", "fidelity": "soft"}')
    return place


def write_search(place: Path, search: str) -> Path:
    place.mkdir()
    sign = -1.0 if search == "optimisation" else 1.0
    (place / "case.toml").write_text(CASE)
    numbers = [
        {"name": "young", "bounds": [1e4, 1e6], "start": 6e4, "value": 4e4, "scale": None,
         "slope": 0.0, "reach": 0.2, "determined": True},
        {"name": "<nu>", "bounds": [0.1, 0.45], "start": 0.4, "value": 0.45, "scale": None,
         "slope": -1.0, "reach": None, "determined": True},
        {"name": "w", "bounds": [1.0, 3.0], "start": 1.0, "value": 2.0, "scale": 1.0,
         "slope": 0.0, "reach": None, "determined": False},
    ]  # fmt: skip
    said = {
        "search": search, "objective": 0.25, "start": 1.0, "evaluations": 3,
        "ended": "evaluations", "parameters": numbers,
        "comparison": [{"quantity": "young", "reference": 4e4, "allowed": 400.0, "within": True,
                        "kind": "exact", "source": "the model of the record", "computed": 4e4}],
    }  # fmt: skip
    (place / "report.json").write_text(json.dumps(said))
    rows = [(1.0, 6e4, 0.4, 1.0), (2.0, 5e4, 0.45, 1.5), (0.25, 4e4, 0.45, 2.0)]
    if search == "optimisation":
        rows[1] = (0.1, *rows[1][1:])
    text = "alewife search of crc32:1, version 0.1.0\n"
    for row in rows:
        text += " ".join(map(str, [sign * row[0], *row[1:], 0.0, 0.0, 0.0])) + " .\n"
    (place / "search.journal").write_text(text + "0.1 4e4 0.4")
    return place


@pytest.mark.parametrize("search", ["calibration", "optimisation"])
def test_a_search_has_a_page(search: str, tmp_path: Path) -> None:
    place = write_search(tmp_path / "found", search)
    found = searches.open_search(place)
    # A line that was not written whole is no evaluation; what is made large has its sign back
    second = 0.1 if search == "optimisation" else 2.0
    np.testing.assert_allclose(found.objectives, [1.0, second, 0.25])
    np.testing.assert_allclose(found.values[:, 0], [6e4, 5e4, 4e4])
    out = tmp_path / "a.html"
    assert main(["report", str(place), "--out", str(out)]) == 0
    text = out.read_text(encoding="utf-8")
    assert re.findall(r'(?:src|href)="(?!data:)', text) == []
    assert "<h1>a twin</h1>" in text
    assert f"<td>{search}</td>" in text
    warned = re.findall(r'<p class="warning">(.*?)</p>', text)
    assert [re.split(r"[ :]", one)[0] for one in warned] == ["The", "&lt;nu&gt;", "w"]
    assert "UNDETERMINED" in warned[2]
    assert "version 0.1.0" in text
    assert '<td class="within">within</td>' in text
    assert text.count("data:image/svg+xml") == 1


def test_the_best_so_far_is_drawn(tmp_path: Path) -> None:
    for search, best in (("calibration", [1.0, 1.0, 0.25]), ("optimisation", [1.0, 1.0, 1.0])):
        drawn = searches.search_figure(
            searches.open_search(write_search(tmp_path / search, search))
        )
        np.testing.assert_allclose(drawn.axes[0].lines[1].get_ydata(), best)
        bounds = [line.get_ydata()[0] for line in drawn.axes[1].lines[1:]]
        assert bounds == [1e4, 1e6]


def test_a_search_has_no_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = write_search(tmp_path / "found", "calibration")
    arguments = ["report", str(place), "--time", "1", "--out", str(tmp_path / "a.html")]
    assert main(arguments) == 2
    assert "leave --time out" in capsys.readouterr().err
    (place / "report.json").write_text("{}")
    assert main(["report", str(place), "--out", str(tmp_path / "a.html")]) == 2
    assert "is not the report of a search" in capsys.readouterr().err


def test_records_are_moved_to_where_the_run_begins(tmp_path: Path) -> None:
    run = write_run(tmp_path / "run", "planar")
    (run / "case.toml").write_text(CASE)
    (run / "record.csv").write_text(RECORD)
    (run / "series.csv").write_text("time,tip.x,tip.y\n0.0,1.0,0.0\n0.5,1.1,0.0\n1.0,1.3,0.0\n")
    along, across = records.records(open_run(run))
    # From the row at which the column first changes, as many as there are frames and one
    np.testing.assert_allclose(along.times, [0.0, 0.5, 1.0])
    np.testing.assert_allclose(along.values, [1.0, 1.1, 1.3])
    np.testing.assert_allclose(across.values, [0.0, -0.002, np.nan])
    text = report.report(open_run(run))
    assert "<h2>Markers and their record</h2>" in text
    (run / "record.csv").unlink()
    assert records.records(open_run(run)) == []


@pytest.mark.parametrize("geometry", ["planar", "axisymmetric", "spatial"])
def test_a_soft_run_has_a_scene(geometry: str, tmp_path: Path) -> None:
    if geometry == "spatial" and not CAN_RENDER:
        pytest.skip("VTK can have no window here")
    run = open_run(write_run(tmp_path / "run", geometry))
    shown = soft_scene.soft_scenery(run, 1.0)
    bodies = [part for part in shown.parts if part.name == soft_scene.BODY]
    assert len(bodies) == (2 if geometry == "axisymmetric" else 1)
    body = bodies[0]
    # The body is stretched by half along x, so that its tip has moved by 0.5
    assert body.points[:, 0].max() == pytest.approx(1.5)
    assert body.values["displacement"].max() == pytest.approx(0.5)
    assert body.values["speed"].max() == pytest.approx(1.0)
    corners = body.points[body.cells]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if geometry == "spatial":
        outwards = corners.mean(axis=1) - body.points[:4].mean(axis=0)
        assert ((normals * outwards).sum(axis=1) > 0.0).all()
    else:
        assert all(normals[:, 2] > 0.0)
    rest = [part for part in shown.parts if part.name == soft_scene.AT_REST]
    assert rest[0].points[:, 0].max() == pytest.approx(1.0)
    if geometry == "spatial":
        # All six edges of a tetrahedron are sharp, in two pieces each
        ends = {tuple(np.sort(pair)) for pair in rest[0].cells}
        assert len(ends) == 12
    if CAN_RENDER:
        text = report.report(run)
        assert "<h2>Body, t = 1" in text
        assert '"chosen":"displacement"' in text
        assert "data:image/png;base64," in text
        assert text.count("<script") == text.count("</script>") == 3


def test_a_calibrated_reduced_model_has_a_page(tmp_path: Path) -> None:
    place = tmp_path / "fit"
    place.mkdir()
    (place / "calibrated.toml").write_text(
        "[calibrated]\ncase = 'an eel'\nleft = 0.5\nperiods = [1.0, 2.0]\n"
        "[[calibrated.coefficient]]\nname = 'added_mass'\nvalue = 0.0\nuncertainty = 0.1\n"
        "bounds = [0.0, 10.0]\ndoubt = 'at its bound'\n"
        "[[calibrated.error]]\nfrom = 'run'\nholdout = false\nquantity = 'a.x in all'\n"
        "model = 1.0\nrecorded = 2.0\nrelative = -0.5\n"
    )
    (place / "tracks.csv").write_text(
        "from,holdout,track,time,model,recorded\nrun,false,a.x,0.0,0.0,0.0\nrun,false,a.x,1.0,1.0,2.0\n"
    )
    text = report.report_of(place)
    assert "<h1>Calibration of an eel</h1>" in text
    assert '<p class="warning">added_mass: at its bound</p>' in text
    assert "<td>1.0, 2.0</td>" in text
    assert "<td>a.x in all</td>" in text


def test_a_reduced_run_has_no_scene_to_ask_for(tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    (run / "case.toml").write_text(
        "title = 'an eel'\ngeometry = 'planar'\n[time.unsteady]\nend = 1.0\n"
    )
    (run / "status.json").write_text('{"state": "finished", "fidelity": "reduced"}')
    (run / "series.csv").write_text("time,eel.x\n0.0,0.0\n1.0,1.0\n")
    text = report.report(open_run(run))
    assert "output.fields" not in text
    assert "<h2>Series</h2>" in text
