"""The eel of eel.toml, one servo of which is off, holds its heading, or swims without looking where to."""

import sys
from collections import deque

import alewife
import numpy as np

#: Amplitudes and phases of the wave, from head to tail, and which way a joint steers.
AMPLITUDES = np.array([0.2, 0.3, 0.35, 0.4, 0.45])
PHASES = np.array([0.0, 0.83, 0.17, 0.0, 0.83])
STEERS = np.array([1.0, 1.0, -1.0, -1.0, -1.0])
#: What the controller does not know: the zero of the fourth servo is off by three degrees (rad).
OFF = np.radians([0.0, 0.0, 0.0, 3.0, 0.0])
PAUSE = 0.02
FILTER = 0.08
#: Of the heading, and of its rate over a cycle (periods).
GAINS = [0.5, 0.5]


def wave(time):
    """Angles of the gait (rad), grown from rest over the first period."""
    s = min(time, 1.0)
    ramp = s**3 * (10 - s * (15 - 6 * s))
    return ramp * AMPLITUDES * np.sin(2 * np.pi * (time + PHASES))


def ahead(time):
    """What the filter makes the wave of: the wave with its rate and acceleration."""
    before, now, after = (wave(time + off) for off in (-1e-3, 0.0, 1e-3))
    rate, acceleration = (after - before) / 2e-3, (after - 2 * now + before) / 1e-6
    return now + 2 * FILTER * rate + FILTER**2 * acceleration


def swim(steers, out=None, end=10.0, settings=None):
    """Mean angle of the root over each cycle (degrees)."""
    case = alewife.load("eel.toml").set({"time.unsteady.end": end, **(settings or {})})
    turned, last = [], deque(maxlen=round(1 / PAUSE))
    bias = 0.0
    with alewife.session(case, out, overwrite=True) as session:
        while not session.is_over:
            # What is asked for is held for a pause: ask for what is due in its middle
            targets = ahead(session.time + 0.5 * PAUSE) + bias * STEERS + OFF
            session.command({f"eel.joint.{n + 1}": target for n, target in enumerate(targets)})
            session.advance(PAUSE)
            last.append(session.observe("eel.angle"))
            if len(last) == last.maxlen and steers:
                heading, rate = np.mean(last), last[-1] - last[0]
                bias = np.clip(-GAINS[0] * heading - GAINS[1] * rate, -0.15, 0.15)
            if round(session.time / PAUSE) % last.maxlen == 0:
                turned.append(np.degrees(np.mean(last)))
                print(f"{session.time:5.2f} {turned[-1]:7.2f} {session.observe('eel.x'):7.3f}", flush=True)
    return turned


if __name__ == "__main__":
    swim(sys.argv[1:] == ["steered"])
