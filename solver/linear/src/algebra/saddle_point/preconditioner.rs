//! `Preconditioner`: the matrix in single precision, and the upper block-triangular matrix [F G; 0 -S] with approximate inverses of F and S.

use std::sync::Arc;

use super::blocks::{transfer, velocity_block};
use super::damping::damping_at_nodes;
use super::data::{SaddlePoint, Weights};
use super::gradient::Gradient;
use super::numbering::Numbering;
use super::scales::Scales;
use super::schur::SchurComplement;
use super::vector::{B, Blocks};
use crate::multigrid::{
    BlockMatrix, Chebyshev, Hierarchy, HierarchySettings, Spectrum, Upwinded, upwinded,
};
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
/// Part of the diagonal of the upwinded F that is upwinding, from which convection decides how pressures are
/// found in steady flow.
const CONVECTIVE: f64 = 1e-3;

/// A saddle-point matrix in single precision with an approximate inverse.
#[derive(Debug)]
pub(super) struct Preconditioner {
    /// F.
    block: Arc<BlockMatrix<B>>,
    velocity: VelocitySolver,
    gradient: Gradient,
    divergence: Gradient,
    schur: SchurComplement,
    scales: Scales,
    scaled: Blocks,
}

/// What takes the place of F^-1.
#[derive(Debug)]
enum VelocitySolver {
    /// Where derivatives dominate.
    Cycle(Hierarchy<B>),
    /// Where density over time step does: F is nearly a mass matrix.
    Polynomial(Box<Chebyshev<B>>),
}

impl Preconditioner {
    /// For a matrix of this system.
    pub fn new(
        system: &SaddlePoint,
        numbering: &Numbering,
        weights: &Weights,
        matrix: &SparseMatrix,
    ) -> Self {
        let block = Arc::new(velocity_block(matrix, numbering));
        let n_pairs = numbering.n_bodies;
        let is_dominated = damped_part(weights, numbering, matrix) > DOMINANT;
        let smooth = smooth_block(&block, n_pairs, weights.has_convection && !is_dominated);
        let is_convective = smooth.part > CONVECTIVE;
        let is_commutator = is_convective && weights.inertia == 0.0;
        // Of the Laplacian of the pressures, where there is one
        let mut damping = Vec::new();
        let velocity = if is_dominated {
            let inertia = numbering.split(&weights.lumped_mass, |_| weights.inertia);
            damping.extend_from_slice(&inertia.velocity[..numbering.n_nodes]);
            let chebyshev = Chebyshev::new(&block, n_pairs, SPECTRUM, DEGREE);
            VelocitySolver::Polynomial(Box::new(chebyshev))
        } else {
            let transfer = transfer(&weights.interpolation, numbering);
            if !is_commutator {
                damping = damping_at_nodes(&smooth.matrix, &transfer, numbering, weights);
            }
            let settings = HierarchySettings {
                n_pairs,
                degree: SMOOTHING,
                is_singular: false,
                is_convective: weights.has_convection,
            };
            VelocitySolver::Cycle(Hierarchy::new(smooth.matrix, Some(transfer), settings))
        };
        let gradient = Gradient::new(matrix, numbering);
        let has_held_pressure = system.has_held_pressure;
        let schur = if is_commutator {
            SchurComplement::convective(&block, &gradient, numbering, has_held_pressure)
        } else {
            SchurComplement::new(weights, &gradient, &damping, has_held_pressure)
        };
        let divergence = gradient.transposed();
        let scales = Scales::new(matrix, numbering);
        let scaled = Blocks::zeros(numbering.blocks.len(), numbering.pressures.len());
        Self { block, velocity, gradient, divergence, schur, scales, scaled }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        let velocity = match &self.velocity {
            VelocitySolver::Cycle(hierarchy) => hierarchy.n_bytes(),
            VelocitySolver::Polynomial(_) => self.block.n_bytes(),
        };
        velocity + 2 * self.gradient.n_bytes() + self.schur.n_bytes()
    }

    /// The factors of rows and columns.
    pub fn scales(&self) -> &Scales {
        &self.scales
    }

    /// Overwrites y with S A S x, with S the diagonal matrix of the scales.
    pub fn multiply(&mut self, x: &Blocks, y: &mut Blocks) {
        let Self { block, gradient, divergence, scales, scaled, .. } = self;
        scaled.clone_from(x);
        scales.multiply(scaled);
        block.multiply(&scaled.velocity, &mut y.velocity);
        gradient.multiply_add(&scaled.pressure, &mut y.velocity);
        divergence.multiply_transposed(&scaled.velocity, &mut y.pressure);
        scales.multiply(y);
    }

    /// Overwrites z with S^-1 M^-1 S^-1 r for the approximation M of the matrix.
    pub fn apply(&mut self, r: &Blocks, z: &mut Blocks) {
        let Self { block, velocity, gradient, schur, scales, scaled, .. } = self;
        scaled.clone_from(r);
        scales.divide(scaled);
        z.pressure.copy_from_slice(&scaled.pressure);
        schur.solve(&mut z.pressure);
        gradient.multiply_add(&z.pressure, &mut scaled.velocity);
        z.pressure.iter_mut().for_each(|value| *value = -*value);
        match velocity {
            VelocitySolver::Cycle(hierarchy) => hierarchy.cycle(&scaled.velocity, &mut z.velocity),
            VelocitySolver::Polynomial(chebyshev) => {
                chebyshev.solve(block, &scaled.velocity, &mut z.velocity);
            }
        }
        scales.divide(z);
    }
}

/// What stands for F in the cycles.
struct SmoothBlock {
    matrix: Arc<BlockMatrix<B>>,
    /// Part of its diagonal that is upwinding.
    part: f64,
}

fn smooth_block(block: &Arc<BlockMatrix<B>>, n_pairs: usize, has_convection: bool) -> SmoothBlock {
    if !has_convection {
        return SmoothBlock { matrix: Arc::clone(block), part: 0.0 };
    }
    let Upwinded { matrix, part } = upwinded(block, n_pairs);
    tracing::debug!(part, "upwinded");
    SmoothBlock { matrix: Arc::new(matrix), part }
}

/// Median over the velocities at nodes of what is no derivative in the diagonal of F.
fn damped_part(weights: &Weights, numbering: &Numbering, matrix: &SparseMatrix) -> f64 {
    if weights.inertia == 0.0 {
        return 0.0;
    }
    let unknowns = numbering.blocks[..numbering.n_nodes].iter().flatten().flatten();
    let mut parts: Vec<f64> = unknowns
        .filter_map(|&unknown| {
            let unknown = unknown as usize;
            let entry = matrix.pattern().entry(unknown, unknown)?;
            Some(weights.inertia * weights.lumped_mass[unknown] / matrix.values()[entry])
        })
        .collect();
    let middle = parts.len() / 2;
    if parts.is_empty() {
        return 0.0;
    }
    *parts.select_nth_unstable_by(middle, f64::total_cmp).1
}
