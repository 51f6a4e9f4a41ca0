//! `GradientError`: why there is no gradient.

use thiserror::Error;

use crate::case::{CaseError, CaseFile, Diagnostic, Severity};
use crate::coupling::SolveError;
use crate::motion::MotionError;
use crate::run::RunError;

/// Why there is no gradient.
#[derive(Debug, Error)]
pub enum GradientError {
    /// The case, a quantity or a key is none that a gradient is taken of.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// There is no flow.
    #[error(transparent)]
    Run(#[from] RunError),
    /// There is no adjoint flow.
    #[error("the adjoint flow: {0}")]
    Adjoint(#[from] SolveError),
}

impl From<MotionError> for GradientError {
    fn from(error: MotionError) -> Self {
        RunError::from(error).into()
    }
}

impl GradientError {
    /// What is asked of a key of a case and cannot be had, with what can.
    pub(super) fn refused(file: &CaseFile, key: &str, message: String, help: &str) -> Self {
        CaseError::Wrong(vec![Diagnostic {
            severity: Severity::Error,
            key: key.to_owned(),
            message,
            help: help.to_owned(),
            location: file.location(key),
        }])
        .into()
    }

    /// What is asked for and is nowhere in a case, with what is.
    pub(super) fn unknown(message: String, help: String) -> Self {
        CaseError::Wrong(vec![Diagnostic {
            severity: Severity::Error,
            key: String::new(),
            message,
            help,
            location: None,
        }])
        .into()
    }
}
