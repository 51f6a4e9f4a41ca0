//! `LinearSolver`: what coupling asks of a method for A x = b, be it direct or iterative.
//!
//! The constructor of a solver analyses the system: it gets the sparsity pattern and what else the
//! method has to know of the unknowns. That differs between methods ([`super::Unknowns`] for factors,
//! [`super::SaddlePoint`] and [`super::Weights`] for a preconditioner), so it is no part of the trait.

use std::fmt::Debug;

use alewife_interrupt::Stopped;
use thiserror::Error;

use super::memory::ForeignMemory;
use crate::multifrontal::{NoFactors, Singular};

/// Why a linear system was not solved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LinearError {
    /// No inverse, or none that double precision can find.
    #[error("{} unknowns are not determined by the equations", .0.unknowns.len())]
    Singular(Singular),
    /// Refinement ended above the tolerance.
    #[error("the solution leaves a relative residual of {residual:.1e}")]
    Inaccurate {
        /// Largest entry of |b - A x| over the largest of |A| |x| + |b|.
        residual: f64,
    },
    /// Iterations ended far from a solution.
    #[error(
        "{iterations} iterations with {n_unknowns} unknowns leave {residual:.1e} of the right-hand \
         side, and its factors would have {n_factor_entries} entries, too many; look for flat cells and \
         for gaps narrower than one cell in the mesh, take a smaller time step, or a coarser mesh"
    )]
    Stalled {
        /// Euclidean norm of the residual over that of the right-hand side.
        residual: f64,
        /// Iterations made.
        iterations: usize,
        /// Number of unknowns.
        n_unknowns: usize,
        /// Entries that the factors of the matrix would have.
        n_factor_entries: usize,
    },
    /// Factors would be too large where iterations do not help.
    #[error(
        "the factors of {n_unknowns} unknowns would have {n_factor_entries} entries, too many; take a coarser mesh"
    )]
    TooLarge {
        /// Number of unknowns.
        n_unknowns: usize,
        /// Entries that the factors of the matrix would have.
        n_factor_entries: usize,
    },
    /// A value of the matrix, the right-hand side or the solution is infinite or not a number.
    #[error("the matrix, the right-hand side or the solution is not finite")]
    NotFinite,
    /// A solver cannot continue from what another one kept.
    #[error(transparent)]
    Foreign(#[from] ForeignMemory),
    /// The work was to end before there was a solution.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<NoFactors> for LinearError {
    fn from(error: NoFactors) -> Self {
        match error {
            NoFactors::Singular(singular) => Self::Singular(singular),
            NoFactors::Stopped(stopped) => Self::Stopped(stopped),
        }
    }
}

/// How accurately a system was solved.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Accuracy {
    /// Largest entry of |b - A x| over the largest of |A| |x| + |b|.
    pub residual: f64,
    /// Number of refinement steps, or of iterations where there are no factors.
    pub refinements: usize,
}

/// A method for the systems of one sparsity pattern whose values change from step to step.
///
/// A set-up (factors, or a preconditioner) outlives the matrix it belongs to: a matrix that has not
/// changed is solved with it as it is, one that has changed a little may be solved with it iteratively.
/// The same calls give the same bits: no decision depends on a clock or on the number of threads.
pub trait LinearSolver: Debug + Send {
    /// In what form it takes matrices.
    type Matrix;

    /// Factorises a matrix, or sets up its preconditioner, unless the set-up at hand is that of equal
    /// values.
    ///
    /// # Errors
    /// When the matrix is singular, or a value is not finite.
    fn set_up(&mut self, matrix: &Self::Matrix) -> Result<(), LinearError>;

    /// Overwrites a right-hand side with the solution for the matrix of the last set-up.
    ///
    /// # Errors
    /// When the residual stays large, or a value is not finite.
    ///
    /// # Panics
    /// May panic where no matrix has been set up.
    fn solve(&mut self, matrix: &Self::Matrix, rhs: &mut [f64]) -> Result<Accuracy, LinearError>;

    /// The same, where the accuracy is a choice until what is left of the residual is this part of the
    /// right-hand side.
    ///
    /// # Errors
    /// When the residual stays large, or a value is not finite.
    fn solve_to(
        &mut self,
        matrix: &Self::Matrix,
        rhs: &mut [f64],
        _reduction: f64,
    ) -> Result<Accuracy, LinearError> {
        self.solve(matrix, rhs)
    }

    /// Overwrites a right-hand side with the solution for a matrix that has changed since the last
    /// set-up, by that set-up.
    ///
    /// The residual is brought far below |A| |y|, the terms of the equations for a `typical` solution
    /// y. Returns false and leaves `rhs` as it is when there is no set-up, when it belongs to this
    /// very matrix, or when another set-up costs less.
    ///
    /// # Errors
    /// When the right-hand side or `typical` is not finite.
    fn solve_with_earlier_set_up(
        &mut self,
        matrix: &Self::Matrix,
        rhs: &mut [f64],
        typical: &[f64],
    ) -> Result<bool, LinearError>;

    /// The block of the inverse in the rows and columns of some of the unknowns with dense rows, for
    /// the matrix of the last set-up: the mobility of the bodies, where these are their rigid
    /// velocities.
    ///
    /// # Shape
    /// n x n for n unknowns, column by column: column j has the values of the unknowns for a unit
    /// right-hand side in the equation of the j-th.
    ///
    /// # Errors
    /// When one of them is not among the unknowns with dense rows, or a value is not finite.
    fn inverse_of_dense(
        &mut self,
        matrix: &Self::Matrix,
        unknowns: &[usize],
    ) -> Result<Vec<f64>, LinearError>;
}
