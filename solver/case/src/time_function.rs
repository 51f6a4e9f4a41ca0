//! Integrals of functions of time: how far a motion with a factor leads.

use std::f64::consts::{PI, TAU};

use super::TimeFunction;

impl TimeFunction {
    /// Its integral from time 0 to a time that is not before (s).
    #[must_use]
    pub fn integral(&self, time: f64) -> f64 {
        match self {
            Self::Ramp { duration } if time < *duration => 0.5 * time * time / duration,
            Self::SmoothRamp { duration } if time < *duration => {
                0.5 * (time - duration / PI * (PI * time / duration).sin())
            }
            Self::Ramp { duration } | Self::SmoothRamp { duration } => time - 0.5 * duration,
            Self::Sine { mean, amplitude, period, phase } => {
                let cosine = |time: f64| (TAU * (time / period + phase)).cos();
                mean * time + amplitude * period / TAU * (cosine(0.0) - cosine(time))
            }
            Self::Table(knots) => {
                let (Some([first, low]), Some([last, high])) = (knots.first(), knots.last()) else {
                    return time;
                };
                let pieces = knots.windows(2).map(|pair| under([pair[0], pair[1]], time));
                let before = low * time.min(*first).max(0.0);
                before + pieces.sum::<f64>() + high * (time - last.max(0.0)).max(0.0)
            }
        }
    }
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
