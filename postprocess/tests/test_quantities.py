"""Numbers from series of which they are known."""

import numpy as np
import pytest

from alewife_post import quantities

TIME = np.cumsum(np.full(2000, 0.01)) ** 1.01
WAVE = 2.0 + 3.0 * np.sin(4.0 * TIME)
PERIOD = 2 * np.pi / 4.0


def test_the_mean_over_whole_periods_is_that_of_the_wave() -> None:
    time, values = quantities.within(TIME, WAVE, 2 * PERIOD, 8 * PERIOD)
    assert abs(quantities.mean(time, values) - 2.0) < 0.02
    assert abs(quantities.rms(time, values - 2.0) - 3.0 / np.sqrt(2)) < 0.02


def test_the_mean_of_one_value_is_that_value() -> None:
    assert quantities.mean(np.array([1.0]), np.array([5.0])) == 5.0


def test_the_top_of_a_parabola_is_found_between_steps() -> None:
    time = np.array([0.0, 1.0, 1.7, 3.0])
    at, value = quantities.maximum(time, 4.0 - (time - 1.2) ** 2)
    assert (at, value) == pytest.approx((1.2, 4.0))
    at, value = quantities.minimum(time, (time - 1.2) ** 2 - 4.0)
    assert (at, value) == pytest.approx((1.2, -4.0))


def test_the_largest_value_at_an_end_is_taken_as_it_is() -> None:
    assert quantities.maximum(np.array([0.0, 1.0]), np.array([0.0, 3.0])) == (1.0, 3.0)


def test_the_period_is_that_of_the_wave() -> None:
    assert abs(quantities.period(TIME, WAVE) / PERIOD - 1) < 1e-3
    assert np.isnan(quantities.period(TIME[:100], WAVE[:100]))


def test_a_phase_average_is_one_period_of_the_wave() -> None:
    phases, mean, deviation = quantities.phase_average(TIME, WAVE, PERIOD, 32, PERIOD)
    np.testing.assert_allclose(mean, 2.0 + 3.0 * np.sin(2 * np.pi * phases), atol=1e-3)
    assert deviation.max() < 1e-3
    with pytest.raises(ValueError, match="no whole period"):
        quantities.phase_average(TIME, WAVE, 100.0)


def test_speed_is_the_length_of_the_velocity() -> None:
    np.testing.assert_allclose(quantities.speed(np.array([[3.0, 4.0], [0.0, 0.0]])), [5.0, 0.0])
