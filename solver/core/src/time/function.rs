//! Named functions of time at a time.

use std::f64::consts::{PI, TAU};

use crate::case::TimeFunction;

/// Value of a factor in time, 1 where there is none.
#[must_use]
pub fn factor_at(function: Option<&TimeFunction>, time: f64) -> f64 {
    match function {
        None => 1.0,
        Some(TimeFunction::Ramp { duration }) => (time / duration).clamp(0.0, 1.0),
        Some(TimeFunction::SmoothRamp { duration }) => {
            (1.0 - (PI * (time / duration).clamp(0.0, 1.0)).cos()) / 2.0
        }
        Some(TimeFunction::Sine { mean, amplitude, period, phase }) => {
            mean + amplitude * (TAU * (time / period + phase)).sin()
        }
        Some(TimeFunction::Table(knots)) => table_at(knots, time),
    }
}

fn table_at(knots: &[[f64; 2]], time: f64) -> f64 {
    let after = knots.partition_point(|knot| knot[0] <= time);
    match (after.checked_sub(1).map(|before| knots[before]), knots.get(after)) {
        (Some([t0, v0]), Some(&[t1, v1])) => v0 + (v1 - v0) * (time - t0) / (t1 - t0),
        (Some([_, value]), None) | (None, Some(&[_, value])) => value,
        (None, None) => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_function_has_its_values() {
        let at = |function: &TimeFunction, t| factor_at(Some(function), t);
        assert_eq!(at(&TimeFunction::Ramp { duration: 2.0 }, 0.5), 0.25);
        assert_eq!(at(&TimeFunction::Ramp { duration: 2.0 }, 5.0), 1.0);
        assert!((at(&TimeFunction::SmoothRamp { duration: 2.0 }, 1.0) - 0.5).abs() < 1e-15);
        let sine = |phase| TimeFunction::Sine { mean: 1.0, amplitude: 2.0, period: 4.0, phase };
        assert!((at(&sine(0.0), 1.0) - 3.0).abs() < 1e-15);
        assert!((at(&sine(0.25), 0.0) - 3.0).abs() < 1e-15);
        let table = TimeFunction::Table(vec![[0.0, 1.0], [1.0, 3.0]]);
        assert_eq!(at(&table, -1.0), 1.0);
        assert_eq!(at(&table, 0.5), 2.0);
        assert_eq!(at(&table, 2.0), 3.0);
    }
    #[test]
    fn integrals_are_those_of_the_values() {
        let table = vec![[0.5, 1.0], [1.0, 3.0], [2.5, -1.0]];
        for function in [
            TimeFunction::Ramp { duration: 2.0 },
            TimeFunction::SmoothRamp { duration: 1.5 },
            TimeFunction::Sine { mean: 0.3, amplitude: 2.0, period: 1.7, phase: 0.1 },
            TimeFunction::Table(table.clone()),
            // Begins before the run
            TimeFunction::Table(table.iter().map(|[time, value]| [time - 0.75, *value]).collect()),
        ] {
            for end in [0.2, 0.7, 1.9, 4.0] {
                let n = 20_000_u32;
                let at = |nth: u32| {
                    factor_at(Some(&function), end * (f64::from(nth) + 0.5) / f64::from(n))
                };
                let sum = (0..n).map(at).sum::<f64>() * end / f64::from(n);
                let error = (function.integral(end) - sum).abs();
                // The midpoint rule with a kink: second order
                assert!(error < 1e-6, "{function:?} until {end}: {error:.1e}");
            }
        }
    }
}
