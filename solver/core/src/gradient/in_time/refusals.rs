//! What gradients of motions are not taken of, and what to do instead.

use super::super::error::GradientError;
use crate::case::{CaseFile, NoGradientInTime, no_gradient_in_time};

/// Refuses what a case has that the gradient of its motion would leave out.
pub(in crate::gradient) fn refuse_in_time(file: &CaseFile) -> Result<(), GradientError> {
    match no_gradient_in_time(file.case()) {
        Some(NoGradientInTime { key, message, help }) => {
            Err(GradientError::refused(file, key, message.to_owned(), help))
        }
        None => Ok(()),
    }
}
