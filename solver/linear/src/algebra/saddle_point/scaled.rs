//! `Scaled`: a saddle-point system with scaled rows and columns, in double and in single precision.

use std::borrow::Cow;

use super::super::vectors::norm;
use super::guess::EarlierSolutions;
use super::matrix::{Blocks, SaddleMatrix};
use super::preconditioner::Preconditioner;
use crate::sparse::single::single;

/// An approximation x of the solution of A x = b, and b - A x.
pub(super) struct Iterate {
    pub x: Vec<f64>,
    pub residual: Vec<f64>,
}

/// A system with its rows and columns scaled, by the preconditioner.
pub(super) struct Scaled<'a> {
    pub matrix: &'a SaddleMatrix,
    pub preconditioner: &'a mut Preconditioner,
}

impl Scaled<'_> {
    /// Overwrites y with A x in single precision.
    pub fn multiply(&mut self, x: &Blocks, y: &mut Blocks) {
        self.preconditioner.multiply(self.matrix, x, y);
    }

    /// Overwrites z with an approximation of A^-1 r.
    pub fn apply(&mut self, r: &Blocks, z: &mut Blocks) {
        self.preconditioner.apply(self.matrix, r, z);
    }

    /// A residual in the basis of the preconditioner.
    fn in_basis<'b>(&self, residual: &'b [f64]) -> Cow<'b, [f64]> {
        let Some(basis) = self.preconditioner.basis() else { return residual.into() };
        let mut changed = residual.to_vec();
        basis.change_loads(&mut changed);
        changed.into()
    }

    /// Euclidean norm of a residual.
    pub fn norm(&self, residual: &[f64]) -> f64 {
        let residual = self.in_basis(residual);
        let scales = self.preconditioner.scales();
        let places = self.matrix.numbering().places.iter();
        let scaled = residual.iter().zip(places).map(|(value, place)| value * scales.of(*place));
        norm(&scaled.collect::<Vec<f64>>())
    }

    /// Sum of the sizes of the residuals of pressures, with that of the one that is held: what all parts of the fluid
    /// gain or lose.
    pub fn mass(&self, residual: &[f64], has_held_pressure: bool) -> f64 {
        let pressures = || self.matrix.numbering().pressures.iter().map(|&p| residual[p as usize]);
        let held = if has_held_pressure { pressures().sum::<f64>().abs() } else { 0.0 };
        pressures().map(f64::abs).sum::<f64>() + held
    }

    /// The iterate with what is left of the part `reduction` of the residuals of pressures; none where the
    /// preconditioner has no means for it.
    pub fn without_divergence(
        &mut self,
        from: &Iterate,
        rhs: &[f64],
        size: f64,
        reduction: f64,
    ) -> Option<Iterate> {
        let residual = self.single(&from.residual, size);
        let mut correction = residual.zeros_alike();
        let matrix = self.matrix;
        self.preconditioner
            .divergence_correction(matrix, &residual, reduction, &mut correction)
            .then(|| self.corrected(from, rhs, size, &correction))
    }

    /// A residual of this size, as one of norm one in single precision.
    pub fn single(&self, residual: &[f64], size: f64) -> Blocks {
        let scales = self.preconditioner.scales();
        let residual = self.in_basis(residual);
        self.matrix
            .numbering()
            .split(&residual, |place, value| single(value * (scales.of(place) / size)))
    }

    /// The combination of earlier solutions with the least residual, for a right-hand side of this size.
    pub fn guess(&mut self, earlier: &EarlierSolutions, rhs: &[f64], size: f64) -> Blocks {
        let b = self.single(rhs, size);
        let image = |x: &mut Blocks, image: &mut Blocks| {
            if let Some(basis) = self.preconditioner.basis() {
                basis.change_velocities(&mut x.velocity);
            }
            self.preconditioner.scales().divide(x);
            self.multiply(x, image);
        };
        earlier.guess(image, &b)
    }

    /// The iterate with a correction for a residual of this size.
    pub fn corrected(
        &mut self,
        from: &Iterate,
        rhs: &[f64],
        size: f64,
        correction: &Blocks,
    ) -> Iterate {
        let mut unscaled = correction.clone();
        self.preconditioner.scales().multiply(&mut unscaled);
        let mut x = from.x.clone();
        match self.preconditioner.basis() {
            Some(basis) => {
                let mut change = vec![0.0; x.len()];
                self.matrix.numbering().add(size, &unscaled, &mut change);
                basis.restore_velocities(&mut change);
                x.iter_mut().zip(&change).for_each(|(x, change)| *x += change);
            }
            None => self.matrix.numbering().add(size, &unscaled, &mut x),
        }
        let mut residual = vec![0.0; x.len()];
        self.matrix.multiply(&x, &mut residual);
        for (residual, b) in residual.iter_mut().zip(rhs) {
            *residual = b - *residual;
        }
        Iterate { x, residual }
    }
}
