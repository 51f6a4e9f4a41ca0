"""Pictures of calibrations: tracks over tracks, errors of what was fitted and held out apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alewife_post import calibration
from alewife_post.cli import main

FACTS = """
[reduced]
loads = "links"

[calibrated]
case = "eel"

[[calibrated.error]]
from = "slow.csv"
holdout = false
quantity = "eel-1.x in all"
model = 1.0
recorded = 1.01
relative = -0.01

[[calibrated.error]]
from = "fast.csv"
holdout = true
quantity = "eel-1.x in all"
model = 1.0
recorded = 0.8
relative = 0.25
"""


def written(path: Path) -> Path:
    path.mkdir()
    (path / "calibrated.toml").write_text(FACTS, encoding="utf-8")
    rows = ["from,holdout,track,time,model,recorded"]
    for name, held in (("fast.csv", "true"), ("slow.csv", "false")):
        rows += [f"{name},{held},eel-1.x,{t},{2 * t},{2 * t + 0.5}" for t in np.arange(5) / 4]
    (path / "tracks.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return path


def test_fitted_tracks_come_first_and_errors_are_apart(tmp_path: Path) -> None:
    found = calibration.open_calibration(written(tmp_path / "fit"))
    figure = calibration.calibration_figure(found)
    slow, fast, errors = figure.axes
    assert slow.get_title(loc="left") == "slow.csv, fitted"
    assert fast.get_title(loc="left") == "fast.csv, held out"
    recorded, model = slow.get_lines()
    assert np.allclose(recorded.get_ydata() - np.asarray(model.get_ydata()), 0.5)
    heights = [[bar.get_height() for bar in bars] for bars in errors.containers]
    assert heights == [[pytest.approx(1.0)], [pytest.approx(25.0)]]
    colours = {bars[0].get_facecolor() for bars in errors.containers}
    assert len(colours) == 2


def test_the_command_writes_a_picture_or_says_what_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "fit.png"
    assert main(["calibration", str(written(tmp_path / "fit")), "--out", str(out)]) == 0
    assert out.stat().st_size > 10_000
    assert main(["calibration", str(tmp_path)]) == 2
    assert "calibrated.toml" in capsys.readouterr().err
    (tmp_path / "fit" / "tracks.csv").write_text("time\n", encoding="utf-8")
    assert main(["calibration", str(tmp_path / "fit")]) == 2
    assert "columns" in capsys.readouterr().err
