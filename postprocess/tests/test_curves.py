"""Published curves: what their heads say, and what the shipped ones show."""

from pathlib import Path

import numpy as np
import pytest

from alewife_post.curves import curves_of, is_curve, read_curve

CASES = Path(__file__).parents[2] / "cases"
HEAD = "# Somebody 1999, figure 1\n# quantity = disc.y\n# source = Somebody 1999\n"


def test_a_curve_has_the_units_of_its_case(tmp_path: Path) -> None:
    path = tmp_path / "curve.csv"
    path.write_text(HEAD + "# time = 0.5\n# value = -2\n# offset = 6\nt,y\n2,1.5\n1,1\n")
    curve = read_curve(path)
    assert (curve.quantity, curve.label) == ("disc.y", "Somebody 1999 (published)")
    np.testing.assert_array_equal(curve.time, [0.5, 1.0])
    np.testing.assert_array_equal(curve.values, [4.0, 3.0])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("# source = x\n1,2\n", "# quantity = "),
        ("# quantity = disc.y\n1,2\n", "# source = "),
        (HEAD + "t,y\n1,2\n3\n", r"curve.csv:6: two numbers"),
        (HEAD + "t,y\n", "no points"),
        (HEAD + "# value = two\n1,2\n", "value = two"),
    ],
)
def test_a_bad_curve_says_what_is_wrong(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "curve.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=message):
        read_curve(path)


@pytest.mark.parametrize(
    ("name", "time", "value"),
    [
        # As the references of the two cases, which were read off by hand.
        ("drafting-kissing-tumbling/koblitz-2017-upper", 0.20, 2.5884),
        ("drafting-kissing-tumbling/koblitz-2017-lower", 0.20, 2.3321),
        ("drafting-kissing-tumbling/uhlmann-2005-upper", 0.20, 2.616),
        ("drafting-kissing-tumbling/uhlmann-2005-lower", 0.23, 1.839),
        ("disc-settling/koblitz-2017-height", 0.4, 2.1909),
        ("disc-settling/koblitz-2017-velocity", 0.2, -5.1698),
    ],
)
def test_shipped_curves_are_what_the_references_were_read_from(
    name: str, time: float, value: float
) -> None:
    curve = read_curve(CASES / f"{name}.csv")
    assert np.interp(time, curve.time, curve.values) == pytest.approx(value, abs=5e-4)


def test_every_shipped_curve_says_what_it_is() -> None:
    shipped = sorted(CASES.glob("*/*.csv"))
    curves = [path for path in shipped if is_curve(path)]
    assert len(curves) >= 6
    assert len(curves_of(CASES / "disc-settling")) == 2
