"""Films of runs, in the plane and in space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from alewife_post import movie, planar, soft, stage, style
from alewife_post.page import SIZE
from alewife_post.read import Run, check_run
from alewife_post.request import (
    MOST_FRAMES,
    QUANTITIES,
    Moment,
    Request,
    checked_request,
    chosen_moments,
    chosen_quantity,
    no_film,
    who_is_followed,
)

__all__ = ["MOST_FRAMES", "QUANTITIES", "Moment", "Request", "film"]


def film(run: Run, out: Path, request: Request, report: Callable[[str], None] = print) -> int:
    """Write a film of a run, finished or under way; returns the number of frames."""
    check_run(run)
    if soft.is_soft(run):
        return soft.film(run, out, request, report)
    out = Path(out)
    movie.check(out)
    request = checked_request(request)
    width, height = request.size or SIZE
    if width % 2 or height % 2 or min(width, height) < 120:
        raise ValueError(f"{width} x {height}: sides of a film are even, and at least 120 pixels")
    if request.fps is not None and not 0.1 <= request.fps <= 100:
        raise ValueError(f"{request.fps:g} frames a second: between 0.1 and 100 can be played")
    if request.frames < 1:
        raise ValueError("a film has one frame at least")
    quantity = chosen_quantity(run, request, report)
    is_asked = request.follow is not None
    request = replace(
        request, quantity=quantity, follow=who_is_followed(run, request), is_asked=is_asked
    )
    moments = chosen_moments(run, request)
    if len(moments) == 1 and request.frames > 1:
        raise ValueError(no_film(run, out, request, moments[0].time))
    fps = request.fps or min(25.0, max(4.0, len(moments) / 5.0))
    style.use()
    images = (stage if run.is_spatial else planar).images(run, moments, request)
    n = movie.write(out, images, fps)
    report(
        f"{out}: {n} {'frame' if n == 1 else 'frames'} of {request.iso or quantity}, "
        f"t = {moments[0].time:.4g} to {moments[-1].time:.4g}, {fps:g} a second"
    )
    return n
