//! `SchurComplement`: what stands for the inverse of G^T F^-1 G.
//!
//! Where viscosity dominates, the mass matrix of the pressures over twice the viscosity: the form has the
//! symmetric gradient. Where F is mostly density over time step, or drag in a gap, G^T D^-1 G with the
//! lumped D. The sum of both inverses serves all between (@cahouet1988).

use super::data::Weights;
use super::gradient::Gradient;
use super::numbering::{Numbering, Place};
use super::vector::B;
use crate::multigrid::{
    BlockMatrix, Chebyshev, Hierarchy, HierarchySettings, RowBuilder, Spectrum,
};
use crate::sparse::SparseMatrix;
use crate::sparse::single::single;

/// Eigenvalues of the mass matrix of linear elements over its diagonal, in the plane and in space
/// (@wathen1987).
const MASS_SPECTRUM: Spectrum = Spectrum::Between(0.5, 2.5);
/// Degree of the polynomial that takes the place of its inverse.
const MASS_DEGREE: usize = 4;
/// Degree of the smoothers of the Laplacian.
const SMOOTHING: usize = 2;

/// Approximate inverse of the Schur complement.
#[derive(Debug)]
pub(super) struct SchurComplement {
    mass: BlockMatrix<1>,
    mass_inverse: Chebyshev<1>,
    laplacian: Option<Hierarchy<1>>,
    has_held_pressure: bool,
    rhs: Vec<[f32; 1]>,
    solution: Vec<[f32; 1]>,
    part: Vec<[f32; 1]>,
}

impl SchurComplement {
    /// By the weights of a system with this gradient.
    pub fn new(
        weights: &Weights,
        gradient: &Gradient,
        numbering: &Numbering,
        has_held_pressure: bool,
    ) -> Self {
        let mass = single_precision(&weights.pressure_mass);
        let mass_inverse = Chebyshev::new(&mass, 0, MASS_SPECTRUM, MASS_DEGREE);
        let laplacian = weights.damping.as_ref().map(|damping| {
            let damping = by_blocks(damping, numbering);
            let matrix = gradient.laplacian(&damping, has_held_pressure);
            let settings =
                HierarchySettings { n_pairs: 0, degree: SMOOTHING, is_singular: has_held_pressure };
            Hierarchy::new(matrix, None, settings)
        });
        let empty = vec![[0.0]; mass.n_rows()];
        let [rhs, solution, part] = [empty.clone(), empty.clone(), empty];
        Self { mass, mass_inverse, laplacian, has_held_pressure, rhs, solution, part }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        self.mass.n_bytes() + self.laplacian.as_ref().map_or(0, Hierarchy::n_bytes)
    }

    /// Overwrites pressures p with the inverse times p.
    ///
    /// Where one more pressure is held, its equation is minus the sum of the others, and the pressures
    /// found for all are shifted to let it be zero.
    pub fn solve(&mut self, p: &mut [f32]) {
        for (rhs, value) in self.rhs.iter_mut().zip(p.iter()) {
            rhs[0] = *value;
        }
        if self.has_held_pressure {
            let sum: f64 = p.iter().map(|value| f64::from(*value)).sum();
            self.rhs[p.len()] = [single(-sum)];
        }
        self.mass_inverse.solve(&self.mass, &self.rhs, &mut self.solution);
        if let Some(laplacian) = &mut self.laplacian {
            laplacian.cycle(&self.rhs, &mut self.part);
            for (value, part) in self.solution.iter_mut().zip(&self.part) {
                value[0] += part[0];
            }
        }
        let level = if self.has_held_pressure { self.solution[p.len()][0] } else { 0.0 };
        for (value, solution) in p.iter_mut().zip(&self.solution) {
            *value = solution[0] - level;
        }
    }
}

/// A symmetric matrix in single precision.
fn single_precision(matrix: &SparseMatrix) -> BlockMatrix<1> {
    let pattern = matrix.pattern();
    let mut rows = RowBuilder::new(matrix.n());
    for column in 0..matrix.n() {
        for (&row, entry) in pattern.column(column).iter().zip(pattern.entries(column)) {
            rows.push(row, [[single(matrix.values()[entry])]]);
        }
        rows.end_row();
    }
    rows.build()
}

/// Numbers of the velocities at nodes by blocks, zero for what is no unknown.
fn by_blocks(values: &[f64], numbering: &Numbering) -> Vec<[f32; B]> {
    let mut blocks = vec![[0.0; B]; numbering.n_nodes];
    for (place, value) in numbering.places.iter().zip(values) {
        if let Place::Velocity { row, component } = *place
            && let Some(block) = blocks.get_mut(row as usize)
        {
            block[usize::from(component)] = single(*value);
        }
    }
    blocks
}
