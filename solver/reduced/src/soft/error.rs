//! `SoftError`: why a motion, a record or a search is refused or fails.

use alewife_interrupt::Stopped;
use alewife_solid::solid::SolidError;
use thiserror::Error;

/// What is wrong in the soft tier.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SoftError {
    /// The body, or a step of it.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// A step of a motion failed.
    #[error("step {step} of {n_steps}: {error}")]
    Step {
        /// Number of the step, from 1.
        step: usize,
        /// Steps of the motion.
        n_steps: usize,
        /// Why.
        error: SolidError,
    },
    /// It was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// A curve of loads has too few or wrong points.
    #[error("{0}")]
    Curve(String),
    /// A plan is not one: steps, substeps, stretches.
    #[error("{0}")]
    Plan(String),
    /// An objective of way over work has no value.
    #[error(
        "a way over work has no value where there is no work: the way is {way:.3e} m, the work that the \
         commands put into the fibres {work:.3e} J, that of `standing_power` {standing:.3e} J; start where \
         fibres do work, give a `standing_power`, or seek `travel`"
    )]
    NoWork {
        /// The way (m).
        way: f64,
        /// The work of the commands (J).
        work: f64,
        /// The work of the power that is always spent (J).
        standing: f64,
    },
    /// A recording cannot be used: the row counts from 1, the header being row 1.
    #[error("{file}, row {row}: {what}")]
    Record {
        /// The file.
        file: String,
        /// Row of the file.
        row: usize,
        /// What is wrong, and what is accepted.
        what: String,
    },
}
