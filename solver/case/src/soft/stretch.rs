//! `Stretch`: what active fibres are told in time.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::spec::body::stroke::smooth_ramp;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// The stretch that fibres are told, of the middle of each frame; of pulses its mean over the frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Stretch {
    /// The same at all times.
    Constant(f64),
    /// A wave.
    Wave(Wave),
    /// Pulses with slopes.
    Trapezoid(Trapezoid),
    /// One number a frame.
    Frames(Vec<f64>),
    /// By the record.
    Record(RecordStretch),
}

/// mean + amplitude sin(2 pi (frequency t - phase)), the amplitude grown from 0 over `ramp`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Mean stretch.
    #[serde(default = "one")]
    pub mean: f64,
    /// Amplitude.
    pub amplitude: f64,
    /// Frequency (1/s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub frequency: f64,
    /// Phase (periods).
    #[serde(default)]
    pub phase: f64,
    /// Time over which the amplitude grows (s).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub ramp: f64,
}

impl Wave {
    /// Its value at a time (s).
    #[must_use]
    pub fn value(&self, time: f64) -> f64 {
        let [_, by_amplitude, ..] = self.slopes(time);
        self.mean + self.amplitude * by_amplitude
    }

    /// Its derivatives by mean, amplitude, frequency and phase at a time (s).
    #[must_use]
    pub fn slopes(&self, time: f64) -> [f64; 4] {
        let [part, _] = smooth_ramp(time, self.ramp);
        let (sin, cos) = (TAU * (self.frequency * time - self.phase)).sin_cos();
        let turned = self.amplitude * part * cos * TAU;
        [1.0, part * sin, turned * time, -turned]
    }
}

/// A stretch 1 - amplitude s(frequency t - phase), where s of a period rises from 0 to 1 over `rise`, stays, and falls at
/// `on` by the same slope (a sloped box); 0 before the first period.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Trapezoid {
    /// Contraction between the slopes.
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub amplitude: f64,
    /// Frequency (1/s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub frequency: f64,
    /// Phase (periods).
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub phase: f64,
    /// Time of each slope (periods).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub rise: f64,
    /// When it begins to fall (periods).
    #[serde(default = "half")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub on: f64,
}

fn one() -> f64 {
    1.0
}

fn half() -> f64 {
    0.5
}

impl Trapezoid {
    /// Whether it contracts by less than all, rises before it falls, and falls within a period.
    #[must_use]
    pub fn is_one(&self) -> bool {
        let Self { amplitude, rise, on, .. } = *self;
        (0.0..1.0).contains(&amplitude) && rise > 0.0 && rise <= on && on + rise <= 1.0
    }

    /// Its mean over a span of time, from when to when (s).
    #[must_use]
    pub fn value(&self, span: [f64; 2]) -> f64 {
        1.0 + self.amplitude * self.slopes(span)[0]
    }

    /// The derivatives of the mean over a span of time, from when to when (s), by amplitude, rise and on.
    #[must_use]
    pub fn slopes(&self, span: [f64; 2]) -> [f64; 3] {
        let [begin, end] = span.map(|time| self.frequency * time - self.phase);
        let (from, to) = (self.so_far(begin), self.so_far(end));
        let mean = |at: usize| (to[at] - from[at]) / (end - begin);
        [-mean(0), -self.amplitude * mean(1), -self.amplitude * mean(2)]
    }

    /// The integral of s up to a time in periods, and its derivatives by rise and on.
    fn so_far(&self, time: f64) -> [f64; 3] {
        let (rise, on) = (self.rise, self.on);
        if time <= 0.0 {
            return [0.0; 3];
        }
        let (whole, part) = (time.floor(), time.fract());
        let [value, by_rise, by_on] = if part < rise {
            [part * part / (2.0 * rise), -part * part / (2.0 * rise * rise), 0.0]
        } else if part < on {
            [part - rise / 2.0, -0.5, 0.0]
        } else if part < on + rise {
            let left = (on + rise - part) / rise;
            [on - left * left * rise / 2.0, left * left / 2.0 - left, 1.0 - left]
        } else {
            [on, 0.0, 1.0]
        };
        [whole * on + value, by_rise, whole + by_on]
    }
}

/// A stretch 1 - contraction/length, with the contraction of a tendon from a column of the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RecordStretch {
    /// The column, in the record's unit of lengths.
    pub contraction: String,
    /// Length of the tendon at rest (m).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub length: f64,
}

#[cfg(test)]
mod tests {
    use super::Trapezoid;

    const PULSE: Trapezoid =
        Trapezoid { amplitude: 0.2, frequency: 2.0, phase: 0.25, rise: 0.1, on: 0.4 };

    /// Against sums over many moments.
    #[test]
    fn pulses_rise_stay_and_fall() {
        let shape = |periods: f64| {
            let part = periods.rem_euclid(1.0);
            let slopes = [part / 0.1, (0.5 - part) / 0.1];
            if periods < 0.0 { 0.0 } else { slopes[0].min(slopes[1]).clamp(0.0, 1.0) }
        };
        for span in [[0.0, 0.1], [0.1, 0.14], [0.2, 0.33], [0.3, 2.07], [0.4, 0.41]] {
            let n = 100_000_u32;
            let time = |k: u32| span[0] + (span[1] - span[0]) * (f64::from(k) + 0.5) / f64::from(n);
            let sum: f64 = (0..n).map(|k| shape(2.0 * time(k) - 0.25)).sum();
            let wanted = 1.0 - 0.2 * sum / f64::from(n);
            assert!((PULSE.value(span) - wanted).abs() < 1e-6, "{span:?}");
        }
    }

    #[test]
    fn numbers_of_pulses_have_their_derivatives() {
        for span in [[0.13, 0.17], [0.2, 0.35], [0.36, 0.39], [0.1, 1.93], [0.45, 0.5]] {
            let slopes = PULSE.slopes(span);
            let at = |which: usize, by: f64| {
                let mut pulse = PULSE;
                match which {
                    0 => pulse.amplitude += by,
                    1 => pulse.rise += by,
                    _ => pulse.on += by,
                }
                pulse.value(span)
            };
            for (which, slope) in slopes.iter().enumerate() {
                let wanted = (at(which, 1e-6) - at(which, -1e-6)) / 2e-6;
                assert!((slope - wanted).abs() < 1e-7, "{span:?} {which}: {slope} {wanted}");
            }
        }
    }
}
