//! `Stroke`: a length, an angle or a torque that is given in time, with its exact rate.

mod cycle;

use std::f64::consts::{PI, TAU};
use std::iter::successors;

pub use self::cycle::Cycle;

use crate::spec::body::command::Command;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};
use serde::{Deserialize, Serialize};

/// A number given in time: how long an arm is, how far a joint is bent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Stroke {
    /// The same at all times.
    Constant(f64),
    /// start + rate t, such as the angle of a motor that turns steadily.
    Steady {
        /// Value at time 0.
        #[serde(default)]
        start: f64,
        /// Value per time (1/s).
        rate: f64,
    },
    /// mean + amplitude sin(2 pi (t / period + phase)).
    Sine {
        /// Mean value.
        #[serde(default)]
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Period (s).
        #[cfg_attr(test, schemars(with = "Positive"))]
        period: f64,
        /// Phase (periods).
        #[serde(default)]
        phase: f64,
        /// Time over which the amplitude grows from 0, twice continuously differentiable (s); 0 for
        /// the full amplitude from the start.
        #[serde(default)]
        #[cfg_attr(test, schemars(with = "NonNegative"))]
        ramp: f64,
    },
    /// From knot to knot, over and over.
    Legs {
        /// (time, value) knots over one period, the first at time 0; the value at its end is the
        /// first one again.
        knots: Vec<[f64; 2]>,
        /// Period (s).
        #[cfg_attr(test, schemars(with = "Positive"))]
        period: f64,
        /// Whether the value rests at each knot: half a cosine from one to the next in place of a
        /// straight line.
        #[serde(default)]
        smooth: bool,
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

impl Stroke {
    /// Value and rate at a time (s); where the rate jumps, that after the jump.
    #[must_use]
    pub fn at(&self, time: f64) -> [f64; 2] {
        match self {
            Self::Constant(value) => [*value, 0.0],
            Self::Steady { start, rate } => [start + rate * time, *rate],
            Self::Sine { mean, amplitude, period, phase, ramp } => {
                let rate = TAU / period;
                let (sin, cos) = (TAU * (time / period + phase)).sin_cos();
                let [part, growth] = smooth_ramp(time, *ramp);
                [mean + amplitude * part * sin, amplitude * (part * rate * cos + growth * sin)]
            }
            Self::Legs { knots, period, smooth } => {
                let within = time.rem_euclid(*period);
                let after = knots.partition_point(|knot| knot[0] <= within);
                let first = knots.first().copied().unwrap_or_default();
                let [t0, from] = after.checked_sub(1).map_or(first, |before| knots[before]);
                let [t1, to] = knots.get(after).copied().unwrap_or([*period, first[1]]);
                let (length, part) = (t1 - t0, (within - t0) / (t1 - t0));
                if *smooth {
                    let (sin, cos) = (PI * part).sin_cos();
                    let way = to - from;
                    [from + way * (1.0 - cos) / 2.0, way * PI * sin / (2.0 * length)]
                } else {
                    [from + (to - from) * part, (to - from) / length]
                }
            }
            Self::Table(knots) => {
                let after = knots.partition_point(|knot| knot[0] <= time);
                match (after.checked_sub(1).map(|before| knots[before]), knots.get(after)) {
                    (Some([t0, from]), Some(&[t1, to])) => {
                        let rate = (to - from) / (t1 - t0);
                        [from + rate * (time - t0), rate]
                    }
                    (Some([_, value]), None) | (None, Some(&[_, value])) => [value, 0.0],
                    (None, None) => [0.0, 0.0],
                }
            }
            Self::Cubic(knots) => cubic_at(knots, time),
            Self::Cycle(cycle) => cycle.at(time),
            Self::Command(command) => command.at(time),
        }
    }

    /// Times in (from, to) at which the rate jumps (s), ascending.
    #[must_use]
    pub fn rate_discontinuities(&self, from: f64, to: f64) -> Vec<f64> {
        match self {
            Self::Legs { knots, period, smooth: false } => {
                let last = (to / period).floor();
                let cycles = successors(Some((from / period).floor()), |cycle| Some(cycle + 1.0));
                let all = cycles
                    .take_while(|cycle| *cycle <= last)
                    .flat_map(|cycle| knots.iter().map(move |knot| cycle * period + knot[0]));
                all.filter(|time| *time > from && *time < to).collect()
            }
            Self::Table(knots) => {
                let times = knots.iter().map(|knot| knot[0]);
                times.filter(|time| *time > from && *time < to).collect()
            }
            Self::Constant(_)
            | Self::Steady { .. }
            | Self::Sine { .. }
            | Self::Legs { .. }
            | Self::Cubic(_)
            | Self::Cycle(_)
            | Self::Command(_) => Vec::new(),
        }
    }

    /// What it waits for, if it does.
    #[must_use]
    pub fn command(&self) -> Option<&Command> {
        match self {
            Self::Command(command) => Some(command),
            _ => None,
        }
    }

    /// The time after which it begins again (s), if it does.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Sine { period, .. } | Self::Legs { period, .. } => Some(*period),
            Self::Cycle(cycle) => Some(cycle.period),
            Self::Constant(_)
            | Self::Steady { .. }
            | Self::Table(_)
            | Self::Cubic(_)
            | Self::Command(_) => None,
        }
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Constant(value) => [*value; 2],
            Self::Steady { start, rate } if *rate == 0.0 => [*start; 2],
            Self::Steady { start, rate } if *rate < 0.0 => [f64::NEG_INFINITY, *start],
            Self::Steady { start, .. } => [*start, f64::INFINITY],
            Self::Sine { mean, amplitude, .. } => [mean - amplitude.abs(), mean + amplitude.abs()],
            Self::Legs { knots, .. } | Self::Table(knots) => {
                extent(knots.iter().map(|knot| knot[1]))
            }
            Self::Cubic(knots) => {
                let pairs = knots.windows(2);
                let turns = pairs.flat_map(|pair| Cubic::between(pair[0], pair[1]).extrema());
                extent(knots.iter().map(|knot| knot[1]).chain(turns))
            }
            Self::Cycle(cycle) => cycle.range(),
            Self::Command(command) => command.range(),
        }
    }
}

/// Smallest and largest of some values.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
        [least.min(value), most.max(value)]
    })
}

/// Value and rate at a time of cubic polynomials between knots.
#[must_use]
pub(crate) fn cubic_at(knots: &[[f64; 3]], time: f64) -> [f64; 2] {
    // The outer ones go on: the last step may end beyond its knot by rounding
    let last = knots.len().saturating_sub(1);
    let after = knots.partition_point(|knot| knot[0] <= time).min(last).max(1);
    match (knots.get(after - 1), knots.get(after)) {
        (Some(before), Some(after)) => Cubic::between(*before, *after).at(time),
        (Some([_, value, rate]), None) => [*value, *rate],
        _ => [0.0, 0.0],
    }
}

/// The cubic polynomial with given values and rates at two times:
/// value + rate t + bend t^2 + twist t^3, t since the first one.
struct Cubic {
    start: f64,
    length: f64,
    coefficients: [f64; 4],
}

impl Cubic {
    fn between([t0, from, r0]: [f64; 3], [t1, to, r1]: [f64; 3]) -> Self {
        let length = t1 - t0;
        let chord = (to - from) / length;
        let bend = (3.0 * chord - 2.0 * r0 - r1) / length;
        let twist = (r0 + r1 - 2.0 * chord) / (length * length);
        Self { start: t0, length, coefficients: [from, r0, bend, twist] }
    }

    /// Value and rate at a time.
    fn at(&self, time: f64) -> [f64; 2] {
        let (t, [value, rate, bend, twist]) = (time - self.start, self.coefficients);
        let value = value + t * (rate + t * (bend + t * twist));
        [value, rate + t * (2.0 * bend + 3.0 * t * twist)]
    }

    /// Values where the rate is zero between the two times.
    fn extrema(self) -> impl Iterator<Item = f64> {
        let [_, rate, bend, twist] = self.coefficients;
        // Roots of 3 twist t^2 + 2 bend t + rate, without cancellation
        let root = (bend * bend - 3.0 * twist * rate).max(0.0).sqrt();
        let q = -(bend + root.copysign(bend));
        let times = [q / (3.0 * twist), rate / q];
        let (start, length) = (self.start, self.length);
        let inside = times.into_iter().filter(move |t| *t > 0.0 && *t < length);
        inside.map(move |t| self.at(start + t)[0])
    }
}

/// A factor that grows from 0 to 1 over a duration, its first two derivatives zero at both ends, and
/// its rate.
#[must_use]
pub fn smooth_ramp(time: f64, duration: f64) -> [f64; 2] {
    if duration <= 0.0 || time >= duration {
        return [1.0, 0.0];
    }
    let s = (time / duration).max(0.0);
    let value = s * s * s * (10.0 + s * (6.0 * s - 15.0));
    [value, 30.0 * s * s * (1.0 - s) * (1.0 - s) / duration]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_those_of_the_values() {
        let legs = |smooth| Stroke::Legs {
            knots: vec![[0.0, 10.0], [1.0, 6.0], [2.5, 6.0], [3.0, 10.0]],
            period: 4.0,
            smooth,
        };
        let sine = Stroke::Sine { mean: 1.0, amplitude: 2.0, period: 3.0, phase: 0.4, ramp: 2.0 };
        let table = Stroke::Table(vec![[0.5, 1.0], [2.0, 4.0], [3.0, 3.5]]);
        let cubic = Stroke::Cubic(vec![[0.0, 1.0, 0.5], [1.0, 2.0, -3.0], [10.0, 0.0, 1.0]]);
        let steady = Stroke::Steady { start: 0.3, rate: -2.0 };
        assert_eq!(steady.range(), [f64::NEG_INFINITY, 0.3]);
        for stroke in [legs(false), legs(true), sine, table, cubic, steady, Stroke::Constant(3.0)] {
            for time in [0.2, 0.7, 1.3, 2.7, 3.3, 5.1, 9.9] {
                let [_, rate] = stroke.at(time);
                let slope = (stroke.at(time + 1e-6)[0] - stroke.at(time - 1e-6)[0]) / 2e-6;
                assert!((rate - slope).abs() < 1e-7, "{stroke:?} {time}: {rate} {slope}");
            }
        }
        assert_eq!(legs(false).at(4.5)[0], 8.0);
        assert_eq!(legs(false).at(1.0), [6.0, 0.0]);
    }

    #[test]
    fn a_cubic_passes_through_its_knots_and_knows_its_extrema() {
        let knots = vec![[0.0, 0.0, 3.0], [1.0, 0.0, 3.0], [2.0, 1.0, 0.0], [3.0, 1.0, 0.0]];
        let stroke = Stroke::Cubic(knots.clone());
        for [time, value, rate] in knots {
            assert_eq!(stroke.at(time), [value, rate]);
        }
        let times = || (0..=3000).map(|nth| f64::from(nth) / 1000.0);
        let [least, most] = stroke.range();
        let [low, high] = extent(times().map(|time| stroke.at(time)[0]));
        assert!((least - low).abs() < 1e-5 && (most - high).abs() < 1e-5, "{least} {most}");
        assert!(least < -0.2 && most == 1.0, "{least} {most}");
        let line = Stroke::Cubic(vec![[0.0, 1.0, 1.0], [2.0, 3.0, 1.0]]);
        assert_eq!((line.range(), line.at(0.5)), ([1.0, 3.0], [1.5, 1.0]));
    }

    #[test]
    fn discontinuities_come_back_with_the_period() {
        let legs = Stroke::Legs { knots: vec![[0.0, 1.0], [1.0, 0.0]], period: 2.0, smooth: false };
        assert_eq!(legs.rate_discontinuities(0.5, 4.5), vec![1.0, 2.0, 3.0, 4.0]);
        assert_eq!(legs.rate_discontinuities(1.0, 2.0), Vec::<f64>::new());
        assert_eq!(
            Stroke::Table(vec![[1.0, 0.0], [2.0, 1.0]]).rate_discontinuities(0.0, 2.0),
            vec![1.0]
        );
    }
}
