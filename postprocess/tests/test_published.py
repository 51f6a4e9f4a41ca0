"""Pictures of cases beside what is published: which are made, of which runs, and what they show."""

import json
from pathlib import Path

import numpy as np
import pytest
from test_compare import CURVE, write

from alewife_post import cli, open_run, published

GIVEN = """
[[reference]]
quantity = "disc.y"
statistic = "{statistic}"
{at}value = {value}
kind = "{kind}"
source = "Somebody 1999, table 1"
relative = 0.1
"""


def case(cases: Path, text: str) -> Path:
    folder = cases / "fall"
    folder.mkdir(parents=True)
    (folder / "case.toml").write_text('title = "t"\n' + text)
    return folder


def given(kind: str = "literature", value: float = 6.0, at: float | None = None) -> str:
    statistic = "final" if at is None else "at"
    when = "" if at is None else f"at = {at}\n"
    return GIVEN.format(statistic=statistic, at=when, value=value, kind=kind)


def compared(run: Path, **changed: object) -> None:
    row = {
        "case": "fall", "quantity": "disc.y", "minus": None, "statistic": "final", "at": None,
        "computed": 6.3, "reference": 6.0, "kind": "measured", "is_relative": True,
        "tolerance": 0.1, "uncertainty": 0.02, "numerical_uncertainty": None,
        "source": "Somebody 1999, table 1",
    }  # fmt: skip
    (run / "comparison.json").write_text(json.dumps({"comparisons": [row | changed]}))


def test_a_case_is_published_by_its_curves_or_the_kinds_of_its_values(tmp_path: Path) -> None:
    folder = case(tmp_path, given("exact") + given("regression"))
    assert not published.is_published(folder)
    (folder / "curve.csv").write_text(CURVE)
    assert published.is_published(folder)
    of_a_variant = given("measured").replace("[[reference]]", "[[variant.reference]]")
    (folder / "curve.csv").unlink()
    (folder / "case.toml").write_text(f'title = "t"\n[[variant]]\nname = "v"\n{of_a_variant}')
    assert published.is_published(folder)


@pytest.mark.parametrize("kind", ["measured", "exact"])
@pytest.mark.parametrize("is_beside", [True, False])
def test_a_case_is_published_by_the_kinds_in_its_table(
    tmp_path: Path, kind: str, is_beside: bool
) -> None:
    table = f"quantity, value, relative, kind,    source\n# one\n\ndisc.y,   6.0, 0.1, {kind}, a\n"
    folder = case(
        tmp_path,
        "[references]\n" + ('file = "references.csv"' if is_beside else f"table = '''\n{table}'''"),
    )
    (folder / "references.csv").write_text(table)
    assert published.is_published(folder) == (kind == "measured")


def test_a_published_curve_lies_on_the_one_of_its_variant(tmp_path: Path) -> None:
    variants = '[[variant]]\nname = "slow"\n[[variant]]\nname = "fast"\n'
    folder = case(tmp_path / "cases", variants)
    (folder / "curve.csv").write_text("# variant = fast\n" + CURVE)
    write(tmp_path / "runs/fall-slow", 10.0)
    write(tmp_path / "runs/fall-fast", 20.0)
    (axes,) = published.picture(folder, tmp_path / "runs").axes
    ours, theirs = axes.lines[:2]
    np.testing.assert_allclose(ours.get_ydata(), 20.0 - np.asarray(ours.get_xdata()) ** 2)
    np.testing.assert_allclose(theirs.get_ydata(), [10.0, 8.0, 0.0])


def test_values_at_several_times_are_points_of_a_curve(tmp_path: Path) -> None:
    run = write(tmp_path / "runs/fall", 10.0)
    text = "".join(given(value=10.0 - at * at, at=at) for at in (1.0, 0.5, 1.5))
    (run / "case.toml").write_text((run / "case.toml").read_text() + text)
    (axes,) = published.picture(case(tmp_path / "cases", text), tmp_path / "runs").axes
    np.testing.assert_array_equal(axes.lines[1].get_xdata(), [0.5, 1.0, 1.5])
    np.testing.assert_array_equal(axes.lines[1].get_ydata(), [9.75, 9.0, 7.75])
    assert published.points_of(open_run(run), None, {"disc.y"}) == []


def test_a_value_is_shown_by_its_difference_in_per_cent(tmp_path: Path) -> None:
    run = write(tmp_path / "fall", 10.0)
    compared(run, numerical_uncertainty=0.01)
    (value,) = published.values_of("v", open_run(run))
    assert value.label == "v: disc.y\nSomebody 1999"
    shown = (value.difference, value.numerical, value.uncertainty, value.tolerance)
    assert shown == pytest.approx((5.0, 1.0, 2.0, 10.0))
    compared(run, is_relative=False, tolerance=0.6, uncertainty=0.12, reference=-6.0)
    (value,) = published.values_of(None, open_run(run))
    shown = (value.difference, value.numerical, value.uncertainty, value.tolerance)
    assert shown == pytest.approx((205.0, 0.0, 2.0, 10.0))
    for nothing in ({"kind": "exact"}, {"computed": None}, {"reference": 0.0}):
        compared(run, **nothing)
        assert published.values_of(None, open_run(run)) == []


@pytest.mark.parametrize(
    ("source", "short"),
    [
        ("Somebody and Else 1998, figure 10", "Somebody and Else 1998"),
        ("One, Two and Three 2002, Journal 14", "One et al. 2002"),
        ("Code, finest level; benchmark of Others 1996", "Code, finest level"),
        ("One 2002; Two 2012", "One 2002"),
        ("the same: another one", "the same"),
        ("a" * 30 + " " + "b" * 30, "a" * 30 + " ..."),
    ],
)
def test_a_source_is_told_in_short(source: str, short: str) -> None:
    assert published.who(source) == short


def test_an_axis_shows_all_but_long_bars(tmp_path: Path) -> None:
    run = write(tmp_path / "fall", 10.0)
    compared(run, numerical_uncertainty=5.0)
    figure = published.values_figure(open_run(run), published.values_of(None, open_run(run)))
    np.testing.assert_allclose(figure.axes[0].get_xlim(), (-13.0, 13.0))


def test_all_cases_are_drawn_and_those_without_a_run_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cases, runs, out = (tmp_path / name for name in ("cases", "runs", "out"))
    case(cases, given("measured"))
    (cases / "other").mkdir()
    (cases / "other/case.toml").write_text('title = "t"\n')
    command = ["gallery", str(out), "--from", str(runs), "--published", str(cases)]
    assert cli.main(command) == 1
    assert "fall: " in capsys.readouterr().err and not list(out.iterdir())
    compared(write(runs / "fall", 10.0))
    assert cli.main(command) == 0
    assert [path.name for path in out.iterdir()] == ["fall.png"]
    assert cli.main(["gallery", str(out), "--published", str(tmp_path / "none")]) == 2
