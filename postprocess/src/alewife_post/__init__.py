"""Runs of alewife as arrays, tables, figures and pictures."""

from alewife_post.read import BodyHistory, Field, Frame, Run, open_run
from alewife_post.tables import (
    comparison_table,
    grid,
    reference_table,
    series_table,
    sweep_table,
)

__all__ = [
    "BodyHistory",
    "Field",
    "Frame",
    "Run",
    "comparison_table",
    "grid",
    "open_run",
    "reference_table",
    "series_table",
    "sweep_table",
]
