"""Commands `plot`, `compare` and `inspect` of `alewife-post`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from alewife_post import cli_look
from alewife_post.read import open_run
from alewife_post.whole import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from alewife_post.compare import Named, Sweep
    from alewife_post.curves import Curve

FILMS = (".mp4", ".gif")


# ---- Plot ----------------------------------------------------------------------------------------


def add_plot(parser: argparse.ArgumentParser) -> None:
    """Options of `plot`."""
    parser.add_argument("run", type=Path, help="run directory, of a finished run or one under way")
    parser.add_argument(
        "names",
        nargs="*",
        metavar="QUANTITY",
        help="a column, an ending such as velocity.y, a pattern, or 'a minus b', one panel each; "
        "of --trajectories bodies and swimmers; what the case has references for if absent",
    )
    parser.add_argument("--quantity", action="append", default=[], help="the same as an option")
    only_one = parser.add_mutually_exclusive_group()
    only_one.add_argument("--trajectories", action="store_true", help="paths of the centres")
    only_one.add_argument(
        "--energy", action="store_true", help="power, dissipation, efficiency, cost of transport"
    )
    _add_common(parser, "NAME-series.png, NAME-trajectories.png or NAME-energy.png if absent")


def write_plot(options: argparse.Namespace) -> None:
    """Quantities of a run over time with the references of its case, its paths or its energy."""
    run = open_run(options.run)
    from alewife_post import series, trajectories

    names = [*options.names, *options.quantity]
    window = options.window and tuple(options.window)
    if options.trajectories:
        kind, drawn = "trajectories", trajectories.trajectory_figure(run, names, window=window)
    elif options.energy:
        if names:
            raise ValueError("--energy has quantities of its own: name none")
        kind = "energy"
        drawn = series.energy_figure(run, window=window, is_whole=options.whole)
    else:
        kind = "series"
        drawn = series.series_figure(run, names, window=window, is_whole=options.whole)
    save(
        cli_look.finish(drawn, options),
        options.out or Path(f"{run.path.resolve().name}-{kind}.png"),
    )


# ---- Compare -------------------------------------------------------------------------------------


def add_compare(parser: argparse.ArgumentParser) -> None:
    """Options of `compare`."""
    parser.add_argument(
        "paths",
        nargs="+",
        type=Path,
        metavar="PATH",
        help="run directories, published curves (CSV), directories of cases that have such curves; "
        "or one directory of a sweep",
    )
    parser.add_argument("--quantity", action="append", default=[], help="may be given again")
    parser.add_argument("--against", metavar="KEY", help="of a sweep: the swept key on the axis")
    parser.add_argument(
        "--statistic",
        choices=("final", "mean", "max", "min", "rms"),
        help="of a sweep: what is drawn of each point (final)",
    )
    parser.add_argument(
        "--curves", action="store_true", help="of a sweep: a curve over time for each point"
    )
    parser.add_argument("--json", action="store_true", help="print the table as JSON")
    _add_common(parser, "comparison.png if absent")


def write_comparison(options: argparse.Namespace) -> None:
    """Runs, the points of a sweep and published curves on the same axes, and how far apart."""
    from alewife_post import compare, sweeps

    runs, found, curves = compare.open_all(options.paths)
    if len(found) > 1 or (found and (runs or (curves and not options.curves))):
        raise ValueError("one sweep is compared by itself; name points of it to see them with runs")
    if found and not options.curves:
        drawn, rows = _of_sweep(found[0], options)
    else:
        if options.against or options.statistic:
            raise ValueError("--against and --statistic are for a sweep, without --curves")
        drawn, rows = _of_curves(sweeps.as_runs(found[0]) if found else runs, curves, options)
    text = json.dumps(plain(rows), indent=2) if options.json else as_text(rows)
    print(text)
    out = options.out or Path("comparison.png")
    save(cli_look.finish(drawn, options), out, is_quiet=options.json)


def _of_sweep(sweep: Sweep, options: argparse.Namespace) -> tuple[Figure, list[dict[str, Any]]]:
    from alewife_post import sweeps

    if options.window:
        raise ValueError("of a sweep the window is that of the statistics of its case")
    names = sweeps.chosen_names(sweep, options.quantity)
    statistic = options.statistic or "final"
    drawn = sweeps.sweep_figure(sweep, names, against=options.against, statistic=statistic)
    return drawn, sweeps.table(sweep, names, statistic)


def _of_curves(
    runs: list[Named], curves: list[Curve], options: argparse.Namespace
) -> tuple[Figure, list[dict[str, Any]]]:
    from alewife_post import compare

    if not runs:
        raise ValueError("there are published curves and no run: name one to compare them with")
    if len(runs) + len(curves) < 2:
        raise ValueError("one run alone: name another one, a curve or a case (or use plot)")
    window = options.window and tuple(options.window)
    names = compare.chosen_names(runs, curves, options.quantity)
    drawn = compare.compare_figure(runs, curves, names, window=window, is_whole=options.whole)
    return drawn, compare.differences(runs, curves, names, window)


# ---- Inspect -------------------------------------------------------------------------------------


def add_inspect(parser: argparse.ArgumentParser) -> None:
    """Options of `inspect`."""
    parser.add_argument("run", type=Path, help="run directory, of a finished run or one under way")
    parser.add_argument("--json", action="store_true", help="print JSON")


def write_summary(options: argparse.Namespace) -> None:
    """What a run is, how far it came, what it found and what it holds."""
    from alewife_post import summary

    found = summary.summary(open_run(options.run))
    print(json.dumps(plain(found), indent=2) if options.json else summary.as_text(found))


# ---- In common -----------------------------------------------------------------------------------


def _add_common(parser: argparse.ArgumentParser, usual: str) -> None:
    parser.add_argument("--out", type=Path, help=f"file; its ending says the format; {usual}")
    parser.add_argument(
        "--window", type=float, nargs=2, metavar=("START", "END"), help="part of the time"
    )
    parser.add_argument(
        "--whole", action="store_true", help="with outliers of a transient at the start, too"
    )
    cli_look.add_letters(parser)


def save(drawn: Figure, out: Path, *, is_quiet: bool = False) -> None:
    """Write a figure, whole or not at all, and say so."""
    from alewife_post import style

    if out.suffix.lower() in FILMS:
        raise ValueError(f"{out} is a film by its name: that is `alewife-post film`")
    cli_look.check_ending(out)
    if not out.parent.is_dir():
        raise FileNotFoundError(f"there is no directory {out.parent} to write {out.name} into")
    with replacing(out) as unfinished:
        drawn.savefig(unfinished, dpi=style.DPI, bbox_inches="tight", pad_inches=0.08)
    if not is_quiet:
        print(f"wrote {out}")


def plain(value: object) -> object:
    """What JSON can hold: no value for one that is not finite."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    if isinstance(value, float) and not -float("inf") < value < float("inf"):
        return None
    return value


def as_text(rows: Iterable[dict[str, Any]]) -> str:
    """Rows as columns of text; a blank where a row has no value."""
    rows = list(rows)
    names = list(dict.fromkeys(name for row in rows for name in row))
    cells = [[_cell(row.get(name)) for name in names] for row in rows]
    widths = [max(len(row[nth]) for row in [names, *cells]) for nth in range(len(names))]
    is_text = [any(isinstance(row.get(name), str) for row in rows) for name in names]
    lines = []
    for row in [names, *cells]:
        padded = [
            text.ljust(width) if left else text.rjust(width)
            for text, width, left in zip(row, widths, is_text, strict=True)
        ]
        lines.append("  ".join(padded).rstrip())
    return "\n".join(lines)


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.5g}" if isinstance(value, float) else str(value)
