"""Means, extrema, periods, phase averages: arrays in, arrays out.

A series is two arrays `(n,)`: increasing times, and values. Steps need not be equal.
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray


def within(time: Array, values: Array, start: float, end: float) -> tuple[Array, Array]:
    """The part of a series from `start` to `end`, both included."""
    inside = (time >= start) & (time <= end)
    return time[inside], values[inside]


def mean(time: Array, values: Array) -> float:
    """Time average by the trapezoidal rule; the value itself if there is only one."""
    if len(time) < 2:
        return float(values[0])
    return float(np.trapezoid(values, time) / (time[-1] - time[0]))


def rms(time: Array, values: Array) -> float:
    """Root mean square about zero."""
    return float(np.sqrt(mean(time, values**2)))


def maximum(time: Array, values: Array) -> tuple[float, float]:
    """Time and value of the largest value, at the top of the parabola through its neighbours."""
    top = int(np.argmax(values))
    if top in (0, len(values) - 1):
        return float(time[top]), float(values[top])
    # Newton's form through the three points; its slope is zero at the top.
    t, v = time[top - 1 : top + 2], values[top - 1 : top + 2]
    slope = (v[1] - v[0]) / (t[1] - t[0])
    curvature = ((v[2] - v[1]) / (t[2] - t[1]) - slope) / (t[2] - t[0])
    if curvature >= 0.0:
        return float(t[1]), float(v[1])
    at = 0.5 * (t[0] + t[1]) - slope / (2 * curvature)
    return float(at), float(v[0] + (at - t[0]) * (slope + curvature * (at - t[1])))


def minimum(time: Array, values: Array) -> tuple[float, float]:
    """Time and value of the smallest value, likewise."""
    at, value = maximum(time, -values)
    return at, -value


def upward_crossings(time: Array, values: Array, level: float | None = None) -> Array:
    """Times at which a series rises through `level`, or through its mean, `(n_crossings,)`."""
    above = values - (mean(time, values) if level is None else level)
    before = np.flatnonzero((above[:-1] < 0.0) & (above[1:] >= 0.0))
    share = above[before] / (above[before] - above[before + 1])
    return time[before] + share * (time[before + 1] - time[before])


def period(time: Array, values: Array) -> float:
    """Mean time between upward crossings of the mean; `nan` if there are fewer than two."""
    crossings = upward_crossings(time, values)
    if len(crossings) < 2:
        return float("nan")
    return float((crossings[-1] - crossings[0]) / (len(crossings) - 1))


def phase_average(
    time: Array, values: Array, period: float, n_phases: int = 64, start: float = 0.0
) -> tuple[Array, Array, Array]:
    """Mean and spread over all whole periods after `start`, at equal phases.

    Returns `(phases, mean, deviation)`, each `(n_phases,)`; phases are in [0, 1).
    """
    n_periods = int(np.floor((time[-1] - start) / period + 1e-9))
    if n_periods < 1:
        raise ValueError(f"no whole period of {period} between {start} and {time[-1]}")
    phases = np.arange(n_phases) / n_phases
    at = start + period * (np.arange(n_periods)[:, None] + phases)
    table = np.interp(at, time, values)
    return phases, table.mean(axis=0), table.std(axis=0)


def percentile(values: Array, share: Array, wanted: float) -> float:
    """The value `wanted` per cent of the area lies below; each value holds a share of it."""
    order = np.argsort(values)
    # A value stands in the middle of its share.
    below = np.cumsum(share[order]) - 0.5 * share[order]
    return float(np.interp(wanted / 100.0 * share.sum(), below, values[order]))


def speed(velocity: Array) -> Array:
    """Magnitude of velocities, `(..., d)` to `(...)`."""
    return np.linalg.norm(velocity, axis=-1)
