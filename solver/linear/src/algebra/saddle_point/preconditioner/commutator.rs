//! `Commutator`: the least-squares commutator, an inverse of G^T F^-1 G for F with convection.
//!
//! Were there an F_p with F D^-1 G = G F_p, the inverse would be F_p (G^T D^-1 G)^-1. The one that comes nearest
//! to it by least squares gives L^-1 (G^T D^-1 F D^-1 G) L^-1 with L = G^T D^-1 G (@elman2006). D is the diagonal of
//! F: with the mass matrix in its place a sphere in a stream at a Reynolds number of ten takes 53 iterations for 46.

use super::super::matrix::{B, Gradient, Numbering};
use crate::multigrid::{BlockMatrix, HierarchySettings, Multigrid};

/// Degree of the smoothers of the Laplacian.
const SMOOTHING: usize = 2;

/// Approximate inverse of a Schur complement.
#[derive(Debug)]
pub(in super::super) struct Commutator {
    /// D^-1, zero for bodies and for what is no unknown.
    inverse_diagonal: Vec<[f32; B]>,
    gradient: Gradient,
    divergence: Gradient,
    laplacian: Multigrid<1>,
    velocity: Vec<[f32; B]>,
    image: Vec<[f32; B]>,
    pressure: Vec<f32>,
    rhs: Vec<[f32; 1]>,
}

impl Commutator {
    /// For a velocity block and a gradient.
    pub fn new(
        block: &BlockMatrix<B>,
        gradient: &Gradient,
        numbering: &Numbering,
        has_held_pressure: bool,
    ) -> Self {
        let gradient =
            if has_held_pressure { gradient.with_held_pressure() } else { gradient.clone() };
        let diagonal = diagonal(block, numbering);
        let laplacian = laplacian(&gradient, &diagonal[..numbering.n_nodes], has_held_pressure);
        let inverse = |value: f32| if value > 0.0 { 1.0 / value } else { 0.0 };
        let inverse_diagonal = diagonal.iter().map(|values| values.map(inverse)).collect();
        let velocity = vec![[0.0; B]; numbering.blocks.len()];
        let pressure = vec![0.0; gradient.n_pressures()];
        Self {
            inverse_diagonal,
            divergence: gradient.transposed(),
            gradient,
            laplacian,
            image: velocity.clone(),
            velocity,
            rhs: vec![[0.0]; pressure.len()],
            pressure,
        }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        self.gradient.n_bytes() + self.divergence.n_bytes() + self.laplacian.n_bytes()
    }

    /// Overwrites a solution with the inverse times a right-hand side, for the velocity block.
    pub fn solve(&mut self, block: &BlockMatrix<B>, rhs: &[[f32; 1]], solution: &mut [[f32; 1]]) {
        self.laplacian.cycle(rhs, solution);
        self.pressure.copy_from_slice(solution.as_flattened());
        self.velocity.fill([0.0; B]);
        self.gradient.multiply_add(&self.pressure, &mut self.velocity);
        scale(&mut self.velocity, &self.inverse_diagonal);
        block.multiply(&self.velocity, &mut self.image);
        scale(&mut self.image, &self.inverse_diagonal);
        self.divergence.multiply_transposed(&self.image, self.rhs.as_flattened_mut());
        self.laplacian.cycle(&self.rhs, solution);
    }
}

/// Multiplies each number by a factor of its own.
fn scale(vector: &mut [[f32; B]], factors: &[[f32; B]]) {
    for (value, factor) in vector.as_flattened_mut().iter_mut().zip(factors.as_flattened()) {
        *value *= factor;
    }
}

/// The diagonal of F, zero for bodies and for what is no unknown.
fn diagonal(block: &BlockMatrix<B>, numbering: &Numbering) -> Vec<[f32; B]> {
    let mut diagonal = vec![[0.0; B]; numbering.blocks.len()];
    for (row, unknowns) in numbering.blocks[..numbering.n_nodes].iter().enumerate() {
        let values = block.diagonal(row);
        diagonal[row] = std::array::from_fn(|a| unknowns[a].map_or(0.0, |_| values[a]));
    }
    diagonal
}

/// Multigrid for G^T D^-1 G over the nodes.
///
/// With a held pressure constants have no gradient.
pub(super) fn laplacian(
    gradient: &Gradient,
    diagonal: &[[f32; B]],
    has_held_pressure: bool,
) -> Multigrid<1> {
    let settings = HierarchySettings {
        n_pairs: 0,
        degree: SMOOTHING,
        is_singular: has_held_pressure,
        is_convective: false,
    };
    Multigrid::new(gradient.laplacian(diagonal), None, settings)
}
