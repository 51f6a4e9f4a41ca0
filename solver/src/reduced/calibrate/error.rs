//! `CalibrateError`: why coefficients could not be found.

use alewife_reduced::tree::TreeError;
use thiserror::Error;

use crate::case::CaseError;
use crate::reduced::ReducedError;

/// What went wrong.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The case asks for nothing.
    #[error("the case has no [calibration]; add it with `fit` and [[calibration.from]]")]
    Nothing,
    /// A run or a record is wrong.
    #[error("calibration.from.{number}: {what}")]
    Record {
        /// Its number in the case, from 0.
        number: usize,
        /// What is wrong, and what is accepted.
        what: String,
    },
    /// The case of a run is wrong.
    #[error("calibration.from.{number}: {error}")]
    Case {
        /// Its number in the case, from 0.
        number: usize,
        /// What is wrong.
        error: Box<CaseError>,
    },
    /// A reduced model cannot be made.
    #[error(transparent)]
    Model(#[from] ReducedError),
    /// A motion or a fit fails.
    #[error(transparent)]
    Tree(#[from] TreeError),
}
