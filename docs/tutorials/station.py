"""The follower of station.toml keeps half a length behind the leader by its beat and its bend."""

import sys
from collections import deque

import alewife
import numpy as np

PAUSE = 0.05
#: From nose to nose: a length, and half of one from tail to head.
STATION = 1.5


def swim(steered, out=None, settings=None):
    """Distance, offset and powers, a row a pause."""
    case = alewife.load("station.toml").set(settings or {"title": "station"})
    rows, seen = [], deque(maxlen=round(1 / PAUSE))
    gathered = 0.0
    names = ["leader.x", "leader.y", "follower.x", "follower.y", "follower.angle"]
    with alewife.session(case, out, overwrite=True) as session:
        while not session.is_over:
            session.advance(PAUSE)
            now = session.observe(names)
            seen.append(list(now.values()))
            lead_x, lead_y, x, y, angle = np.mean(seen, axis=0)
            far, aside = lead_x - x - STATION, y - lead_y
            before, after = np.array(seen[0]), np.array(seen[-1])
            span = max(PAUSE * (len(seen) - 1), PAUSE)
            (rate_x, rate_y, rate) = (
                ((after - before)[0] - (after - before)[2]) / span,
                ((after - before)[3] - (after - before)[1]) / span,
                (after - before)[4] / span,
            )
            if steered and session.time >= 1.0:
                gathered = np.clip(gathered + PAUSE * far, -0.3, 0.3)
                session.command(
                    {
                        "follower.beat": 1.0 + 3.0 * far + 1.5 * rate_x + 1.0 * gathered,
                        "follower.bend": 0.6 * (angle + 0.5 * rate + 1.0 * aside + 0.5 * rate_y),
                    }
                )
            rows.append([session.time, after[0] - after[2], aside, angle])
            if round(session.time / PAUSE) % seen.maxlen == 0:
                cost = session.observe(
                    ["leader.cycle.cost_of_transport", "follower.cycle.cost_of_transport"]
                )
                print(
                    f"{session.time:5.2f} distance {after[0] - after[2] - 1.0:6.3f} aside {aside:6.3f} "
                    f"angle {np.degrees(angle):6.2f} costs {cost}",
                    flush=True,
                )
    return rows


if __name__ == "__main__":
    swim(sys.argv[1:] == ["steered"])
