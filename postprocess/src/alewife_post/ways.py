"""The ways of swimmers and bodies, and how fast they have been."""

from __future__ import annotations

import numpy as np

from alewife_post import bodies
from alewife_post.read import Run

Array = np.ndarray


def trails(run: Run) -> list[tuple[Array, Array]]:
    """Times `(n,)` and places `(n, 3)` of swimmers, and of bodies alone, that went somewhere.

    A swimmer of several bodies has the way of its middle: those of its parts go to and fro.
    """
    found = []
    for members in bodies.groups(run).values():
        own = [run.bodies[name] for name in members if name in run.bodies]
        if not own or len({len(history.time) for history in own}) > 1:
            continue
        middle = np.mean([history.center for history in own], axis=0)
        if np.ptp(middle, axis=0).max() > 0.05 * max(bodies.radius(run, name) for name in members):
            found.append((own[0].time, middle))
    return found


def fastest(run: Run) -> float:
    """The largest speed a body has had."""
    speeds = [np.linalg.norm(one.velocity, axis=1).max() for one in run.bodies.values()]
    return float(np.nanmax(speeds)) if speeds else 0.0
