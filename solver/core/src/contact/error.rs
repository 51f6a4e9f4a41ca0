//! `ContactError`: why contact forces cannot be found, with the bodies and the gap.

use thiserror::Error;

/// Every way contact can fail.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A number of the law is not positive.
    #[error("contact: {what} = {value} must be positive and finite")]
    Law {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The surface of a body cannot be made.
    #[error("contact: {0}")]
    Surface(#[from] alewife_mesh::MeshError),
    /// A side of the domain is not a wall.
    #[error("contact: side {side} of the domain is its axis or periodic, not a wall")]
    NoWall {
        /// Number of the side.
        side: usize,
    },
    /// Numbers given for a step do not fit together, or one of them is not finite.
    #[error("contact: {what}")]
    Input {
        /// What is wrong.
        what: String,
    },
    /// Bodies touch or overlap before the step.
    #[error(
        "contact: `{first}` and `{second}` touch or overlap before the step: gap {gap:e}; \
         lower the step, or raise the range of the contact law"
    )]
    Overlap {
        /// Name of a body.
        first: String,
        /// Name of the other body, or of the side.
        second: String,
        /// The gap (m), zero or negative.
        gap: f64,
    },
    /// The law is finite at contact, and too weak for the load.
    #[error(
        "contact: `{first}` and `{second}` close the gap, now {gap:e}: the force of the quadratic \
         law is at most {greatest:e}; lower epsilon, raise the range, or use the barrier law"
    )]
    TooWeak {
        /// Name of a body.
        first: String,
        /// Name of the other body, or of the side.
        second: String,
        /// The gap (m).
        gap: f64,
        /// Largest force of the law (N; N/m planar).
        greatest: f64,
    },
    /// Contact is stiff in an explicit step.
    #[error(
        "contact moves the bodies back within {time_scale:.2e}, too fast for a step of {size:.2e} of \
         the scheme `rk3`; lower the step, soften the contact, or write scheme = \"bdf2\""
    )]
    Stiff {
        /// Size of the step (s).
        size: f64,
        /// Time in which it does (s).
        time_scale: f64,
    },
    /// Newton's method did not find the forces.
    #[error(
        "contact: no forces found in {iterations} iterations: poses still change by {change:e}; \
         the smallest gap is {gap:e}, of `{first}` and `{second}`; lower the step"
    )]
    NotConverged {
        /// Name of a body.
        first: String,
        /// Name of the other body, or of the side.
        second: String,
        /// The gap (m).
        gap: f64,
        /// Change of poses in the last iteration (m).
        change: f64,
        /// Iterations made.
        iterations: usize,
    },
}
