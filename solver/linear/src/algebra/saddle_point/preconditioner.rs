//! `Preconditioner`: the upper block-triangular matrix [F G; 0 -S] with approximate inverses of F and S.

use super::blocks::{transfer, velocity_block};
use super::data::{SaddlePoint, Weights};
use super::gradient::Gradient;
use super::numbering::{B, BlockVector, Numbering};
use super::schur::SchurComplement;
use crate::multigrid::{BlockMatrix, Chebyshev, Hierarchy, HierarchySettings, Spectrum};
use crate::sparse::SparseMatrix;

/// Degree of the smoother of the first level of a multigrid cycle.
const SMOOTHING: usize = 2;
/// Degree of the polynomial that takes the place of a cycle where no level but the first is needed.
const DEGREE: usize = 4;
/// The part of the spectrum on which that polynomial is small.
const SPECTRUM: Spectrum = Spectrum::UpperEnd(1.0 / 10.0);
/// Part of the diagonal of F that is no derivative, in the median over the unknowns, from which the
/// coarser levels are left out.
const DOMINANT: f64 = 0.2;

/// Approximate inverse of a saddle-point matrix.
#[derive(Debug)]
pub(super) struct Preconditioner {
    velocity: VelocitySolver,
    gradient: Gradient,
    schur: SchurComplement,
    rhs: BlockVector,
    solution: BlockVector,
    pressure: Vec<f32>,
}

/// What takes the place of F^-1.
#[derive(Debug)]
enum VelocitySolver {
    /// Where derivatives dominate.
    Cycle(Hierarchy<B>),
    /// Where density over time step does: F is nearly a mass matrix.
    Polynomial(Box<Polynomial>),
}

#[derive(Debug)]
struct Polynomial {
    matrix: BlockMatrix<B>,
    chebyshev: Chebyshev<B>,
}

impl Preconditioner {
    /// For a matrix of this system.
    pub fn new(
        system: &SaddlePoint,
        numbering: &Numbering,
        weights: &Weights,
        matrix: &SparseMatrix,
    ) -> Self {
        let block = velocity_block(matrix, numbering);
        let n_pairs = numbering.n_bodies;
        let is_dominated = damped_part(weights, numbering, matrix) > DOMINANT;
        let velocity = if is_dominated {
            let chebyshev = Chebyshev::new(&block, n_pairs, SPECTRUM, DEGREE);
            VelocitySolver::Polynomial(Box::new(Polynomial { matrix: block, chebyshev }))
        } else {
            let transfer = transfer(&weights.interpolation, numbering);
            let settings = HierarchySettings { n_pairs, degree: SMOOTHING, is_singular: false };
            VelocitySolver::Cycle(Hierarchy::new(block, Some(transfer), settings))
        };
        let gradient = Gradient::new(matrix, numbering);
        let schur = SchurComplement::new(weights, &gradient, numbering, system.has_held_pressure);
        let rhs = vec![[0.0; B]; numbering.blocks.len()];
        let pressure = vec![0.0; numbering.pressures.len()];
        Self { velocity, gradient, schur, solution: rhs.clone(), rhs, pressure }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        let velocity = match &self.velocity {
            VelocitySolver::Cycle(hierarchy) => hierarchy.n_bytes(),
            VelocitySolver::Polynomial(polynomial) => polynomial.matrix.n_bytes(),
        };
        velocity + self.gradient.n_bytes() + self.schur.n_bytes()
    }

    /// Overwrites z with S^-1 M^-1 S^-1 r for the approximation M of the matrix, with S the diagonal
    /// matrix of `scales`.
    pub fn apply(&mut self, numbering: &Numbering, scales: &[f64], r: &[f64], z: &mut [f32]) {
        let Self { velocity, gradient, schur, rhs, solution, pressure } = self;
        numbering.split(r, scales, rhs, pressure);
        schur.solve(pressure);
        pressure.iter_mut().for_each(|value| *value = -*value);
        gradient.multiply_subtract(pressure, rhs);
        match velocity {
            VelocitySolver::Cycle(hierarchy) => hierarchy.cycle(rhs, solution),
            VelocitySolver::Polynomial(polynomial) => {
                let Polynomial { matrix, chebyshev } = polynomial.as_mut();
                chebyshev.solve(matrix, rhs, solution);
            }
        }
        numbering.join(solution, pressure, scales, z);
    }
}

/// Median over the velocities at nodes of what is no derivative in the diagonal of F.
fn damped_part(weights: &Weights, numbering: &Numbering, matrix: &SparseMatrix) -> f64 {
    let Some(damping) = &weights.damping else { return 0.0 };
    let unknowns = numbering.blocks[..numbering.n_nodes].iter().flatten().flatten();
    let mut parts: Vec<f64> = unknowns
        .filter_map(|&unknown| {
            let unknown = unknown as usize;
            let entry = matrix.pattern().entry(unknown, unknown)?;
            Some(damping[unknown] / matrix.values()[entry])
        })
        .collect();
    let middle = parts.len() / 2;
    if parts.is_empty() {
        return 0.0;
    }
    *parts.select_nth_unstable_by(middle, f64::total_cmp).1
}
