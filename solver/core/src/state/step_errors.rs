//! `StepErrors`: what the errors of steps in time amount to, over all of a run.

use serde::{Deserialize, Serialize};

/// An error, and the change it is one of, in the same units.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorOfChange {
    /// The error.
    pub error: f64,
    /// The change.
    pub change: f64,
}

impl ErrorOfChange {
    /// The error as a part of the change; none where that is no more than one that is rounding.
    #[must_use]
    pub fn part(&self, rounding: f64) -> Option<f64> {
        (self.change > rounding).then(|| self.error / self.change)
    }
}

/// Integrals over time of the squares of an error and of what it is one of, in the same units.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SquaredError {
    /// Of the error.
    pub error: f64,
    /// Of what it is one of.
    pub size: f64,
}

impl SquaredError {
    /// The error as a part of what it is one of; none where the integral of the square of that is no more than one that
    /// is rounding.
    #[must_use]
    pub fn part(&self, rounding: f64) -> Option<f64> {
        (self.size > rounding).then(|| (self.error / self.size).sqrt())
    }
}

/// Errors by estimates, of one step or of all so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StepErrors {
    /// Of the velocity of the fluid, mean squares over the nodes (m2/s).
    pub flow: SquaredError,
    /// Of the ways of the bodies (m), none of which cancel; rotations count by the reach of a body.
    pub ways: Vec<ErrorOfChange>,
}

impl StepErrors {
    /// Adds the errors of a step.
    pub(super) fn add(&mut self, step: &Self) {
        self.flow.error += step.flow.error;
        self.flow.size += step.flow.size;
        self.ways.resize(step.ways.len(), ErrorOfChange::default());
        for (sum, step) in self.ways.iter_mut().zip(&step.ways) {
            sum.error += step.error;
            sum.change += step.change;
        }
    }

    /// The error of the velocity of the fluid over the velocity; none without inertia, and where the integral of the mean
    /// square of the velocity is rounding (m2/s).
    #[must_use]
    pub fn of_flow(&self, rounding: f64) -> Option<f64> {
        self.flow.part(rounding)
    }

    /// The largest error of the way of a body over the way; ways that are rounding (m) have none.
    #[must_use]
    pub fn of_ways(&self, rounding: f64) -> Option<f64> {
        self.ways.iter().filter_map(|way| way.part(rounding)).max_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_add_up_beside_what_they_are_part_of() {
        let step = |error: f64, change: f64| StepErrors {
            flow: SquaredError { error: error * error, size: change * change },
            ways: vec![ErrorOfChange::default(), ErrorOfChange { error: 2.0 * error, change }],
        };
        let mut sums = StepErrors::default();
        assert_eq!((sums.of_flow(0.0), sums.of_ways(0.0)), (None, None));
        sums.add(&step(0.3, 2.0));
        sums.add(&step(0.4, 2.0));
        let near = |value: Option<f64>, expected: f64| (value.unwrap() - expected).abs() < 1e-12;
        assert!(near(sums.of_flow(7.9), (0.25f64 / 8.0).sqrt()), "{sums:?}");
        assert!(near(sums.of_ways(3.9), 0.35), "{sums:?}");
        assert_eq!((sums.of_flow(8.1), sums.of_ways(4.1)), (None, None), "rounding");
    }
}
