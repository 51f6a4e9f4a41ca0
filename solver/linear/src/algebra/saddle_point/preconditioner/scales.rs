//! `Scales`: factors of rows and columns that make all equations weigh the same.

use super::super::matrix::{B, Blocks, Gradient, Place};
use crate::multigrid::BlockMatrix;

/// Factors of rows and columns, one for each unknown.
///
/// Those of velocities are 1 / sqrt(f) with f their diagonal in F, those of pressures 1 / sqrt(s) with s
/// their diagonal in G^T diag(F)^-1 G. Squares of scaled residuals are powers then, whatever the units and
/// however much cells differ in size: the Euclidean norm is close to the one in which the error of the
/// solution is the energy that it dissipates (@elman2014, chapter 4).
#[derive(Debug)]
pub(in super::super) struct Scales {
    factors: Blocks,
}

impl Scales {
    /// For a matrix with these blocks F and G.
    pub fn new(block: &BlockMatrix<B>, gradient: &Gradient) -> Self {
        let mut factors = Blocks::zeros(block.n_rows(), gradient.n_pressures());
        let Blocks { velocity, pressure } = &mut factors;
        for (row, factors) in velocity.iter_mut().enumerate() {
            *factors = block.diagonal(row).map(inverse_root);
            for entry in gradient.entries(row) {
                let of_entry = &mut pressure[gradient.pressures()[entry] as usize];
                let values = gradient.values()[entry];
                *of_entry += (0..B).map(|a| (values[a] * factors[a]).powi(2)).sum::<f32>();
            }
        }
        pressure.iter_mut().for_each(|sum| *sum = inverse_root(*sum));
        Self { factors }
    }

    /// The factor of an unknown.
    pub fn of(&self, place: Place) -> f64 {
        f64::from(self.factors.at(place))
    }

    /// Multiplies all values by their factors.
    pub fn multiply(&self, vector: &mut Blocks) {
        vector.combine(&self.factors, |value, factor| value * factor);
    }

    /// Divides all values by their factors.
    pub fn divide(&self, vector: &mut Blocks) {
        vector.combine(&self.factors, |value, factor| value / factor);
    }
}

/// The inverse of the square root; one where there is none.
fn inverse_root(value: f32) -> f32 {
    let root = value.abs().sqrt();
    if root.is_normal() { 1.0 / root } else { 1.0 }
}
