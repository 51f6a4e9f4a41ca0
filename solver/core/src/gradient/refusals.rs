//! What gradients are not taken of yet, and what to do instead.

use super::error::GradientError;
use crate::case::{BoundaryCondition, CaseFile};
use crate::coupling::Problem;

/// Refuses what a case has that its gradient would leave out.
pub(super) fn refuse<const D: usize>(
    file: &CaseFile,
    problem: &Problem<D>,
) -> Result<(), GradientError> {
    let waves =
        |condition: &BoundaryCondition| matches!(condition, BoundaryCondition::WavingSheet { .. });
    let refused = [
        (
            problem.bodies.iter().any(|body| body.shape.is_some()),
            "body",
            "gradients know no bodies that deform yet",
            "take rigid bodies, with a squirmer's slip if they are to swim",
        ),
        (
            problem.mean_flow.is_some(),
            "flow",
            "gradients know no mean flow of a periodic cell yet",
            "let the flow enter and leave by sides, with [boundary]",
        ),
        (
            problem.free_translations().contains(&true),
            "boundary",
            "gradients know no fluid that nothing holds yet",
            "let a side be a wall",
        ),
        (
            file.case().boundary.values().any(waves),
            "boundary",
            "gradients know no sheets that wave yet",
            "give the side a velocity",
        ),
    ];
    match refused.iter().find(|(is_so, ..)| *is_so) {
        Some((_, key, message, help)) => {
            Err(GradientError::refused(file, key, (*message).to_owned(), help))
        }
        None => Ok(()),
    }
}
