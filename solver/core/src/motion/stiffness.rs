//! The matrix of mesh motion on linear elements, with small cells made stiff.

use std::sync::Arc;

use alewife_mesh::{CellId, Mesh, NodeId};
use nalgebra::SVector;

use super::surface_distance::surface_distances;
use crate::algebra::{AffineConstraints, CellFolds, CellMaps, ConstraintBuilder, SparseMatrix};
use crate::space::{StraightCell, straight_cell};

/// The equation the displacement of the mesh solves; by default the one that lets a body go
/// farthest (measured in `tests/motion/reach.rs`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionKind {
    /// div (k grad d) = 0, component by component.
    Harmonic(Stiffening),
    /// Linear elasticity, div (k (lambda (div d) I + 2 mu D(d))) = 0, with mu = 1.
    Elastic {
        /// Poisson's ratio (plane strain), below 0.5.
        poisson: f64,
        /// The factor k of each cell.
        stiffening: Stiffening,
    },
}

impl Default for MotionKind {
    fn default() -> Self {
        Self::Elastic { poisson: 0.0, stiffening: Stiffening::Distance { exponent: 0.5 } }
    }
}

impl MotionKind {
    /// The one around bodies that deform in space: with it one mesh follows a thin tail through its beat (measured in
    /// `tests/spatial/deforming.rs`).
    ///
    /// With k = d^-a a displacement decays from an end of radius r as int d^a / (r + d)^2 dd: for a = 1/2 within a
    /// radius, which is too fast where the end moves by many radii, for a = 2 evenly.
    #[must_use]
    pub fn around_deforming_bodies() -> Self {
        Self::Elastic { poisson: 0.0, stiffening: Stiffening::Distance { exponent: 2.0 } }
    }
}

/// How much stiffer cells are that are small or near a body: the factor k of a cell of measure V
/// with its centre at distance d from what carries the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stiffening {
    /// k = 1.
    None,
    /// k = 1 + (1 - Vmin / Vmax) / (V / Vmax).
    ///
    /// # Source
    /// @masud1997.
    MasudHughes,
    /// k = (Vmax / V)^exponent.
    ///
    /// # Source
    /// @stein2003, Jacobian-based stiffening.
    Jacobian {
        /// Power of the relative measure.
        exponent: f64,
    },
    /// k = (dmax / d)^exponent, which does not depend on how the mesh is graded.
    Distance {
        /// Power of the relative distance.
        exponent: f64,
    },
}

impl Stiffening {
    /// The factor of each cell, from their measures (m^D) and distances (m).
    fn factors(self, measures: &[f64], distances: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
        let largest = measures.iter().copied().fold(0.0, f64::max);
        let smallest = measures.iter().copied().fold(f64::INFINITY, f64::min);
        let by_measure =
            |factor: &dyn Fn(f64) -> f64| measures.iter().map(|v| factor(*v)).collect();
        match self {
            Self::None => vec![1.0; measures.len()],
            Self::MasudHughes => by_measure(&|v| 1.0 + (1.0 - smallest / largest) / (v / largest)),
            Self::Jacobian { exponent } => by_measure(&|v| (largest / v).powf(exponent)),
            Self::Distance { exponent } => {
                let distances = distances();
                let farthest = distances.iter().copied().fold(0.0, f64::max);
                // Where nothing carries the mesh, all is equally far
                let factor =
                    |d: &f64| if d.is_finite() { (farthest / d).powf(exponent) } else { 1.0 };
                distances.iter().map(factor).collect()
            }
        }
    }
}

/// The raw matrix on the vertices, boundary vertices included.
#[derive(Debug)]
pub(super) struct Stiffness {
    /// Unknowns a vertex: 1 when the components do not know each other.
    pub n_components: usize,
    /// Raw unknowns of each cell.
    raw: Vec<u32>,
    /// Matrix of each cell, row by row.
    cells: Vec<f64>,
    /// The sum of all cells.
    matrix: SparseMatrix,
}

impl Stiffness {
    /// Assembles the matrix of a mesh that is carried by some vertices.
    pub fn new<const D: usize>(
        mesh: &Mesh<D>,
        kind: MotionKind,
        carrying: impl Iterator<Item = NodeId>,
    ) -> Self {
        let (n_components, stiffening) = match kind {
            MotionKind::Harmonic(stiffening) => (1, stiffening),
            MotionKind::Elastic { stiffening, .. } => (D, stiffening),
        };
        let geometry: Vec<_> = mesh.cell_ids().map(|cell| straight_cell(mesh, cell)).collect();
        let measures: Vec<f64> = geometry.iter().map(|cell| cell.measure).collect();
        let factors = stiffening.factors(&measures, || surface_distances(mesh, carrying));
        let n_local = (D + 1) * n_components;
        let mut raw = Vec::with_capacity(n_local * mesh.n_cells());
        let mut cells = vec![0.0; n_local * n_local * mesh.n_cells()];
        for (cell, StraightCell { measure, gradients }) in geometry.iter().enumerate() {
            for &vertex in mesh.cell_vertices(CellId::new(cell)) {
                let first = vertex.index() * n_components;
                raw.extend((first..first + n_components).map(raw_unknown));
            }
            let matrix = &mut cells[cell * n_local * n_local..(cell + 1) * n_local * n_local];
            let weight = measure * factors[cell];
            match kind {
                MotionKind::Harmonic(_) => harmonic_cell(gradients, weight, matrix),
                MotionKind::Elastic { poisson, .. } => {
                    let lambda = 2.0 * poisson / (1.0 - 2.0 * poisson);
                    elastic_cell(gradients, weight, lambda, matrix);
                }
            }
        }
        let free = ConstraintBuilder::new(mesh.n_vertices * n_components).build();
        let matrix = sum_of_cells(&raw, &cells, &free, n_local);
        Self { n_components, raw, cells, matrix }
    }

    /// P^T K P.
    pub fn reduce<const D: usize>(&self, constraints: &AffineConstraints) -> SparseMatrix {
        sum_of_cells(&self.raw, &self.cells, constraints, (D + 1) * self.n_components)
    }

    /// -P^T K g for raw values g, most of which are zero.
    pub fn load(&self, constraints: &AffineConstraints, given: &[f64]) -> Vec<f64> {
        let mut load = vec![0.0; given.len()];
        // The columns of a symmetric matrix are its rows
        for (column, &value) in given.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            let pattern = self.matrix.pattern();
            let entries = &self.matrix.values()[pattern.entries(column)];
            for (&row, entry) in pattern.row(column).iter().zip(entries) {
                load[row as usize] -= entry * value;
            }
        }
        constraints.restrict(&load)
    }
}

/// A raw unknown as maps of cells store it.
fn raw_unknown(unknown: usize) -> u32 {
    u32::try_from(unknown).expect("indices of unknowns take at most 32 bits")
}

/// P^T K P, K the sum of the matrices of all cells, by the raw unknowns of each.
fn sum_of_cells(
    raw: &[u32],
    cells: &[f64],
    constraints: &AffineConstraints,
    n_local: usize,
) -> SparseMatrix {
    let folds = CellFolds::new(n_local, raw.to_vec(), constraints);
    let maps = CellMaps::new(&folds.unknowns(constraints), |_, _| true);
    let mut values = vec![0.0; maps.pattern().n_entries()];
    let mut folded = vec![0.0; folds.largest_matrix()];
    // The matrices are symmetric: rows are columns.
    for (cell, matrix) in cells.chunks_exact(n_local * n_local).enumerate() {
        if folds.is_folded(cell) {
            folds.fold(cell, constraints, matrix, &mut folded);
            maps.scatter(cell, &folded, &mut values);
        } else {
            maps.scatter(cell, matrix, &mut values);
        }
    }
    SparseMatrix::new(Arc::clone(maps.pattern()), values)
}

fn harmonic_cell<const D: usize>(gradients: &[SVector<f64, D>], weight: f64, matrix: &mut [f64]) {
    let n = gradients.len();
    for a in 0..n {
        for b in 0..n {
            matrix[a * n + b] = weight * gradients[a].dot(&gradients[b]);
        }
    }
}

fn elastic_cell<const D: usize>(
    gradients: &[SVector<f64, D>],
    weight: f64,
    lambda: f64,
    matrix: &mut [f64],
) {
    let n = gradients.len() * D;
    for (a, row) in gradients.iter().enumerate() {
        for (b, column) in gradients.iter().enumerate() {
            let shear = row.dot(column);
            for i in 0..D {
                for j in 0..D {
                    let mut entry = lambda * row[i] * column[j] + row[j] * column[i];
                    if i == j {
                        entry += shear;
                    }
                    matrix[(a * D + i) * n + b * D + j] = weight * entry;
                }
            }
        }
    }
}
