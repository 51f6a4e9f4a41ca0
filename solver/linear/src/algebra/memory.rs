//! `SolverMemory`: what a solver keeps from system to system, for a run that resumes with the same bits.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Earlier factors, by the values they were made of, and earlier solutions.
///
/// A solver that recalls it answers as the one it was taken from would have, bit by bit.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SolverMemory {
    /// Values of the matrix that is factorised, by the entries of its pattern; none without factors.
    pub(super) factorised: Option<Vec<f64>>,
    /// Systems still to be factorised without a trial of earlier factors, and the next such pause.
    pub(super) pauses: [usize; 2],
    /// Solutions of earlier systems by their unknowns, the oldest first.
    pub(super) solutions: Vec<Vec<f32>>,
    /// Whether factors have taken the place of iterations.
    pub(super) is_direct: bool,
}

/// Why a solver cannot recall: the memory is not that of such a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("what the linear solver kept is not of a system of {n_unknowns} unknowns")]
pub struct ForeignMemory {
    /// Unknowns of the system.
    pub n_unknowns: usize,
}
