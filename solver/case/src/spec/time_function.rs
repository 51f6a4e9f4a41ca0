//! `TimeFunction`: a factor in time, its value at a time, and its integrals: how far a motion with a factor leads.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use crate::spec::body::command::Command;
use crate::spec::body::stroke::{Cycle, cubic_at};
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};
use crate::{Stroke, smooth_ramp};

/// A named function of time (1), used as a factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TimeFunction {
    /// From 0 to 1 over the duration, linearly, then 1.
    Ramp {
        /// Time until the full value (s).
        #[cfg_attr(test, schemars(with = "Positive"))]
        duration: f64,
    },
    /// From 0 to 1 as (1 - cos(pi t / duration)) / 2, then 1.
    SmoothRamp {
        /// Time until the full value (s).
        #[cfg_attr(test, schemars(with = "Positive"))]
        duration: f64,
    },
    /// mean + amplitude sin(2 pi (t / period + phase)).
    Sine {
        /// Mean value (1).
        #[serde(default)]
        mean: f64,
        /// Amplitude (1).
        #[serde(default = "one")]
        amplitude: f64,
        /// Period (s).
        #[cfg_attr(test, schemars(with = "Positive"))]
        period: f64,
        /// Phase (periods).
        #[serde(default)]
        phase: f64,
        /// Time over which the amplitude grows from 0, twice continuously differentiable (s); 0 for
        /// the full amplitude from the start.
        #[serde(default, skip_serializing_if = "is_zero")]
        #[cfg_attr(test, schemars(with = "NonNegative"))]
        ramp: f64,
    },
    /// Straight lines between (time, value) knots, constant outside them.
    Table(Vec<[f64; 2]>),
    /// Cubic polynomials between (time, value, rate) knots, which cover the run; what the columns of
    /// a file become.
    Cubic(Vec<[f64; 3]>),
    /// Cubic polynomials between (time, value, rate) knots over one period, over and over; what the columns
    /// of a file with a `period` become.
    Cycle(Cycle),
    /// What a session or a recording asks for while the run goes on.
    Command(Command),
}

fn one() -> f64 {
    1.0
}

/// Whether a number that is zero where it is absent need not be written.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
pub(super) fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

impl TimeFunction {
    /// Its value at a time (s). Inlined, as this package is compiled to read files, not to compute.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        match self {
            Self::Ramp { duration } => (time / duration).clamp(0.0, 1.0),
            Self::SmoothRamp { duration } => {
                (1.0 - (PI * (time / duration).clamp(0.0, 1.0)).cos()) / 2.0
            }
            Self::Sine { mean, amplitude, period, phase, ramp } => {
                let wave = (TAU * (time / period + phase)).sin();
                if *ramp > 0.0 {
                    mean + amplitude * smooth_ramp(time, *ramp)[0] * wave
                } else {
                    mean + amplitude * wave
                }
            }
            Self::Table(knots) => table_at(knots, time),
            Self::Cubic(knots) => cubic_at(knots, time)[0],
            Self::Cycle(cycle) => cycle.at(time)[0],
            Self::Command(command) => command.at(time)[0],
        }
    }

    /// Its integral from time 0 to a time that is not before (s).
    #[must_use]
    pub fn integral(&self, time: f64) -> f64 {
        match self {
            Self::Ramp { duration } if time < *duration => 0.5 * time * time / duration,
            Self::SmoothRamp { duration } if time < *duration => {
                0.5 * (time - duration / PI * (PI * time / duration).sin())
            }
            Self::Ramp { duration } | Self::SmoothRamp { duration } => time - 0.5 * duration,
            Self::Sine { mean, amplitude, period, phase, ramp } => {
                let cosine = |time: f64| (TAU * (time / period + phase)).cos();
                let from = ramp.min(time).max(0.0);
                let full = mean * time + amplitude * period / TAU * (cosine(from) - cosine(time));
                if from == 0.0 {
                    return full;
                }
                let wave =
                    |time: f64| smooth_ramp(time, *ramp)[0] * (TAU * (time / period + phase)).sin();
                let n = (PANELS * (1.0 + from / period)).ceil();
                full + amplitude * simpson(wave, [0.0, from], n)
            }
            Self::Cubic(knots) => {
                let within = |t: f64| t.clamp(0.0, time);
                let (first, last) = (knots.first().map(|k| k[0]), knots.last().map(|k| k[0]));
                let ends = [Some(0.0), first.map(within), last.map(within), Some(time)];
                let mut times: Vec<f64> = knots.iter().map(|knot| within(knot[0])).collect();
                times.extend(ends.into_iter().flatten());
                times.sort_by(f64::total_cmp);
                let pieces = times.windows(2).filter(|pair| pair[1] > pair[0]);
                // Exact of cubic polynomials
                pieces.map(|p| simpson(|t| cubic_at(knots, t)[0], [p[0], p[1]], 1.0)).sum()
            }
            Self::Table(knots) => {
                let (Some([first, low]), Some([last, high])) = (knots.first(), knots.last()) else {
                    return time;
                };
                let pieces = knots.windows(2).map(|pair| under([pair[0], pair[1]], time));
                let before = low * time.min(*first).max(0.0);
                before + pieces.sum::<f64>() + high * (time - last.max(0.0)).max(0.0)
            }
            Self::Cycle(cycle) => cycle.integral(time),
            // What will be asked for is not known: as if nothing were
            Self::Command(command) => command.start * time,
        }
    }

    /// What its integrals from time 0 to times up to an end (s) do not exceed in size.
    #[must_use]
    pub fn largest_integral(&self, end: f64) -> f64 {
        match self {
            Self::Ramp { .. } | Self::SmoothRamp { .. } => end,
            Self::Sine { mean, amplitude, period, ramp, .. } => {
                mean.abs() * end + amplitude.abs() * (period / PI + ramp)
            }
            Self::Cubic(knots) => {
                let [least, most] = Stroke::Cubic(knots.clone()).range();
                end * least.abs().max(most.abs())
            }
            Self::Cycle(cycle) => {
                let [least, most] = cycle.range();
                end * least.abs().max(most.abs())
            }
            Self::Table(knots) => {
                let values = knots.iter().map(|[_, value]| value.abs());
                end * values.max_by(f64::total_cmp).unwrap_or(1.0)
            }
            Self::Command(command) => {
                let [least, most] = command.range();
                end * least.abs().max(most.abs())
            }
        }
    }
}

/// Intervals in a period in which a function is integrated.
const PANELS: f64 = 32.0;

/// The integral of a function between two times by Simpson's rule in `n` intervals.
fn simpson(function: impl Fn(f64) -> f64, [from, to]: [f64; 2], n: f64) -> f64 {
    let width = (to - from) / n;
    let mut sum = 0.0;
    let mut nth = 0.0;
    while nth < n {
        let start = from + nth * width;
        let middle = function(start + 0.5 * width);
        sum += width / 6.0 * (function(start) + 4.0 * middle + function(start + width));
        nth += 1.0;
    }
    sum
}

/// The integral of a straight line between two knots from time 0 to a time (s), as far as it goes.
fn under([[start, low], [end, high]]: [[f64; 2]; 2], time: f64) -> f64 {
    let (from, to) = (start.max(0.0), end.min(time));
    if from >= to {
        return 0.0;
    }
    let at = |time: f64| low + (high - low) * (time - start) / (end - start);
    0.5 * (at(from) + at(to)) * (to - from)
}

#[inline]
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
        let at = |function: &TimeFunction, t| function.at(t);
        assert_eq!(at(&TimeFunction::Ramp { duration: 2.0 }, 0.5), 0.25);
        assert_eq!(at(&TimeFunction::Ramp { duration: 2.0 }, 5.0), 1.0);
        assert!((at(&TimeFunction::SmoothRamp { duration: 2.0 }, 1.0) - 0.5).abs() < 1e-15);
        let sine =
            |phase| TimeFunction::Sine { mean: 1.0, amplitude: 2.0, period: 4.0, phase, ramp: 0.0 };
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
            TimeFunction::Sine { mean: 0.3, amplitude: 2.0, period: 1.7, phase: 0.1, ramp: 0.0 },
            TimeFunction::Sine { mean: 0.3, amplitude: 2.0, period: 0.7, phase: 0.1, ramp: 1.6 },
            TimeFunction::Cubic(vec![[-0.5, 1.0, 0.5], [1.0, 2.0, -3.0], [4.5, 0.0, 1.0]]),
            TimeFunction::Table(table.clone()),
            // Begins before the run
            TimeFunction::Table(table.iter().map(|[time, value]| [time - 0.75, *value]).collect()),
        ] {
            for end in [0.2, 0.7, 1.9, 4.0] {
                let n = 20_000_u32;
                let at = |nth: u32| function.at(end * (f64::from(nth) + 0.5) / f64::from(n));
                let sum = (0..n).map(at).sum::<f64>() * end / f64::from(n);
                let error = (function.integral(end) - sum).abs();
                // The midpoint rule with a kink: second order
                assert!(error < 1e-6, "{function:?} until {end}: {error:.1e}");
                let least = 0.999 * function.integral(end).abs();
                assert!(function.largest_integral(4.0) >= least, "{function:?} until {end}");
            }
        }
    }
}
