//! `SlopeError`: why a motion has no derivatives.

use thiserror::Error;

use crate::case::{CaseError, Model, TimeSettings, Unsteady};
use crate::reduced::ReducedError;

/// Why a motion has no derivatives.
#[derive(Debug, Error)]
pub enum SlopeError {
    /// There is no such case.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The model cannot be made, or a step fails.
    #[error(transparent)]
    Model(#[from] ReducedError),
    /// There is no derivative by a number.
    #[error("it changes {what}")]
    Number {
        /// Which of the numbers, from 0.
        nth: usize,
        /// What it changes.
        what: String,
    },
}

/// The steps of a case.
pub(super) fn unsteady(model: &Model) -> Result<&Unsteady, ReducedError> {
    match &model.case.time {
        TimeSettings::Unsteady(time) => Ok(time),
        TimeSettings::Steady(_) => Err(ReducedError::Unknown("a steady flow".to_owned())),
    }
}
