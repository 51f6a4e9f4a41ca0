"""The command `calibration` of `alewife-post`."""

from __future__ import annotations

import argparse
from pathlib import Path

from alewife_post.cli_series import save


def add_calibration(parser: argparse.ArgumentParser) -> None:
    """Options of `calibration`."""
    parser.add_argument("directory", type=Path, help="what `alewife calibrate --out` wrote")
    parser.add_argument(
        "--out", type=Path, metavar="FILE", help="picture; NAME-calibration.png if absent"
    )


def write_calibration(options: argparse.Namespace) -> None:
    """Tracks of a calibrated reduced model over those of its records, and its errors."""
    from alewife_post import calibration

    found = calibration.open_calibration(options.directory)
    drawn = calibration.calibration_figure(found)
    save(drawn, options.out or Path(f"{found.path.resolve().name}-calibration.png"))
