"""Figures show the flow where it is, and nothing over it."""

from dataclasses import replace
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from conftest import CAN_RENDER
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from alewife_post import Run, cli, drawing, fields, figure, series, snapshot, style
from alewife_post.drawing import boundary_loops
from alewife_post.elements import smooth_outline
from alewife_post.quantities import percentile
from alewife_post.read import Field
from alewife_post.units import units_of

VTK = pytest.param(
    "vtk", marks=pytest.mark.skipif(not CAN_RENDER, reason="VTK can have no window here")
)
PAINTERS = ["matplotlib", VTK]


def painted(drawn: Figure) -> np.ndarray:
    """The pixels of a figure, `(height, width, 4)` in [0, 1], after its layout is settled."""
    canvas = FigureCanvasAgg(drawn)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba()) / 255.0


@pytest.mark.parametrize("painter", PAINTERS)
@pytest.mark.parametrize("quantity", figure.QUANTITIES)
def test_every_quantity_is_written(
    planar_run: Run, tmp_path: Path, quantity: str, painter: str
) -> None:
    out = tmp_path / "picture.png"
    arguments = [str(planar_run.path), "--out", str(out), "--quantity", quantity]
    assert cli.picture([*arguments, "--painter", painter]) == 0
    image = matplotlib.image.imread(out)
    assert image.shape[1] > 700
    assert image[..., :3].std() > 0.05


@pytest.mark.parametrize("painter", PAINTERS)
def test_both_painters_put_colours_in_the_same_places(planar_run: Run, painter: str) -> None:
    drawn = figure.picture(planar_run, "pressure", time=0.0, painter=painter)
    image = painted(drawn)
    axes = drawn.axes[0]

    def colour(x: float, y: float) -> np.ndarray:
        across, up = axes.transData.transform((x, y))
        return image[image.shape[0] - 1 - round(up), round(across), :3]

    # The pressure is x: warm on the right, cool on the left; the disc has its own colour, and
    # there is nothing in the corners.
    right, left = colour(1.5, 0.1), colour(-1.5, 0.1)
    assert right[0] > right[2] + 0.2
    assert left[2] > left[0] + 0.05
    body = np.array(matplotlib.colors.to_rgb(style.BODY))
    np.testing.assert_allclose(colour(0.02, 0.02), body, atol=0.02)
    np.testing.assert_allclose(colour(1.95, 1.95), 1.0, atol=0.02)


@pytest.mark.parametrize("lines", ["streamlines", "arrows", "none"])
def test_lines_of_each_kind_can_be_drawn(axisymmetric_run: Run, lines: str) -> None:
    drawn = figure.picture(axisymmetric_run, "speed", lines=lines, painter="matplotlib")
    painted(drawn)
    assert drawn.axes[0].get_ylim() == (-2.0, 2.0)


def test_one_side_of_the_axis_can_be_shown(axisymmetric_run: Run) -> None:
    drawn = figure.picture(axisymmetric_run, "vorticity", mirror=False, painter="matplotlib")
    assert drawn.axes[0].get_ylim() == (0.0, 2.0)


def test_the_bar_lies_beside_the_picture_and_scales_are_equal(planar_run: Run) -> None:
    for view in [None, (-2.0, 2.0, -0.5, 0.5)]:
        drawn = figure.picture(planar_run, "speed", view=view, painter="matplotlib")
        painted(drawn)
        axes, bar = drawn.axes
        assert not axes.get_window_extent().overlaps(bar.get_window_extent())
        box = axes.get_window_extent()
        x, y = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
        assert abs(box.width / box.height / (x / y) - 1) < 0.01
        assert bar.get_xlabel() + bar.get_ylabel() == "speed (m/s)"


def test_a_frame_that_moves_with_a_body_loses_its_velocity(planar_run: Run) -> None:
    np.testing.assert_allclose(fields.body_velocity(planar_run, "disc", 4.0), [0.5, 0.0])
    drawn = figure.picture(planar_run, "speed", frame="disc", lines="none", painter="matplotlib")
    assert drawn.axes[1].get_ylabel() == "speed (m/s) relative to disc"


def test_a_frame_of_an_unknown_body_is_answered_with_the_nearest_ones(planar_run: Run) -> None:
    with pytest.raises(KeyError, match="no body swimmer; bodies of this run: disc"):
        figure.picture(planar_run, frame="swimmer", painter="matplotlib")


def test_the_distance_from_an_axis_is_named_r(axisymmetric_run: Run) -> None:
    drawn = figure.picture(axisymmetric_run, lines="none", painter="matplotlib")
    assert drawn.axes[0].get_ylabel() == "r (m)"


def test_streamlines_of_both_sides_of_an_axis_are_mirror_images(axisymmetric_run: Run) -> None:
    drawn = figure.picture(axisymmetric_run, lines="streamlines", painter="matplotlib")
    drawn.canvas.draw()
    axes = drawn.axes[0]
    (lines,) = [one for one in axes.collections if one.get_zorder() == 3]
    points = np.concatenate(lines.get_segments())
    upper, lower = points[points[:, 1] > 0.0], points[points[:, 1] < 0.0]
    assert len(lines.get_segments()) > 10
    ordered = [one[np.lexsort(one.T)] for one in (upper, lower * [1.0, -1.0])]
    np.testing.assert_allclose(*ordered, atol=1e-9)


def test_limits_of_colours_go_by_area_and_not_by_crowded_nodes() -> None:
    # A thousand values of a gap that holds a millionth of the area
    values = np.concatenate([np.linspace(0.0, 1.0, 1001), np.full(1000, 50.0)])
    share = np.concatenate([np.full(1001, 1.0), np.full(1000, 1e-6)])
    _, (low, high) = style.colours("speed", values, share)
    assert low == 0.0
    assert 0.98 < high <= 1.0
    assert style.colours("speed", values)[1][1] == 50.0
    _, (low, high) = style.colours("pressure", values - 0.5, share)
    assert low == -high
    assert 0.48 < high <= 0.5


def test_limits_of_vorticity_do_not_depend_on_the_fluid_at_rest() -> None:
    values, share = np.linspace(-1.0, 1.0, 2001), np.full(2001, 1.0)
    _, (low, high) = style.colours("vorticity", values, share)
    # 75 % of the integral of |w| lie below the root of 0.75
    assert (low, high) == pytest.approx((-(0.75**0.5), 0.75**0.5), abs=2e-3)
    still = np.zeros(100_000)
    wide = style.colours("vorticity", np.append(values, still), np.append(share, still + 9.0))
    assert wide[1] == pytest.approx((low, high), abs=2e-3)
    # A tip that is fifty times as strong on a thousandth of the area holds a tenth of it
    tip = style.colours("vorticity", np.append(values, 50.0), np.append(share, 2.0))
    assert tip[1][1] < 1.0
    # Magnitudes, in space, use all of a map of one side
    assert style.colours("vorticity", np.abs(values), share) == ("Reds", (0.0, high))


def test_a_percentile_is_that_of_a_uniform_distribution() -> None:
    values = np.random.default_rng(3).permutation(np.linspace(0.0, 1.0, 2001))
    assert percentile(values, np.ones(2001), 25.0) == pytest.approx(0.25, abs=1e-3)
    # Shares that grow with the value: the density is 2 v, half of it lies below the root of 1/2
    assert percentile(values, values, 50.0) == pytest.approx(0.5**0.5, abs=1e-3)


def test_a_body_that_the_view_cuts_keeps_its_colour(planar_run: Run) -> None:
    drawn = figure.picture(planar_run, view=(0.2, 1.9, -0.5, 0.5), time=0.0, painter="matplotlib")
    image = painted(drawn)
    axes = drawn.axes[0]
    across, up = axes.transData.transform((0.5, 0.3))
    body = np.array(matplotlib.colors.to_rgb(style.BODY))
    seen = image[image.shape[0] - 1 - round(up), round(across), :3]
    np.testing.assert_allclose(seen, body, atol=0.02)


def test_a_series_shows_the_interval_of_a_reference(planar_run: Run, tmp_path: Path) -> None:
    drawn = series.series_figure(planar_run, ["disc.speed"])
    (axes,) = drawn.axes
    (text,) = axes.get_legend().get_texts()
    # value 0.5 times per 2.0, within a tenth
    assert text.get_text() == "max, published: nobody2000: 1 ± 0.1"
    (band,) = axes.collections
    corners = band.get_paths()[0].vertices
    np.testing.assert_allclose([corners.min(axis=0), corners.max(axis=0)], [[2, 0.9], [4, 1.1]])
    arguments = [str(planar_run.path), "--out", str(tmp_path / "series.svg")]
    assert cli.series([*arguments, "--quantity", "disc.speed", "--window", "1", "3"]) == 0


def test_an_unknown_quantity_is_answered_with_the_nearest_ones(
    planar_run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.series([str(planar_run.path), "--out", "no.png", "--quantity", "spede"]) == 2
    assert "nearest: disc.speed" in capsys.readouterr().err


def test_a_smooth_outline_passes_its_points_and_stays_near_a_circle() -> None:
    angles = np.arange(12) * np.pi / 6
    points = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    outline = smooth_outline(points, 8)
    np.testing.assert_allclose(outline[::8], points)
    assert abs(np.linalg.norm(outline, axis=1) - 1).max() < 2e-3


def test_a_computed_run_is_drawn(computed_run: Run, tmp_path: Path) -> None:
    out = tmp_path / "picture.png"
    assert cli.picture([str(computed_run.path), "--out", str(out)]) == 0
    assert matplotlib.image.imread(out)[..., :3].std() > 0.05


def test_bodies_of_swimmers_are_what_the_mesh_leaves_out() -> None:
    # One straight-sided cell of four triangles around a square hole, in a square
    corners = [(-2, -2), (2, -2), (2, 2), (-2, 2), (-1, -1), (1, -1), (1, 1), (-1, 1)]
    triangles = [
        (a, b, c)
        for k in range(4)
        for a, b, c in [(k, (k + 1) % 4, 4 + k), ((k + 1) % 4, 4 + (k + 1) % 4, 4 + k)]
    ]
    nodes = [np.array(corner, dtype=float) for corner in corners]
    middles: dict[frozenset[int], int] = {}
    cells = []
    for a, b, c in triangles:
        cell = [a, b, c]
        for ends in ((a, b), (b, c), (c, a)):
            key = frozenset(ends)
            if key not in middles:
                middles[key] = len(nodes)
                nodes.append((nodes[ends[0]] + nodes[ends[1]]) / 2)
            cell.append(middles[key])
        cells.append(cell)
    still, none = np.zeros((len(nodes), 2)), np.zeros(len(nodes))
    field = Field(0.0, np.array(nodes), np.array(cells), still, pressure=none, vorticity=none)
    loops = boundary_loops(field)
    assert sorted(float(np.ptp(loop, axis=0).max()) for loop in loops) == [2.0, 4.0]


@pytest.mark.parametrize(
    ("text", "units"),
    [
        ("SI", ("m", "s")),
        ("dimensionless", (None, None)),
        ("cm g s", ("cm", "s")),
        ("mm mg s", ("mm", "s")),
        ("micrometres, seconds, water: viscosity 1e-3 Pa s", ("µm", "s")),
        ("si units", ("m", "s")),
        ("physics of silicon", (None, None)),
    ],
)
def test_units_are_those_the_case_names(text: str, units: tuple[str | None, str | None]) -> None:
    found = units_of(text)
    assert (found.length, found.time) == units


def test_labels_have_units_where_they_are_known() -> None:
    assert style.label("speed", "micrometres, seconds") == "speed (µm/s)"
    assert style.label("pressure", "cm g s") == "pressure"
    assert style.label("vorticity", "seconds") == "vorticity (1/s)"
    assert style.length_label("x", "dimensionless") == "x"
    assert style.time_text(0.25, "mm mg s") == "t = 0.25 s"
    assert style.length_text(0.5, "SI") == "0.5 m"


def test_titles_have_as_many_lines_as_they_need_and_times_stay_in_one_piece() -> None:
    assert style.fitted("A disc, t = 0.5 s", 5.0) == "A disc, t = 0.5 s"
    long = "Two discs, one above the other: drafting and kissing, t = 0.2032 s, z = 0.5"
    lines = style.fitted(long, 3.0).splitlines()
    assert len(lines) == 2
    assert max(map(len, lines)) <= 3.0 * style.LETTERS
    assert " ".join(lines) == long
    assert any("t = 0.2032 s" in line for line in lines)


def test_a_scale_bar_lies_where_no_body_is_and_only_with_a_unit(planar_run: Run) -> None:
    view = (0.0, 4.0, 0.0, 2.0)
    axes = Figure().add_subplot()
    drawing.draw_scale_bar(axes, view, "dimensionless")
    assert not axes.artists
    for body in ([3.8, 0.2, 0.0], [1.0, 1.0, 0.0]):
        drawing.draw_scale_bar(axes, view, "SI", [np.array(body)])
    codes = [bar.loc for bar in axes.artists]
    right, left = AnchoredSizeBar.codes["lower right"], AnchoredSizeBar.codes["lower left"]
    assert codes == [left, right]
    drawn = figure.picture(planar_run, lines="none", painter="matplotlib")
    (bar,) = drawn.axes[0].artists
    # A fifth of four metres, rounded down
    assert bar.txt_label.get_text() == "0.5 m"
    painted(drawn)
    width = bar.size_bar.get_window_extent(drawn.canvas.get_renderer()).width
    ends = drawn.axes[0].transData.transform([(0.0, 0.0), (0.5, 0.0)])
    assert width == pytest.approx(ends[1, 0] - ends[0, 0], rel=0.02)


def test_what_rounding_leaves_of_a_flow_is_not_shown(planar_run: Run) -> None:
    field = planar_run.field()
    # The body has had a speed of 0.5
    faint = replace(field, velocity=1e-11 * field.velocity)
    assert not fields.settled(planar_run, faint).velocity.any()
    slow = replace(field, velocity=1e-6 * field.velocity)
    assert fields.settled(planar_run, slow) is slow


def test_a_view_stands_back_from_the_end_of_the_domain(planar_run: Run) -> None:
    whole = (0.0, 10.0, 0.0, 4.0)
    view = (-2.0, 2.0, -1.0, 1.0)
    for moved, back in (
        ([5.0, 2.0], [0.0, 0.0]),
        ([9.0, 0.5], [-1.0, 0.5]),
        ([-3.0, 4.0], [5.0, -1.0]),
    ):
        found = snapshot.kept_inside(planar_run, view, np.array(moved), whole)
        np.testing.assert_allclose(found, back)
    # One that is larger than the domain goes with the body
    found = snapshot.kept_inside(planar_run, (-9.0, 9.0, -1.0, 1.0), np.array([9.0, 2.0]), whole)
    np.testing.assert_allclose(found, 0.0)


def test_a_followed_body_at_the_end_of_the_domain_leaves_no_part_of_a_picture_white(
    planar_run: Run,
) -> None:
    # At t = 4 the disc is at x = 2, where the domain ends
    drawn = figure.picture(planar_run, follow="disc", painter="matplotlib", lines="none")
    x0, x1 = drawn.axes[0].get_xlim()
    assert x1 == pytest.approx(2.0)
    assert x1 - x0 == pytest.approx(4.0)


def test_what_a_title_equates_stays_in_one_line() -> None:
    text = style.fitted("A title that is as long as some of them are, t = 4 s, z = 0.02", 4.2)
    assert "t = 4 s" in text and "z = 0.02" in text
    assert len(text.splitlines()) == 2
