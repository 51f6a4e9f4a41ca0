//! Saddle-point systems by GCR with a block-triangular preconditioner: A = [F G; G^T 0].
//!
//! F is the velocity block, rigid velocities of bodies included, and has a multigrid cycle in place of
//! its inverse; the Schur complement -G^T F^-1 G has a scaled mass matrix of the pressures and a discrete
//! Laplacian (@cahouet1988, @elman2014). What is in [`SaddlePoint`] and [`Weights`] is all that is known of
//! flow and mesh here.

mod conjugate_gradients;
mod data;
mod guess;
mod iterative;
mod krylov_space;
mod mass_rows;
mod matrix;
mod preconditioner;
mod scaled;
#[cfg(test)]
mod tests;

pub use data::{Interpolation, Part, SaddlePoint, Weights};
pub use iterative::{IterativeSettings, IterativeSolver};
pub use matrix::SaddleMatrix;
