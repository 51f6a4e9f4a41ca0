"""Files are read as what was written."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import TIMES, ring, velocity

from alewife_post import Run, cli, open_run
from alewife_post.read import read_field


def test_series_keep_every_bit(planar_run: Run) -> None:
    assert (planar_run.series["time"] == TIMES).all()
    assert (planar_run.series["disc.speed"] == np.sin(TIMES)).all()


def test_a_row_cut_short_is_no_row(planar_run: Run, tmp_path: Path) -> None:
    shutil.copytree(planar_run.path, tmp_path / "run")
    text = (planar_run.path / "series.csv").read_text()
    (tmp_path / "run/series.csv").write_text(text.rstrip().rsplit(",", 1)[0])
    assert len(open_run(tmp_path / "run").series["time"]) == len(TIMES) - 1


def test_status_and_case_are_tables(planar_run: Run) -> None:
    assert planar_run.status["state"] == "finished"
    assert planar_run.case["body"][0]["name"] == "disc"
    assert planar_run.provenance["alewife"] == "0.1.0"


def test_bodies_are_arrays_over_time(planar_run: Run) -> None:
    disc = planar_run.bodies["disc"]
    np.testing.assert_allclose(disc.center[:, 0], 0.5 * TIMES)
    # The angle in the file jumps at pi; the one read does not.
    np.testing.assert_allclose(disc.angle, TIMES)
    assert disc.rotation.shape == (len(TIMES), 4)
    assert np.isnan(disc.force[:, 0]).all()
    assert (disc.power == 0.25).all()


def test_a_truncated_file_gives_all_whole_chunks(planar_run: Run, tmp_path: Path) -> None:
    shutil.copytree(planar_run.path, tmp_path / "run")
    whole = (planar_run.path / "run.mcap").read_bytes()
    found = []
    for length in range(16, len(whole), 53):
        (tmp_path / "run/run.mcap").write_bytes(whole[:length])
        bodies = open_run(tmp_path / "run").bodies
        found.append(len(bodies["disc"].time) if bodies else 0)
    assert found[0] == 0
    assert 0 < found[len(found) // 2] <= len(TIMES)
    assert found[-1] == len(TIMES)
    assert found == sorted(found)


def test_fields_are_listed_in_time(planar_run: Run) -> None:
    assert [frame.time for frame in planar_run.fields] == [0.0, 4.0]
    assert planar_run.field(0.3).time == 0.0
    assert planar_run.field().time == 4.0


def test_a_field_has_its_nodes_cells_and_values(planar_run: Run) -> None:
    field = planar_run.field()
    nodes, cells = ring()
    np.testing.assert_allclose(field.nodes, nodes)
    assert (field.cells == cells).all()
    np.testing.assert_allclose(field.velocity, velocity(nodes))
    np.testing.assert_allclose(field.pressure, nodes[:, 0])


def test_a_directory_without_a_case_is_no_run(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="not a run"):
        open_run(tmp_path)


def test_a_run_without_fields_says_so(planar_run: Run, tmp_path: Path) -> None:
    shutil.copytree(planar_run.path, tmp_path / "run")
    (tmp_path / "run/fields.pvd").unlink()
    with pytest.raises(FileNotFoundError, match=r"output\.fields"):
        open_run(tmp_path / "run").field()


@pytest.mark.parametrize("part", [0.0, 0.3, 0.98])
def test_a_field_that_was_cut_short_is_one_line(
    planar_run: Run,
    tmp_path: Path,
    part: float,
    capfd: pytest.CaptureFixture[str],
    recwarn: pytest.WarningsRecorder,
) -> None:
    shutil.copytree(planar_run.path, tmp_path / "run")
    file = tmp_path / "run/fields/000040.vtu"
    content = file.read_bytes()
    file.write_bytes(content[: round(part * len(content))])
    assert cli.main(["picture", str(tmp_path / "run"), "--out", str(tmp_path / "x.png")]) == 2
    output = capfd.readouterr()
    assert output.out == ""
    assert output.err.count("\n") == 1
    assert "000040.vtu is not whole" in output.err
    assert len(recwarn) == 0
    assert not (tmp_path / "x.png").exists()


def test_a_field_that_is_damaged_within_is_one_line(
    planar_run: Run, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "damaged.vtu"
    content = planar_run.fields[0].path.read_text()
    for damaged in (
        content.replace('<Piece NumberOfPoints="', '<Piece NumberOfPoints="9'),
        content.replace("</Points>", ""),
        "</VTKFile>",
    ):
        file.write_text(damaged)
        with pytest.raises(ValueError, match=r"damaged\.vtu is damaged"):
            read_field(file)
    output = capfd.readouterr()
    assert output.out + output.err == ""


@pytest.mark.parametrize("time", [-0.1, 4.01, 100.0])
def test_a_time_out_of_a_run_is_told_with_its_end(
    planar_run: Run, tmp_path: Path, time: float, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "x.png"
    command = ["picture", str(planar_run.path), "--out", str(out), "--time"]
    assert cli.main([*command, str(time)]) == 2
    said = capsys.readouterr().err
    assert "the fields begin at t = 0 and end at t = 4" in said
    assert not out.exists()


def test_a_time_between_two_fields_is_that_of_the_nearest(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "x.png"
    command = ["picture", str(planar_run.path), "--out", str(out), "--time"]
    for time in ("0.0", "3.2", "4.000000001"):
        assert cli.main([*command, time]) == 0
        assert capsys.readouterr().out == f"wrote {out}\n"


def test_a_computed_run_reads(computed_run: Run) -> None:
    assert computed_run.status["state"] == "finished"
    assert len(computed_run.series["time"]) >= 1
    (name,) = (body["name"] for body in computed_run.case["body"])
    assert computed_run.bodies[name].center.shape[1] == 3
    field = computed_run.field()
    assert field.cells.max() == len(field.nodes) - 1
    assert np.isfinite(field.velocity).all()
