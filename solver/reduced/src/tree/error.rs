//! `TreeError`: why a tree, its loads or a fit are refused or fail.

use alewife_interrupt::Stopped;
use thiserror::Error;

/// What is wrong with a reduced model.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TreeError {
    /// A link is described wrongly.
    #[error("link {link}: {what}")]
    Link {
        /// Number of the link, from 0.
        link: usize,
        /// What is wrong, and what is accepted.
        what: String,
    },
    /// A tendon is described wrongly.
    #[error("tendon {tendon}: {what}")]
    Tendon {
        /// Number of the tendon, from 0.
        tendon: usize,
        /// What is wrong, and what is accepted.
        what: String,
    },
    /// The equations of a step have no unique solution: no mass and no resistance hold a coordinate.
    #[error("at time {time}: nothing resists coordinate {coordinate}, it has no mass and no drag")]
    Singular {
        /// Time at the beginning of the step (s).
        time: f64,
        /// Number of the coordinate, those of the root first.
        coordinate: usize,
    },
    /// A velocity is no number any more.
    #[error("at time {time}: a velocity is not finite, make the step shorter")]
    BlowUp {
        /// Time at the end of the step (s).
        time: f64,
    },
    /// It was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// Something else given is wrong.
    #[error("{0}")]
    Given(String),
}
