//! Newton's method for a dense system.

use nalgebra::{DMatrix, DVector};

use super::error::DryError;

/// Iterations; those of a rod that bends far in a step are about ten.
const ITERATIONS: usize = 40;

/// Increment over the largest unknown at which the next one would be below rounding.
const TOLERANCE: f64 = 1e-10;

/// The same, below which an increment that no longer shrinks is rounding.
const STAGNATION: f64 = 1e-6;

/// Part of the coordinates that is rounding: that of their stiffest forces.
pub const ROUNDING: f64 = 1e-12;

/// Where Newton's method starts and ends.
pub struct Search {
    pub guess: DVector<f64>,
    /// Increments that are rounding.
    pub rounding: f64,
    /// Time (s), for messages.
    pub time: f64,
}

/// The zero of a function that gives its matrix of derivatives and its value.
pub fn newton(
    search: Search,
    mut system: impl FnMut(&DVector<f64>) -> (DMatrix<f64>, DVector<f64>),
) -> Result<DVector<f64>, DryError> {
    let Search { guess: mut unknowns, rounding, time } = search;
    let mut before = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let (matrix, residual) = system(&unknowns);
        let increment = matrix.lu().solve(&residual).ok_or(DryError::Singular { time })?;
        unknowns -= &increment;
        let (size, largest) = (increment.amax(), unknowns.amax());
        if !size.is_finite() {
            return Err(DryError::Diverged { time });
        }
        let stagnates = size > 0.5 * before && size <= STAGNATION * largest;
        if size <= TOLERANCE * largest + rounding || stagnates {
            return Ok(unknowns);
        }
        before = size;
    }
    Err(DryError::Diverged { time })
}
