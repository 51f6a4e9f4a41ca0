//! How bodies in a flow answer to loads: their mobility, and the change of the flow.

use nalgebra::DMatrix;

use super::error::SolveError;
use super::linear_system::Factorised;
use super::solution::Solution;
use super::system::FluidSystem;
use crate::algebra::{AffineConstraints, Term};
use crate::body::RigidVector;
use crate::timing::{Stage, Timing};

/// A load on a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyLoad {
    /// The body.
    pub body: usize,
    /// The load (N, N m).
    pub load: RigidVector,
}

impl<const D: usize> FluidSystem<D> {
    /// Velocities (m/s, rad/s) of some bodies by unit loads in each of their rigid motions, with the
    /// matrix last assembled: n m x n m for n bodies with m motions, zero for motions that are given.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn mobility(
        &mut self,
        constraints: &AffineConstraints,
        bodies: &[usize],
        timing: &mut Timing,
    ) -> Result<DMatrix<f64>, SolveError> {
        let n_modes = self.modes.len();
        let layout = self.layout;
        let raw = bodies.iter().flat_map(|&body| (0..n_modes).map(move |mode| (body, mode)));
        let rows: Vec<&[Term<u32>]> =
            raw.map(|(body, mode)| constraints.row(layout.rigid(body, mode))).collect();
        let mut masters: Vec<usize> =
            rows.iter().flat_map(|row| row.iter().map(|term| term.unknown as usize)).collect();
        masters.sort_unstable();
        masters.dedup();
        let Factorised { matrix, solver } = self.linear.factorised(timing)?;
        let inverse = timing.measure(Stage::Solve, || solver.inverse_of_dense(matrix, &masters))?;
        // Velocities by loads on the masters, one column each
        let inverse = DMatrix::from_column_slice(masters.len(), masters.len(), &inverse);
        let mut weights: DMatrix<f64> = DMatrix::zeros(rows.len(), masters.len());
        for (at, row) in rows.iter().enumerate() {
            for term in *row {
                if let Ok(column) = masters.binary_search(&(term.unknown as usize)) {
                    weights[(at, column)] += term.weight;
                }
            }
        }
        Ok(&weights * inverse * weights.transpose())
    }

    /// Adds to a solution what further loads (N, N m) on some bodies change, with the matrix last
    /// assembled.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn apply_body_loads(
        &mut self,
        constraints: &AffineConstraints,
        loads: &[BodyLoad],
        solution: &mut Solution<D>,
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        let mut change = vec![0.0; self.n_unknowns];
        for BodyLoad { body, load } in loads {
            for (position, mode) in self.modes.iter().enumerate() {
                for term in constraints.row(self.layout.rigid(*body, position)) {
                    change[term.unknown as usize] += term.weight * load[mode];
                }
            }
        }
        let Factorised { matrix, solver } = self.linear.factorised(timing)?;
        timing.measure(Stage::Solve, || solver.solve(matrix, &mut change))?;
        let mut free = constraints.pick(&self.pinned(solution).to_raw(self.modes));
        free.iter_mut().zip(&change).for_each(|(value, change)| *value += change);
        let raw = constraints.expand(&free);
        *solution = self.centered(Solution::from_raw(&self.layout, self.modes, &raw));
        Ok(())
    }
}
