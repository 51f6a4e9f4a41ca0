//! `DryError`: why an equilibrium or a step was not found.

use std::fmt;

/// Why an equilibrium or a step was not found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DryError {
    /// The matrix of Newton's method is singular: something may move without resistance.
    Singular {
        /// Time (s).
        time: f64,
    },
    /// Newton's method does not converge; shorter steps help.
    Diverged {
        /// Time (s).
        time: f64,
    },
}

impl fmt::Display for DryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular { time } => write!(
                f,
                "the equations of the structure are singular at t = {time}: hold it or give it mass"
            ),
            Self::Diverged { time } => {
                write!(f, "Newton's method does not converge at t = {time}: take shorter steps")
            }
        }
    }
}

impl std::error::Error for DryError {}
