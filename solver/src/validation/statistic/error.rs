//! `StatisticError`: why a number cannot be taken from a run.

use thiserror::Error;

/// Why a number cannot be taken from a run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StatisticError {
    /// The run has no such column.
    #[error("the run has no quantity `{0}`")]
    UnknownQuantity(String),
    /// The window holds no step.
    #[error("no step lies in the window from {start} to {end}; widen statistics.window")]
    EmptyWindow {
        /// Start (s).
        start: f64,
        /// End (s).
        end: f64,
    },
    /// The run ends before the window does.
    #[error("the window goes from {start} to {end}, and the run ends at {last}")]
    UnfinishedWindow {
        /// Start (s).
        start: f64,
        /// End (s).
        end: f64,
        /// End of the run (s).
        last: f64,
    },
    /// The run was not computed at that time.
    #[error("the run has no value at time {time}: it reaches from {start} to {end}")]
    OutsideRun {
        /// The time asked for (s).
        time: f64,
        /// Start of the run (s).
        start: f64,
        /// End of the run (s).
        end: f64,
    },
    /// The series does not repeat itself often enough.
    #[error(
        "`{quantity}` crosses its mean upwards {crossings} times in the window; a period takes \
         two: run longer or widen statistics.window"
    )]
    NoPeriod {
        /// Name of the series.
        quantity: String,
        /// Crossings found.
        crossings: usize,
    },
    /// The series stays on one side of a level.
    #[error(
        "`{quantity}` does not reach {level} in the window: it goes from {lowest} to {highest} \
         there"
    )]
    NotReached {
        /// Name of the series.
        quantity: String,
        /// The level.
        level: f64,
        /// Smallest value in the window.
        lowest: f64,
        /// Largest value in the window.
        highest: f64,
    },
    /// Drag and inertia cannot be separated.
    #[error(
        "body `{body}` does not oscillate along {axis} in the window, as Morison's equation needs"
    )]
    NoOscillation {
        /// Name of the body.
        body: String,
        /// Axis of the force.
        axis: String,
    },
    /// Something the statistic needs is not in the case.
    #[error("the statistic needs {0}")]
    Missing(&'static str),
}
