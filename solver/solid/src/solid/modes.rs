//! Natural frequencies of a solid about a state, by subspace iteration.

use nalgebra::DMatrix;

use super::SolidError;
use super::build::Solid;
use super::potential::{Potential, norm};
use crate::material::Curvature;

/// Vectors iterated beyond those wanted: convergence is by the ratio to the first that is left out.
const MORE: usize = 6;

/// Iterations at most.
const N_ITERATIONS: usize = 200;

/// Relative change of the squares of the frequencies that ends the iteration.
const CONVERGED: f64 = 1e-12;

/// The same with pressures, whose solutions have fewer digits in thin bodies.
const CONVERGED_MIXED: f64 = 1e-8;

impl<const D: usize> Solid<D> {
    /// The lowest natural angular frequencies (rad/s) of small motions about a state under loads (N) on all
    /// components, ascending. Loads matter where parts are rigid: their torque changes as these turn.
    ///
    /// # Errors
    /// [`SolidError::Singular`] where the body can move as a rigid one, or the state is unstable;
    /// [`SolidError::TurnedOver`]; [`SolidError::NotConverged`].
    pub fn frequencies(
        &self,
        places: &[f64],
        targets: &[f64],
        loads: &[f64],
        count: usize,
    ) -> Result<Vec<f64>, SolidError> {
        let potential = Potential::at_rest(self, targets, loads);
        let turned_over = || SolidError::TurnedOver(self.turned_over(places).unwrap_or_default());
        let values = potential.curvature(places, Curvature::True, &[]).ok_or_else(turned_over)?;
        let factor = self.cholesky.factorise(&self.pattern, &values).ok_or(SolidError::Singular)?;
        let n = self.n_unknowns();
        // Each pressure takes a freedom away
        let n_modes = self.pattern.n_places.saturating_sub(self.pressures.count());
        let count = count.min(n_modes);
        let size = (count + MORE).min(n_modes);
        // Any start will do that is not orthogonal to a mode; the same each time
        let mut vectors: Vec<Vec<f64>> = (0..size)
            .map(|k| (0..n).map(|i| ((i * (k + 1)) as f64 * 0.618).sin()).collect())
            .collect();
        let mut last = vec![0.0; count];
        let converged = if self.pattern.is_mixed() { CONVERGED_MIXED } else { CONVERGED };
        for _ in 0..N_ITERATIONS {
            let masses: Vec<Vec<f64>> = vectors.iter().map(|v| self.free_mass(places, v)).collect();
            let mut solved = masses.clone();
            for vector in &mut solved {
                if !self.cholesky.solve(&self.pattern, &factor, vector) {
                    return Err(SolidError::Singular);
                }
            }
            let found = self.ritz(places, &solved, &masses)?;
            let now: Vec<f64> = found.values[..count].to_vec();
            vectors = found.vectors;
            let change =
                now.iter().zip(&last).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
            if change < converged {
                return Ok(now.iter().map(|square| square.sqrt()).collect());
            }
            last = now;
        }
        Err(SolidError::NotConverged {
            iterations: N_ITERATIONS,
            residual: norm(&last),
            scale: 1.0,
        })
    }

    fn free_mass(&self, places: &[f64], free: &[f64]) -> Vec<f64> {
        self.free(places, &self.mass.times(&self.all(places, free)))
    }

    /// The best approximations in a space of vectors, whose products with the stiffness are known.
    fn ritz(
        &self,
        places: &[f64],
        vectors: &[Vec<f64>],
        forces: &[Vec<f64>],
    ) -> Result<Ritz, SolidError> {
        let size = vectors.len();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let masses: Vec<Vec<f64>> = vectors.iter().map(|v| self.free_mass(places, v)).collect();
        let table = |right: &[Vec<f64>]| {
            let full = DMatrix::from_fn(size, size, |i, j| product(&vectors[i], &right[j]));
            (&full + full.transpose()) * 0.5
        };
        let cholesky = table(&masses).cholesky().ok_or(SolidError::Singular)?;
        let lower = cholesky.l();
        let inverse = lower.try_inverse().ok_or(SolidError::Singular)?;
        let eigen = (&inverse * table(forces) * inverse.transpose()).symmetric_eigen();
        let basis = inverse.transpose() * &eigen.eigenvectors;
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let combined = |k: &usize| -> Vec<f64> {
            let mut sum = vec![0.0; vectors[0].len()];
            for (i, vector) in vectors.iter().enumerate() {
                for (entry, value) in sum.iter_mut().zip(vector) {
                    *entry += basis[(i, *k)] * value;
                }
            }
            sum
        };
        Ok(Ritz {
            values: order.iter().map(|k| eigen.eigenvalues[*k]).collect(),
            vectors: order.iter().map(combined).collect(),
        })
    }
}

/// Squares of frequencies and their vectors, ascending.
struct Ritz {
    values: Vec<f64>,
    vectors: Vec<Vec<f64>>,
}
