//! `EllipticSolver`: symmetric positive definite systems of components at nodes, set up once, solved often.
//!
//! Factors serve the plane and few unknowns in space, where they fill up: beyond those, FGMRES with a
//! V-cycle of smoothed aggregation.

use std::sync::{Mutex, PoisonError};

use alewife_interrupt::{Stopped, check, left_alone};
use thiserror::Error;

use super::cholesky::{Cholesky, CholeskyError};
use super::krylov::{Stopping, fgmres};
use super::vectors::norm;
use crate::multigrid::{Block, BlockMatrix, HierarchySettings, Multigrid, RowBuilder};
use crate::sparse::SparseMatrix;
use crate::sparse::index::to_u32;
use crate::sparse::single::single;

/// Residual over the right-hand side at which iterations end.
const TOLERANCE: f64 = 1e-10;
/// Iterations beyond which a system is not solved; a Laplacian takes twenty.
const MAX_ITERATIONS: usize = 200;
/// Degree of the smoothers.
const SMOOTHING: usize = 2;
/// Unknowns from which on it takes long to factorise their matrix.
const MANY_UNKNOWNS: usize = 50_000;

/// Why an elliptic system is not solved.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum EllipticError {
    /// There are no factors.
    #[error(transparent)]
    Factors(#[from] CholeskyError),
    /// Iterations do not come near the solution.
    #[error(
        "iterations end with a residual of {residual:.1e} of the right-hand side, which is not \
         a solution"
    )]
    NotConverged {
        /// Norm of the residual over that of the right-hand side.
        residual: f64,
    },
    /// The work was to end before there was a solution.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Which component at which node an unknown is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodalComponent {
    /// The node.
    pub node: u32,
    /// The component there.
    pub component: u8,
}

/// Solves A x = b for one symmetric positive definite A.
#[derive(Debug)]
pub enum EllipticSolver {
    /// By its factors.
    Factors(Box<Cholesky>),
    /// By iterations, one component a node.
    Scalars(Box<Iterations<1>>),
    /// By iterations, up to three components a node.
    Vectors(Box<Iterations<3>>),
}

impl EllipticSolver {
    /// By the factors of a matrix, of which the lower triangle is read.
    ///
    /// # Errors
    /// When the matrix is not positive definite, memory runs out, or the work of this thread is to end.
    pub fn factorised(matrix: &SparseMatrix) -> Result<Self, EllipticError> {
        let factors = if matrix.n() < MANY_UNKNOWNS {
            Cholesky::factorise(matrix)?
        } else {
            let matrix = matrix.copied();
            left_alone(move || Cholesky::factorise(&matrix))??
        };
        Ok(Self::Factors(Box::new(factors)))
    }

    /// By iterations, for a symmetric matrix and what its unknowns are, those of a node in order.
    #[must_use]
    pub fn iterative(matrix: SparseMatrix, places: &[NodalComponent]) -> Self {
        if places.iter().all(|place| place.component == 0) {
            Self::Scalars(Box::new(Iterations::new(matrix, places)))
        } else {
            Self::Vectors(Box::new(Iterations::new(matrix, places)))
        }
    }

    /// Overwrites right-hand sides, one after the other in `rhs`, with their solutions.
    ///
    /// # Errors
    /// When memory runs out, iterations do not end, or the work of this thread is to.
    pub fn solve(&self, rhs: &mut [f64]) -> Result<(), EllipticError> {
        match self {
            Self::Factors(factors) => Ok(factors.solve(rhs)?),
            Self::Scalars(iterations) => iterations.solve(rhs),
            Self::Vectors(iterations) => iterations.solve(rhs),
        }
    }

    /// Stored numbers of the factors, or of the matrix.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        match self {
            Self::Factors(factors) => factors.n_entries(),
            Self::Scalars(iterations) => iterations.matrix.pattern().n_entries(),
            Self::Vectors(iterations) => iterations.matrix.pattern().n_entries(),
        }
    }
}

/// A matrix with its preconditioner.
#[derive(Debug)]
pub struct Iterations<const B: usize> {
    matrix: SparseMatrix,
    /// Row of blocks and component of each unknown.
    places: Vec<[usize; 2]>,
    /// Locked for one cycle at a time: it works in vectors of its own.
    cycle: Mutex<Cycle<B>>,
}

#[derive(Debug)]
struct Cycle<const B: usize> {
    multigrid: Multigrid<B>,
    rhs: Vec<[f32; B]>,
    solution: Vec<[f32; B]>,
}

impl<const B: usize> Iterations<B> {
    fn new(matrix: SparseMatrix, places: &[NodalComponent]) -> Self {
        let mut rows: Vec<u32> = places.iter().map(|place| place.node).collect();
        rows.sort_unstable();
        rows.dedup();
        let row = |node: u32| rows.binary_search(&node).expect("each node has its row");
        let places: Vec<[usize; 2]> =
            places.iter().map(|place| [row(place.node), usize::from(place.component)]).collect();
        let n_rows = rows.len();
        let settings = HierarchySettings {
            n_pairs: 0,
            degree: SMOOTHING,
            is_singular: false,
            is_convective: false,
        };
        let multigrid = Multigrid::new(blocks(&matrix, &places, n_rows), None, settings);
        let (rhs, solution) = (vec![[0.0; B]; n_rows], vec![[0.0; B]; n_rows]);
        Self { matrix, places, cycle: Mutex::new(Cycle { multigrid, rhs, solution }) }
    }

    fn solve(&self, rhs: &mut [f64]) -> Result<(), EllipticError> {
        rhs.chunks_exact_mut(self.matrix.n().max(1)).try_for_each(|rhs| self.solve_one(rhs))
    }

    fn solve_one(&self, rhs: &mut [f64]) -> Result<(), EllipticError> {
        let size = norm(rhs);
        if size == 0.0 {
            return Ok(());
        }
        let multiply = |x: &[f64], y: &mut [f64]| {
            self.matrix.multiply(x, y);
        };
        let precondition = |r: &[f64], z: &mut [f64]| self.precondition(r, z);
        let stopping = Stopping { tolerance: TOLERANCE * size, max_iterations: MAX_ITERATIONS };
        let found = fgmres(multiply, precondition, rhs, stopping);
        check()?;
        let residual = found.residual / size;
        if residual.is_nan() || residual > TOLERANCE {
            return Err(EllipticError::NotConverged { residual });
        }
        rhs.copy_from_slice(&found.x);
        Ok(())
    }

    fn precondition(&self, r: &[f64], z: &mut [f64]) {
        // What a thread left that panicked is overwritten
        let mut cycle = self.cycle.lock().unwrap_or_else(PoisonError::into_inner);
        let Cycle { multigrid, rhs, solution } = &mut *cycle;
        for (&value, &[row, component]) in r.iter().zip(&self.places) {
            rhs[row][component] = single(value);
        }
        multigrid.cycle(rhs, solution);
        for (value, &[row, component]) in z.iter_mut().zip(&self.places) {
            *value = f64::from(solution[row][component]);
        }
    }
}

/// A symmetric matrix in blocks; components that are no unknowns have the largest number on the diagonal of
/// their block on the diagonal.
fn blocks<const B: usize>(
    matrix: &SparseMatrix,
    places: &[[usize; 2]],
    n_rows: usize,
) -> BlockMatrix<B> {
    let mut unknowns: Vec<[Option<usize>; B]> = vec![[None; B]; n_rows];
    for (unknown, &[row, component]) in places.iter().enumerate() {
        unknowns[row][component] = Some(unknown);
    }
    let pattern = matrix.pattern();
    let mut builder = RowBuilder::new(n_rows);
    let mut row_blocks: Vec<(usize, Block<B>)> = Vec::new();
    for (row, components) in unknowns.iter().enumerate() {
        row_blocks.clear();
        for (component, unknown) in components.iter().enumerate() {
            let Some(unknown) = *unknown else { continue };
            let values = &matrix.values()[pattern.entries(unknown)];
            for (&other, &value) in pattern.row(unknown).iter().zip(values) {
                let [column, b] = places[other as usize];
                let at = match row_blocks.iter().position(|(known, _)| *known == column) {
                    Some(at) => at,
                    None => {
                        row_blocks.push((column, [[0.0; B]; B]));
                        row_blocks.len() - 1
                    }
                };
                row_blocks[at].1[b][component] = single(value);
            }
        }
        row_blocks.sort_unstable_by_key(|(column, _)| *column);
        for (column, block) in &mut row_blocks {
            if *column == row {
                let largest = (0..B).map(|a| block[a][a]).fold(0.0, f32::max);
                for (a, unknown) in components.iter().enumerate() {
                    if unknown.is_none() {
                        block[a][a] = largest;
                    }
                }
            }
            builder.push(to_u32(*column), *block);
        }
        builder.end_row();
    }
    builder.build()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::Pattern;

    /// Unknowns at the points of a grid with n points along each edge of a cube, coupled with their
    /// neighbours and with the other components at their point; some components are no unknowns.
    fn grid(n: usize, n_components: usize) -> (SparseMatrix, Vec<NodalComponent>) {
        let is_unknown = |node: usize, component: usize| component == 0 || node % 7 != component;
        let mut places = Vec::new();
        for node in 0..n * n * n {
            for component in (0..n_components).filter(|&component| is_unknown(node, component)) {
                let component = u8::try_from(component).expect("few components");
                places.push(NodalComponent { node: to_u32(node), component });
            }
        }
        let of_node = |node: usize| [node % n, node / n % n, node / n / n];
        let value = |one: NodalComponent, other: NodalComponent| {
            let [from, to] = [one, other].map(|place| of_node(place.node as usize));
            let steps: usize = from.iter().zip(to).map(|(a, b)| a.abs_diff(b)).sum();
            match (steps, one.component == other.component) {
                (0, true) => 6.0,
                (0, false) => 0.5,
                (1, true) => -1.0,
                _ => 0.0,
            }
        };
        let mut rows: Vec<Vec<usize>> = Vec::new();
        let mut values = Vec::new();
        for &row in &places {
            let columns = (0..places.len()).filter(|&column| value(row, places[column]) != 0.0);
            let columns: Vec<usize> = columns.collect();
            values.extend(columns.iter().map(|&column| value(row, places[column])));
            rows.push(columns);
        }
        (SparseMatrix::new(Pattern::from_rows(rows), values), places)
    }

    fn check_against_factors(n_components: usize) {
        let (matrix, places) = grid(9, n_components);
        let side = |unknown: usize| (0.37 * unknown as f64).sin();
        let rhs: Vec<f64> = (0..2 * places.len()).map(side).collect();
        let mut expected = rhs.clone();
        EllipticSolver::factorised(&matrix).unwrap().solve(&mut expected).unwrap();
        let solver = EllipticSolver::iterative(matrix, &places);
        assert_eq!(matches!(solver, EllipticSolver::Scalars(_)), n_components == 1);
        let mut found = rhs;
        solver.solve(&mut found).unwrap();
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-8, "{found} for {expected}");
        }
    }

    #[test]
    fn iterations_find_what_factors_find() {
        check_against_factors(1);
        check_against_factors(3);
    }

    #[test]
    fn a_right_hand_side_that_is_no_number_is_an_error() {
        let (matrix, places) = grid(4, 1);
        let solver = EllipticSolver::iterative(matrix, &places);
        let error = solver.solve(&mut vec![f64::NAN; places.len()]);
        assert!(matches!(error, Err(EllipticError::NotConverged { .. })), "{error:?}");
    }
}
