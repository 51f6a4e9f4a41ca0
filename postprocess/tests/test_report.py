"""Reports: one page with all it needs, whose scene a browser shows."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import CAN_RENDER
from PIL import Image

from alewife_post import Run, open_run, report, scenery
from alewife_post.cli import main

BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
LARGEST = 5_000_000

pytestmark = pytest.mark.skipif(not CAN_RENDER, reason="VTK can have no window here")


def browser(*arguments: str) -> str:
    """What Chromium without a window and without a network prints."""
    if BROWSER is None:
        pytest.skip("there is no Chromium")
    how = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--hide-scrollbars"]
    how += ["--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND"]
    how += ["--virtual-time-budget=20000"]
    done = subprocess.run(
        [BROWSER, *how, *arguments], capture_output=True, text=True, timeout=120, check=True
    )
    return done.stdout


@pytest.fixture(scope="module")
def page(planar_run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "disc.html"
    assert main(["report", str(planar_run.path), "--out", str(out)]) == 0
    return out


def test_a_page_has_all_it_shows_in_it(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert len(text) < LARGEST
    assert re.findall(r'(?:src|href)="(?!data:)', text) == []
    assert "<h1>A disc in a shear</h1>" in text
    assert "data:image/svg+xml;base64," in text
    assert "[domain.disc]" in text
    # One script ends where another begins: none ends within a text
    assert text.count("<script") == text.count("</script>") == 3


def test_what_a_case_is_called_is_no_markup(planar_run: Run, tmp_path: Path) -> None:
    shutil.copytree(planar_run.path, tmp_path / "run")
    case = tmp_path / "run" / "case.toml"
    case.write_text(case.read_text().replace("A disc in a shear", "<b>&</script>"))
    status = '{"state": "finished", "warnings": [{"message": "a < b", "time": null, "count": 1}]}'
    (tmp_path / "run" / "status.json").write_text(status)
    text = report.report(open_run(tmp_path / "run"))
    assert "<h1>&lt;b&gt;&amp;&lt;/script&gt;</h1>" in text
    assert '<p class="warning">a &lt; b</p>' in text


def test_a_browser_shows_the_scene(page: Path, tmp_path: Path) -> None:
    assert 'data-scene="shown"' in browser("--dump-dom", page.as_uri())
    browser(f"--screenshot={tmp_path / 'page.png'}", "--window-size=900,1200", page.as_uri())
    image = np.asarray(Image.open(tmp_path / "page.png").convert("HSV"))
    # The speed of the ring is coloured from violet to yellow; the page around it is not
    hues = image[..., 0][image[..., 1] > 120]
    assert len(hues) > 30_000
    assert np.ptp(np.percentile(hues, [5, 95])) > 60


def test_places_and_colours_are_those_of_the_flow(planar_run: Run) -> None:
    shown = scenery.scenery(planar_run)
    fluid = shown.parts[0]
    assert fluid.values["speed"].max() == pytest.approx(4.0)
    assert np.linalg.norm(fluid.points, axis=1).max() == pytest.approx(2.0)
    assert fluid.cells.max() == len(fluid.points) - 1
    assert shown.scales["fluid", "speed"].ends == pytest.approx((0.0, 4.0), abs=1e-12)


def test_a_run_without_fields_has_a_page(planar_run: Run, tmp_path: Path) -> None:
    shutil.copytree(planar_run.path, tmp_path / "run")
    (tmp_path / "run" / "fields.pvd").unlink()
    text = report.report(open_run(tmp_path / "run"))
    assert "output.fields of its case asks for them" in text
    assert "three" not in text


def test_what_is_no_page_is_refused(
    planar_run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["report", str(planar_run.path), "--out", str(tmp_path / "a.png")]) == 2
    assert "a report is .html" in capsys.readouterr().err
    late = ["report", str(planar_run.path), "--time", "9", "--out", str(tmp_path / "a.html")]
    assert main(late) == 2
    assert "t = 9 is not in" in capsys.readouterr().err
