"""Runs of alewife as arrays, figures and pictures."""

from alewife_post.read import BodyHistory, Field, Frame, Run, open_run

__all__ = ["BodyHistory", "Field", "Frame", "Run", "open_run"]
