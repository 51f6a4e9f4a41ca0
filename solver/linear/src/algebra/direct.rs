//! `DirectSolver`: sparse LU with iterative refinement, and earlier factors as a preconditioner.
//!
//! Factors outlive the matrix they belong to. A matrix that has not changed is solved with them as
//! they are; one that has changed a little, by FGMRES with them as preconditioner, where that is
//! cheaper than factorising it. Costs are counts of operations and rates of convergence, never times
//! on a clock: the same input has to give the same bits.

use std::sync::Arc;

use alewife_interrupt::{check, left_alone};

use super::fingerprint::{Fingerprints, hash_of_values};
use super::krylov::{KrylovSolution, Stopping, fgmres};
use super::memory::{ForeignMemory, SolverMemory};
use super::reuse::ReusePolicy;
use super::solver::{Accuracy, LinearError, LinearSolver};
use super::vectors::{combine, norm};
use crate::multifrontal::{Analysis, Factors, Ordering};
use crate::sparse::{Pattern, Residual, SparseMatrix, Unknowns};

/// Most refinement steps of one solve.
const MAX_REFINEMENTS: usize = 3;
/// Residual, relative to |A| |x| + |b|, that refinement cannot reduce any further.
const ROUNDING: f64 = 1e-14;
/// Residual, relative to |A| |x| + |b|, above which a solution is refused.
const MAX_RESIDUAL: f64 = 1e-6;
/// Largest entry of a right-hand side that counts as zero: what its solution leaves would have fewer digits
/// than that, for numbers below 2e-308 have. Where all bodies rest, each system takes sixteen digits off the
/// rounding that the one before has left.
const NOTHING: f64 = 1e-250;
/// Residual of FGMRES relative to the terms of the equations: far below what a step of any method
/// leaves of the error in time and space.
const KRYLOV_TOLERANCE: f64 = 1e-12;

/// Unknowns from which on it takes long to order them.
const MANY_UNKNOWNS: usize = 100_000;

/// The values that were factorised.
#[derive(Debug, Clone)]
struct Factorised {
    hash: u64,
    values: Vec<f64>,
}

/// A factorisation with everything needed to solve with it.
#[derive(Debug)]
pub struct DirectSolver {
    analysis: Analysis,
    factors: Factors,
    policy: ReusePolicy,
    /// What was factorised, if there are factors.
    factorised: Option<Factorised>,
    /// What it was at the mark, if it is another one now.
    marked: Option<Option<Factorised>>,
    /// The pauses of the policy at the mark.
    marked_pauses: [usize; 2],
    fingerprints: Fingerprints,
}

impl DirectSolver {
    /// Orders the unknowns of a pattern and finds the fill of its factors.
    ///
    /// # Errors
    /// When the work of this thread is to end before that is done.
    ///
    /// # Panics
    /// When `unknowns` does not fit the pattern.
    pub fn new(pattern: &Arc<Pattern>, unknowns: &Unknowns) -> Result<Self, LinearError> {
        let analysis = if pattern.n() < MANY_UNKNOWNS {
            Analysis::new(pattern, unknowns, Ordering::Best)
        } else {
            let (pattern, unknowns) = (Arc::clone(pattern), unknowns.clone());
            left_alone(move || Analysis::new(&pattern, &unknowns, Ordering::Best))?
        };
        let factors = Factors::new(&analysis);
        let policy = ReusePolicy::new(&analysis, pattern.n_entries());
        let marked_pauses = policy.pauses();
        Ok(Self {
            analysis,
            factors,
            policy,
            factorised: None,
            marked: None,
            marked_pauses,
            fingerprints: Fingerprints::default(),
        })
    }

    /// Entries of the factors of any matrix of the pattern, but for delayed pivots.
    #[must_use]
    pub fn n_factor_entries(&self) -> usize {
        self.factors.n_entries(&self.analysis)
    }

    /// Marks what it keeps at present as its memory, which may be asked for later.
    pub fn mark(&mut self) {
        self.marked = None;
        self.marked_pauses = self.policy.pauses();
    }

    /// What it kept from system to system when that was marked.
    #[must_use]
    pub fn memory(&self) -> SolverMemory {
        let factorised = self.marked.as_ref().unwrap_or(&self.factorised);
        SolverMemory {
            factorised: factorised.as_ref().map(|factorised| factorised.values.clone()),
            pauses: self.marked_pauses,
            ..SolverMemory::default()
        }
    }

    /// Goes on as the solver, of the same pattern and unknowns, whose memory it is.
    ///
    /// # Errors
    /// When it is the memory of another system, or its matrix cannot be factorised.
    pub fn recall(
        &mut self,
        pattern: &Arc<Pattern>,
        memory: &SolverMemory,
    ) -> Result<(), LinearError> {
        self.policy.set_pauses(memory.pauses);
        if let Some(values) = &memory.factorised {
            if values.len() != pattern.n_entries() {
                return Err(ForeignMemory { n_unknowns: pattern.n() }.into());
            }
            self.set_up(&SparseMatrix::new(Arc::clone(pattern), values.clone()))?;
        }
        self.mark();
        Ok(())
    }

    /// FGMRES with the factors at hand, for equations scaled by `scales`, until the residual of the
    /// scaled equations is at most `tolerance`.
    fn iterate(
        &mut self,
        matrix: &SparseMatrix,
        scales: &[f64],
        scaled_rhs: &[f64],
        tolerance: f64,
    ) -> KrylovSolution {
        let multiply = |x: &[f64], y: &mut [f64]| {
            matrix.multiply(x, y);
            combine(y, scales, |value, scale| value * scale);
        };
        let (factors, analysis) = (&mut self.factors, &self.analysis);
        let precondition = |r: &[f64], z: &mut [f64]| {
            z.copy_from_slice(r);
            combine(z, scales, |value, scale| value / scale);
            factors.solve(analysis, z);
        };
        let stopping = Stopping { tolerance, max_iterations: self.policy.affordable_iterations() };
        fgmres(multiply, precondition, scaled_rhs, stopping)
    }
}

impl DirectSolver {
    /// Hash of the values that are factorised.
    fn hash(&self) -> Option<u64> {
        self.factorised.as_ref().map(|factorised| factorised.hash)
    }

    fn hash_of(&mut self, matrix: &SparseMatrix) -> u64 {
        let hash = || hash_of_values(matrix.values(), |value| value.to_bits());
        self.fingerprints.hash_of(matrix.revision(), hash)
    }

    /// Overwrites a right-hand side with the solution for the transpose of the matrix of the last set-up.
    ///
    /// # Errors
    /// As [`LinearSolver::solve`].
    pub fn solve_transposed(
        &mut self,
        matrix: &SparseMatrix,
        rhs: &mut [f64],
    ) -> Result<Accuracy, LinearError> {
        self.refined(rhs, Factors::solve_transposed, |x, b| matrix.transposed_residual(x, b))
    }

    /// Whether the factors at hand are those of a matrix.
    pub fn has_factors_of(&mut self, matrix: &SparseMatrix) -> bool {
        self.factorised.is_some() && self.hash() == Some(self.hash_of(matrix))
    }

    /// Overwrites a right-hand side with its solution by one substitution with the factors at hand, whatever matrix they
    /// are of; false where there are none.
    pub fn substitute(&mut self, rhs: &mut [f64]) -> bool {
        if self.factorised.is_some() {
            self.factors.solve(&self.analysis, rhs);
        }
        self.factorised.is_some()
    }

    /// Solves by a substitution, in place, and refines by what is left of the right-hand side.
    fn refined(
        &mut self,
        rhs: &mut [f64],
        substitute: impl Fn(&mut Factors, &Analysis, &mut [f64]),
        residual: impl Fn(&[f64], &[f64]) -> Residual,
    ) -> Result<Accuracy, LinearError> {
        if !all_finite(rhs) {
            return Err(LinearError::NotFinite);
        }
        if rhs.iter().all(|value| value.abs() < NOTHING) {
            rhs.fill(0.0);
            return Ok(Accuracy::default());
        }
        let b = rhs.to_vec();
        substitute(&mut self.factors, &self.analysis, rhs);
        let mut accuracy = Accuracy { residual: f64::INFINITY, refinements: 0 };
        loop {
            let mut residual = residual(rhs, &b);
            let relative = residual.relative();
            if relative.is_nan() || !all_finite(rhs) {
                return Err(LinearError::NotFinite);
            }
            // Refinement that no longer helps has reached rounding.
            let is_stagnant = relative > 0.5 * accuracy.residual;
            accuracy.residual = accuracy.residual.min(relative);
            if is_stagnant || relative <= ROUNDING || accuracy.refinements == MAX_REFINEMENTS {
                break;
            }
            accuracy.refinements += 1;
            check()?;
            substitute(&mut self.factors, &self.analysis, &mut residual.defect);
            for (value, correction) in rhs.iter_mut().zip(&residual.defect) {
                *value += correction;
            }
        }
        tracing::debug!(accuracy.residual, accuracy.refinements, "solved");
        if accuracy.residual > MAX_RESIDUAL {
            return Err(LinearError::Inaccurate { residual: accuracy.residual });
        }
        Ok(accuracy)
    }
}

impl LinearSolver for DirectSolver {
    type Matrix = SparseMatrix;

    fn set_up(&mut self, matrix: &SparseMatrix) -> Result<(), LinearError> {
        let hash = self.hash_of(matrix);
        if self.hash() == Some(hash) {
            return Ok(());
        }
        let earlier = self.factorised.take();
        self.marked.get_or_insert(earlier);
        if !all_finite(matrix.values()) {
            return Err(LinearError::NotFinite);
        }
        self.factors.factorise(&self.analysis, matrix)?;
        tracing::debug!(
            delayed_fronts = self.factors.n_delayed_fronts(),
            delayed_pivots = self.factors.n_delayed_pivots(),
            entries = self.factors.n_entries(&self.analysis),
            "factorised"
        );
        self.factorised = Some(Factorised { hash, values: matrix.values().to_vec() });
        Ok(())
    }

    fn solve(&mut self, matrix: &SparseMatrix, rhs: &mut [f64]) -> Result<Accuracy, LinearError> {
        self.refined(rhs, Factors::solve, |x, b| matrix.residual(x, b))
    }

    fn solve_with_earlier_set_up(
        &mut self,
        matrix: &SparseMatrix,
        rhs: &mut [f64],
        typical: &[f64],
    ) -> Result<bool, LinearError> {
        if !all_finite(rhs) || !all_finite(typical) {
            return Err(LinearError::NotFinite);
        }
        let Some(factorised) = self.hash() else { return Ok(false) };
        if factorised == self.hash_of(matrix) {
            return Ok(false);
        }
        // Pressures and momentum have other units: scaled, rows weigh the same.
        let scales = self.factors.row_scales(&self.analysis);
        let scaled = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(&scales).map(|(value, scale)| value * scale).collect()
        };
        let b = scaled(rhs);
        let tolerance = KRYLOV_TOLERANCE * norm(&scaled(&matrix.absolute_product(typical)));
        if norm(&b) <= tolerance || !self.policy.is_worth_a_trial(norm(&b) / tolerance) {
            return Ok(false);
        }
        let KrylovSolution { x, iterations, residual } =
            self.iterate(matrix, &scales, &b, tolerance);
        check()?;
        let has_converged = residual <= tolerance && all_finite(&x);
        tracing::debug!(iterations, has_converged, "iterated with earlier factors");
        if has_converged {
            self.policy.succeeded();
            rhs.copy_from_slice(&x);
        } else {
            self.policy.failed();
        }
        Ok(has_converged)
    }

    fn inverse_of_dense(
        &mut self,
        _: &SparseMatrix,
        unknowns: &[usize],
    ) -> Result<Vec<f64>, LinearError> {
        // Without refinement: only the last fronts take part, which do not give the residual.
        let inverse = self.factors.inverse_of_dense(&self.analysis, unknowns);
        if all_finite(&inverse) { Ok(inverse) } else { Err(LinearError::NotFinite) }
    }
}

fn all_finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests;
