//! `SchurComplement`: what stands for the inverse of G^T F^-1 G.
//!
//! Where viscosity dominates, the mass matrix of the pressures over twice the viscosity: the form has the
//! symmetric gradient. Where F is mostly density over time step, or drag in a gap, G^T D^-1 G with the
//! lumped D. The sum of both inverses serves all between (@cahouet1988). Where convection is more than
//! diffusion in steady flow, the least-squares commutator.

use super::super::conjugate_gradients::conjugate_gradients;
use super::super::data::Weights;
use super::super::matrix::{B, Gradient, Numbering};
use super::commutator::{Commutator, laplacian};
use crate::multigrid::{BlockMatrix, Chebyshev, Multigrid, RowBuilder, Spectrum};
use crate::sparse::SparseMatrix;
use crate::sparse::single::single;

/// Eigenvalues of the mass matrix of linear elements over its diagonal, in the plane and in space
/// (@wathen1987).
const MASS_SPECTRUM: Spectrum = Spectrum::Between(0.5, 2.5);
/// Degree of the polynomial that takes the place of its inverse.
const MASS_DEGREE: usize = 4;

/// Approximate inverse of the Schur complement.
#[derive(Debug)]
pub(super) struct SchurComplement {
    inverse: Inverse,
    has_held_pressure: bool,
    rhs: Vec<[f32; 1]>,
    solution: Vec<[f32; 1]>,
}

#[derive(Debug)]
enum Inverse {
    Masses(Box<Masses>),
    /// Where convection is more than diffusion and flow is steady.
    Commutator(Box<Commutator>),
}

impl SchurComplement {
    /// By the weights of a system with this gradient, and what the Laplacian is damped by at each node.
    pub fn new(
        weights: &Weights,
        gradient: &Gradient,
        damping: &[[f32; B]],
        has_held_pressure: bool,
    ) -> Self {
        let masses = Masses::new(weights, gradient, damping, has_held_pressure);
        let n = masses.mass.n_rows();
        Self::with(Inverse::Masses(Box::new(masses)), n, has_held_pressure)
    }

    /// For a velocity block in which convection is more than diffusion, in steady flow.
    pub fn convective(
        block: &BlockMatrix<B>,
        gradient: &Gradient,
        numbering: &Numbering,
        has_held_pressure: bool,
    ) -> Self {
        let commutator = Commutator::new(block, gradient, numbering, has_held_pressure);
        let n = numbering.pressures.len() + usize::from(has_held_pressure);
        Self::with(Inverse::Commutator(Box::new(commutator)), n, has_held_pressure)
    }

    fn with(inverse: Inverse, n: usize, has_held_pressure: bool) -> Self {
        let rhs = vec![[0.0]; n];
        Self { inverse, has_held_pressure, solution: rhs.clone(), rhs }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        match &self.inverse {
            Inverse::Masses(masses) => masses.n_bytes(),
            Inverse::Commutator(commutator) => commutator.n_bytes(),
        }
    }

    /// Overwrites pressures p with the inverse times p, for the velocity block.
    ///
    /// Where one more pressure is held, its equation is minus the sum of the others, and the pressures
    /// found for all are shifted to let it be zero.
    pub fn solve(&mut self, block: &BlockMatrix<B>, p: &mut [f32]) {
        self.take(p);
        match &mut self.inverse {
            Inverse::Masses(masses) => masses.solve(&self.rhs, &mut self.solution),
            Inverse::Commutator(commutator) => {
                commutator.solve(block, &self.rhs, &mut self.solution);
            }
        }
        self.give(p);
    }

    /// Overwrites pressures p with q where G^T D^-1 G q = p to a part `reduction` of p, with the lumped D. Whether
    /// there is such a matrix.
    pub fn solve_lumped(&mut self, p: &mut [f32], reduction: f64) -> bool {
        self.take(p);
        let Inverse::Masses(masses) = &mut self.inverse else { return false };
        let Some(laplacian) = &mut masses.laplacian else { return false };
        conjugate_gradients(laplacian, &self.rhs, &mut self.solution, reduction);
        self.give(p);
        true
    }

    /// Right-hand sides from those of pressures: that of the one that is held is minus their sum.
    fn take(&mut self, p: &[f32]) {
        for (rhs, value) in self.rhs.iter_mut().zip(p) {
            rhs[0] = *value;
        }
        if self.has_held_pressure {
            let sum: f64 = p.iter().map(|value| f64::from(*value)).sum();
            self.rhs[p.len()] = [single(-sum)];
        }
    }

    /// Overwrites pressures with the solution, in which the one that is held is zero.
    fn give(&self, p: &mut [f32]) {
        let level = if self.has_held_pressure { self.solution[p.len()][0] } else { 0.0 };
        for (value, solution) in p.iter_mut().zip(&self.solution) {
            *value = solution[0] - level;
        }
    }
}

/// Mass matrix and Laplacian of the pressures.
#[derive(Debug)]
struct Masses {
    mass: BlockMatrix<1>,
    mass_inverse: Chebyshev<1>,
    /// None where nothing but differences damps velocities.
    laplacian: Option<Multigrid<1>>,
    part: Vec<[f32; 1]>,
}

impl Masses {
    fn new(
        weights: &Weights,
        gradient: &Gradient,
        damping: &[[f32; B]],
        has_held_pressure: bool,
    ) -> Self {
        let mass = single_precision(&weights.pressure_mass);
        let mass_inverse = Chebyshev::new(&mass, 0, MASS_SPECTRUM, MASS_DEGREE);
        let held = has_held_pressure.then(|| gradient.with_held_pressure());
        let gradient = held.as_ref().unwrap_or(gradient);
        let is_damped = damping.as_flattened().iter().any(|damping| *damping > 0.0);
        let laplacian = is_damped.then(|| laplacian(gradient, damping, has_held_pressure));
        let part = vec![[0.0]; mass.n_rows()];
        Self { mass, mass_inverse, laplacian, part }
    }

    fn n_bytes(&self) -> usize {
        self.mass.n_bytes() + self.laplacian.as_ref().map_or(0, Multigrid::n_bytes)
    }

    fn solve(&mut self, rhs: &[[f32; 1]], solution: &mut [[f32; 1]]) {
        self.mass_inverse.solve(&self.mass, rhs, solution);
        let Some(laplacian) = &mut self.laplacian else { return };
        laplacian.cycle(rhs, &mut self.part);
        for (value, part) in solution.iter_mut().zip(&self.part) {
            value[0] += part[0];
        }
    }
}

/// A symmetric matrix in single precision.
fn single_precision(matrix: &SparseMatrix) -> BlockMatrix<1> {
    let pattern = matrix.pattern();
    let mut rows = RowBuilder::new(matrix.n());
    for row in 0..matrix.n() {
        for (&column, entry) in pattern.row(row).iter().zip(pattern.entries(row)) {
            rows.push(column, [[single(matrix.values()[entry])]]);
        }
        rows.end_row();
    }
    rows.build()
}
