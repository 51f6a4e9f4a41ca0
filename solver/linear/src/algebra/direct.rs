//! `DirectSolver`: sparse LU with iterative refinement, and old factors as a preconditioner.
//!
//! Factors outlive the matrix they were made of. A matrix that has not changed is solved with them
//! as they are; one that changed a little, by FGMRES with them as preconditioner, where that is
//! cheaper than factorising anew. What is cheaper is told by counts of operations and by the rate of
//! convergence, never by a clock: the same input has to give the same bits.

use thiserror::Error;

use super::Pattern;
use super::krylov::{fgmres, norm};
use crate::multifrontal::{Analysis, Factors, Ordering, PatternRef, Singular, Unknowns};

/// Why a linear system was not solved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LinearError {
    /// No inverse, or none that double precision can find.
    #[error("{} unknowns are not determined by the equations", .0.unknowns.len())]
    Singular(Singular),
    /// Refinement did not get there.
    #[error("the solution leaves a relative residual of {residual:.1e}")]
    Inaccurate {
        /// Largest residual over the largest sum of the sizes of its terms.
        residual: f64,
    },
    /// The matrix, the right-hand side or the solution is not finite.
    #[error("the solution is not a number")]
    NotFinite,
}

impl From<Singular> for LinearError {
    fn from(singular: Singular) -> Self {
        Self::Singular(singular)
    }
}

/// How well a system was solved.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Accuracy {
    /// Largest entry of |b - A x| over the largest of |A| |x| + |b|.
    pub residual: f64,
    /// Refinement steps made.
    pub refinements: usize,
}

/// Most refinement steps of one solve.
const MAX_REFINEMENTS: usize = 3;
/// Residual, relative to |A| |x| + |b|, at which refinement has nothing left to do.
const ROUNDING: f64 = 1e-14;
/// Residual above which a solution is worth nothing.
const USELESS: f64 = 1e-6;
/// Residual of FGMRES relative to the terms of the equations: far below what a step of any method
/// leaves of the error in time and space.
const KRYLOV_TOLERANCE: f64 = 1e-12;
/// Most iterations with old factors.
const MAX_ITERATIONS: usize = 20;
/// A residual that is so near its goal is always worth a trial.
const NEAR: f64 = 1e3;
/// Systems that are factorised without trying old factors, after a trial that failed.
const FIRST_PAUSE: usize = 2;
const LONGEST_PAUSE: usize = 256;

/// A factorisation with everything needed to solve with it.
#[derive(Debug)]
pub struct DirectSolver {
    analysis: Analysis,
    factors: Factors,
    reuse: Reuse,
    /// Fingerprint of the matrix that was factorised.
    fingerprint: Option<u64>,
}

/// When old factors are used.
#[derive(Debug)]
struct Reuse {
    /// Nanoseconds by operation counts: of a factorisation, of one iteration.
    factorisation: f64,
    iteration: f64,
    /// Systems still to be factorised at once, and how many after the next failure.
    wait: usize,
    pause: usize,
}

impl Reuse {
    fn new(analysis: &Analysis, n_entries: usize) -> Self {
        let iteration = analysis.substitution_cost() + 2.0 * n_entries as f64;
        let factorisation = analysis.factorisation_cost();
        Self { factorisation, iteration, wait: 0, pause: FIRST_PAUSE }
    }

    /// Iterations that take as long as a factorisation with its one solve.
    fn affordable(&self) -> usize {
        ((self.factorisation / self.iteration) as usize).min(MAX_ITERATIONS)
    }

    /// Whether to try the present factors on a residual that has to fall by `distance`.
    fn is_worth_a_trial(&mut self, distance: f64) -> bool {
        if distance > NEAR && self.wait > 0 {
            self.wait -= 1;
            return false;
        }
        self.affordable() > 1
    }

    fn succeeded(&mut self) {
        self.pause = FIRST_PAUSE;
    }

    fn failed(&mut self) {
        self.wait = self.pause;
        self.pause = (2 * self.pause).min(LONGEST_PAUSE);
    }
}

impl DirectSolver {
    /// Orders the unknowns of a pattern and finds the fill of its factors.
    #[must_use]
    pub fn analyse(pattern: &Pattern, unknowns: &Unknowns) -> Self {
        let analysis = Analysis::new(view(pattern), unknowns, Ordering::Best);
        let factors = Factors::new(&analysis);
        let reuse = Reuse::new(&analysis, pattern.rows.len());
        Self { analysis, factors, reuse, fingerprint: None }
    }

    /// Factorises the matrix with these values, unless the factors at hand are its own.
    ///
    /// # Errors
    /// When pivots are missing, or a value is not finite.
    pub fn factorise(&mut self, pattern: &Pattern, values: &[f64]) -> Result<(), LinearError> {
        let fingerprint = fingerprint(values);
        if self.fingerprint == Some(fingerprint) {
            return Ok(());
        }
        self.forget();
        if !values.iter().all(|value| value.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        self.factors.factorise(&self.analysis, view(pattern), values)?;
        tracing::debug!(irregular_fronts = self.factors.n_irregular(), "factorised");
        self.fingerprint = Some(fingerprint);
        Ok(())
    }

    /// Gives the factors up: what is solved next does not depend on what was solved before.
    pub fn forget(&mut self) {
        self.fingerprint = None;
    }

    /// Solves A x = b with the factors of an earlier matrix, in place.
    ///
    /// The residual is brought far below |A| |y|, the terms of the equations for a `typical`
    /// solution y. Returns false, and leaves `rhs` as it was, when there are
    /// no factors or factorising is cheaper.
    ///
    /// # Errors
    /// When the right-hand side is not finite.
    pub fn solve_with_old_factors(
        &mut self,
        pattern: &Pattern,
        values: &[f64],
        rhs: &mut [f64],
        typical: &[f64],
    ) -> Result<bool, LinearError> {
        if !rhs.iter().chain(typical).all(|value| value.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        if self.fingerprint.is_none() || self.fingerprint == Some(fingerprint(values)) {
            return Ok(false);
        }
        // Pressures and momentum have other units: scaled, rows weigh the same.
        let scales = self.factors.row_scales(&self.analysis);
        let scaled = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(&scales).map(|(value, scale)| value * scale).collect()
        };
        let b = scaled(rhs);
        let goal = KRYLOV_TOLERANCE * norm(&scaled(&pattern.multiply_sizes(values, typical)));
        if norm(&b) <= goal || !self.reuse.is_worth_a_trial(norm(&b) / goal) {
            return Ok(false);
        }
        let multiply = |x: &[f64], y: &mut [f64]| {
            y.fill(0.0);
            pattern.multiply_add(values, x, y);
            for (value, scale) in y.iter_mut().zip(&scales) {
                *value *= scale;
            }
        };
        let (factors, analysis) = (&mut self.factors, &self.analysis);
        let precondition = |z: &mut [f64]| {
            for (value, scale) in z.iter_mut().zip(&scales) {
                *value /= scale;
            }
            factors.solve(analysis, z);
        };
        let (x, outcome) = fgmres(multiply, precondition, &b, goal, self.reuse.affordable());
        let is_solved = outcome.residual <= goal && x.iter().all(|value| value.is_finite());
        tracing::debug!(iterations = outcome.iterations, is_solved, "tried old factors");
        if is_solved {
            self.reuse.succeeded();
            rhs.copy_from_slice(&x);
        } else {
            self.reuse.failed();
        }
        Ok(is_solved)
    }

    /// Solves A x = b in place for the matrix last factorised: substitution, then refinement.
    ///
    /// # Errors
    /// When the residual stays large or is not a number.
    pub fn solve(
        &mut self,
        pattern: &Pattern,
        values: &[f64],
        rhs: &mut [f64],
    ) -> Result<Accuracy, LinearError> {
        if !rhs.iter().all(|value| value.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        let target = rhs.to_vec();
        self.factors.solve(&self.analysis, rhs);
        let mut accuracy = Accuracy { residual: f64::INFINITY, refinements: 0 };
        loop {
            let (mut defect, size) = defect(pattern, values, rhs, &target);
            let next = relative(&defect, &size);
            if next.is_nan() || rhs.iter().any(|value| !value.is_finite()) {
                return Err(LinearError::NotFinite);
            }
            // Refinement that no longer helps has reached rounding.
            let is_best = next > 0.5 * accuracy.residual;
            accuracy.residual = accuracy.residual.min(next);
            if is_best || next <= ROUNDING || accuracy.refinements == MAX_REFINEMENTS {
                break;
            }
            accuracy.refinements += 1;
            self.factors.solve(&self.analysis, &mut defect);
            for (value, correction) in rhs.iter_mut().zip(&defect) {
                *value += correction;
            }
        }
        tracing::debug!(accuracy.residual, accuracy.refinements, "solved");
        if accuracy.residual > USELESS {
            return Err(LinearError::Inaccurate { residual: accuracy.residual });
        }
        Ok(accuracy)
    }

    /// How some of the unknowns with dense rows answer unit right-hand sides of their own equations,
    /// column by column, with the matrix last factorised and without refinement.
    pub fn inverse_of_dense(&mut self, unknowns: &[usize]) -> Vec<f64> {
        self.factors.inverse_of_dense(&self.analysis, unknowns)
    }
}

fn view(pattern: &Pattern) -> PatternRef<'_> {
    PatternRef { columns: &pattern.columns, rows: &pattern.rows }
}

/// A number that tells matrices apart: all bits of all values, mixed.
fn fingerprint(values: &[f64]) -> u64 {
    const MIX: u64 = 0x9E37_79B9_7F4A_7C15;
    let mut lanes = [1u64, 2, 3, 4];
    let chunks = values.chunks_exact(4);
    let rest = chunks.remainder();
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane = (*lane ^ value.to_bits()).wrapping_mul(MIX).rotate_left(29);
        }
    }
    let all = lanes.into_iter().chain(rest.iter().map(|value| value.to_bits()));
    all.fold(0, |hash, part| (hash ^ part).wrapping_mul(MIX).rotate_left(29))
}

fn relative(defect: &[f64], size: &[f64]) -> f64 {
    let largest = |values: &[f64]| values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let (defect_size, size) = (largest(defect), largest(size));
    if defect.iter().any(|value| value.is_nan()) {
        f64::NAN
    } else if size > 0.0 {
        defect_size / size
    } else {
        defect_size
    }
}

/// b - A x, and |A| |x| + |b|.
fn defect(pattern: &Pattern, values: &[f64], x: &[f64], b: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut rest = b.to_vec();
    let mut size: Vec<f64> = b.iter().map(|value| value.abs()).collect();
    for (column, &factor) in x.iter().enumerate() {
        for entry in pattern.columns[column]..pattern.columns[column + 1] {
            let product = values[entry] * factor;
            rest[pattern.rows[entry]] -= product;
            size[pattern.rows[entry]] += product.abs();
        }
    }
    (rest, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of velocities with a pressure at every third, `change` added to its convection.
    fn chain(n: usize, change: f64) -> (Pattern, Vec<f64>, Unknowns) {
        let is_pressure: Vec<bool> = (0..n).map(|index| index % 3 == 2).collect();
        let mut pattern = Pattern { columns: vec![0], rows: Vec::new() };
        let mut values = Vec::new();
        for column in 0..n {
            for row in column.saturating_sub(3)..(column + 4).min(n) {
                if is_pressure[row] && is_pressure[column] {
                    continue;
                }
                pattern.rows.push(row);
                let distance = row as f64 - column as f64;
                values.push(match (is_pressure[row] || is_pressure[column], row == column) {
                    (true, _) => distance,
                    (false, true) => 4.0,
                    (false, false) => -0.5 + change * distance * (row as f64 * 0.7).sin(),
                });
            }
            pattern.columns.push(pattern.rows.len());
        }
        let unknowns = Unknowns { node: (0..n as u32).collect(), is_pressure, dense: Vec::new() };
        (pattern, values, unknowns)
    }

    fn rhs(n: usize) -> Vec<f64> {
        (0..n).map(|index| (index as f64).cos()).collect()
    }

    #[test]
    fn a_solution_has_a_residual_at_rounding() {
        let (pattern, values, unknowns) = chain(300, 0.0);
        let mut solver = DirectSolver::analyse(&pattern, &unknowns);
        solver.factorise(&pattern, &values).unwrap();
        assert!(solver.solve(&pattern, &values, &mut rhs(300)).unwrap().residual < 1e-15);
    }

    #[test]
    fn old_factors_give_the_solution_of_the_new_matrix() {
        let n = 300;
        let (pattern, values, unknowns) = chain(n, 0.0);
        let mut solver = DirectSolver::analyse(&pattern, &unknowns);
        // So small a matrix is never worth it by itself.
        solver.reuse.factorisation = 1e9;
        solver.factorise(&pattern, &values).unwrap();
        let (_, changed, _) = chain(n, 1e-3);
        let mut x = rhs(n);
        let typical = vec![1.0; n];
        assert!(solver.solve_with_old_factors(&pattern, &changed, &mut x, &typical).unwrap());
        assert_eq!(solver.fingerprint, Some(fingerprint(&values)), "no new factors");
        let mut exact = rhs(n);
        solver.factorise(&pattern, &changed).unwrap();
        solver.solve(&pattern, &changed, &mut exact).unwrap();
        for (value, exact) in x.iter().zip(exact) {
            assert!((value - exact).abs() < 1e-11);
        }
    }

    #[test]
    fn factors_that_are_too_old_are_given_up() {
        let n = 300;
        let (pattern, values, unknowns) = chain(n, 0.0);
        let mut solver = DirectSolver::analyse(&pattern, &unknowns);
        solver.reuse.factorisation = 6.0 * solver.reuse.iteration;
        solver.factorise(&pattern, &values).unwrap();
        let (_, changed, _) = chain(n, 2.0);
        let (mut x, typical) = (rhs(n), vec![1.0; n]);
        for trial in 0..3 {
            assert!(!solver.solve_with_old_factors(&pattern, &changed, &mut x, &typical).unwrap());
            assert_eq!(x, rhs(n));
            // Then some systems are factorised at once.
            assert_eq!(solver.reuse.wait, FIRST_PAUSE - trial);
        }
    }

    #[test]
    fn an_unchanged_matrix_is_not_factorised_again() {
        let (pattern, values, unknowns) = chain(90, 0.0);
        let mut solver = DirectSolver::analyse(&pattern, &unknowns);
        solver.factorise(&pattern, &values).unwrap();
        let factors = format!("{:?}", solver.factors);
        // What is no longer looked at cannot be wrong.
        let pattern_without_values = Pattern { columns: vec![0], rows: Vec::new() };
        solver.factorise(&pattern_without_values, &values).unwrap();
        assert_eq!(format!("{:?}", solver.factors), factors);
        let (_, changed, _) = chain(90, 1e-12);
        assert_ne!(fingerprint(&values), fingerprint(&changed));
    }

    #[test]
    fn what_is_not_a_number_is_an_error() {
        let (pattern, mut values, unknowns) = chain(30, 0.0);
        let mut solver = DirectSolver::analyse(&pattern, &unknowns);
        solver.factorise(&pattern, &values).unwrap();
        let mut b = rhs(30);
        b[7] = f64::NAN;
        assert_eq!(solver.solve(&pattern, &values, &mut b), Err(LinearError::NotFinite));
        values[5] = f64::INFINITY;
        assert_eq!(solver.factorise(&pattern, &values), Err(LinearError::NotFinite));
    }
}
