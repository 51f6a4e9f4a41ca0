//! `Hierarchy`: levels of a multigrid method, and one V-cycle through them.

use std::sync::Arc;

use super::aggregation::{aggregate, smoothed_prolongation};
use super::block_matrix::BlockMatrix;
use super::chebyshev::{Chebyshev, Spectrum};
use super::dense::DenseInverse;
use super::product::galerkin;
use super::upwind::upwinded;

/// Unknowns, but for those of pairs, up to which a matrix is inverted.
const COARSEST: usize = 300;
/// Part of the rows that a coarser level may keep at most; aggregation that does less has ended.
const COARSENING: f64 = 0.8;
/// The part of the spectrum that smoothers take care of.
const SMOOTHED: Spectrum = Spectrum::UpperEnd(1.0 / 8.0);
/// Degree of the smoothers of levels by aggregation.
const DEGREE: usize = 2;

/// What a hierarchy is made by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HierarchySettings {
    /// Pairs among the last rows.
    pub n_pairs: usize,
    /// Degree of the smoother on the first level, where the transfer from it is given.
    pub degree: usize,
    /// Whether constants are in the nullspace of the matrix.
    pub is_singular: bool,
    /// Whether there is convection: coarser levels, where it is more against diffusion, are upwinded.
    pub is_convective: bool,
}

/// Levels from the finest to the one before the coarsest, and the inverse of that.
#[derive(Debug)]
pub(crate) struct Hierarchy<const B: usize> {
    levels: Vec<Level<B>>,
    coarsest: Coarsest<B>,
}

/// One level with the transfers to the next.
#[derive(Debug)]
struct Level<const B: usize> {
    matrix: Arc<BlockMatrix<B>>,
    smoother: Chebyshev<B>,
    prolongation: BlockMatrix<B>,
    restriction: BlockMatrix<B>,
    residual: Vec<[f32; B]>,
    /// Right-hand side and solution of the next level.
    coarse_rhs: Vec<[f32; B]>,
    coarse: Vec<[f32; B]>,
}

impl<const B: usize> Level<B> {
    fn new(
        matrix: Arc<BlockMatrix<B>>,
        smoother: Chebyshev<B>,
        prolongation: BlockMatrix<B>,
    ) -> Self {
        let restriction = prolongation.transposed();
        let residual = vec![[0.0; B]; matrix.n_rows()];
        let coarse_rhs = vec![[0.0; B]; prolongation.n_columns()];
        let coarse = coarse_rhs.clone();
        Self { matrix, smoother, prolongation, restriction, residual, coarse_rhs, coarse }
    }

    /// The matrix of the next level, with so many pairs if it is to be upwinded.
    fn coarse_matrix(&self, upwinded_pairs: Option<usize>) -> Arc<BlockMatrix<B>> {
        let matrix = galerkin(&self.restriction, &self.matrix, &self.prolongation);
        Arc::new(match upwinded_pairs {
            Some(n_pairs) => upwinded(&matrix, n_pairs).matrix,
            None => matrix,
        })
    }

    fn n_bytes(&self) -> usize {
        self.matrix.n_bytes() + self.prolongation.n_bytes() + self.restriction.n_bytes()
    }
}

impl<const B: usize> Hierarchy<B> {
    /// The levels below a matrix; `transfer`, if given, is the prolongation from the second level to
    /// the first.
    pub fn new(
        matrix: impl Into<Arc<BlockMatrix<B>>>,
        transfer: Option<BlockMatrix<B>>,
        settings: HierarchySettings,
    ) -> Self {
        let HierarchySettings { n_pairs, degree, is_singular, is_convective } = settings;
        let mut levels = Vec::new();
        let mut matrix = matrix.into();
        if let Some(transfer) = transfer {
            let smoother = Chebyshev::new(&matrix, n_pairs, SMOOTHED, degree);
            let level = Level::new(matrix, smoother, transfer);
            matrix = level.coarse_matrix(is_convective.then_some(n_pairs));
            levels.push(level);
        }
        while (matrix.n_rows() - 2 * n_pairs) * B > COARSEST {
            let aggregates = aggregate(&matrix, n_pairs);
            if aggregates.count as f64 > COARSENING * matrix.n_rows() as f64 {
                break;
            }
            let smoother = Chebyshev::new(&matrix, n_pairs, SMOOTHED, DEGREE);
            let prolongation = smoothed_prolongation(&matrix, &smoother, &aggregates);
            let level = Level::new(matrix, smoother, prolongation);
            matrix = level.coarse_matrix(is_convective.then_some(n_pairs));
            levels.push(level);
        }
        Self { levels, coarsest: Coarsest::new(&matrix, n_pairs, is_singular) }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        self.levels.iter().map(Level::n_bytes).sum()
    }

    /// Overwrites x with an approximation of A^-1 b by one V-cycle.
    pub fn cycle(&mut self, b: &[[f32; B]], x: &mut [[f32; B]]) {
        cycle(&mut self.levels, &mut self.coarsest, b, x);
    }
}

fn cycle<const B: usize>(
    levels: &mut [Level<B>],
    coarsest: &mut Coarsest<B>,
    b: &[[f32; B]],
    x: &mut [[f32; B]],
) {
    let Some((level, coarser)) = levels.split_first_mut() else {
        coarsest.apply(b, x);
        return;
    };
    let Level { matrix, smoother, prolongation, restriction, residual, coarse_rhs, coarse } = level;
    smoother.solve(matrix, b, x);
    residual.copy_from_slice(b);
    matrix.multiply_subtract(x, residual);
    restriction.multiply(residual, coarse_rhs);
    cycle(coarser, coarsest, coarse_rhs, coarse);
    prolongation.multiply_add(coarse, x);
    smoother.improve(matrix, b, x);
}

/// What stands for the inverse on the coarsest level.
#[derive(Debug)]
enum Coarsest<const B: usize> {
    Dense(DenseInverse),
    /// Where the matrix is singular, or large because aggregation has ended.
    Smoother(Box<(BlockMatrix<B>, Chebyshev<B>)>),
}

/// Unknowns above which the coarsest matrix is not inverted.
const MOST_DENSE: usize = 3000;
/// Degree of the polynomial that then takes its place.
const COARSEST_DEGREE: usize = 20;

impl<const B: usize> Coarsest<B> {
    fn new(matrix: &BlockMatrix<B>, n_pairs: usize, is_singular: bool) -> Self {
        let n = matrix.n_rows() * B;
        let inverse =
            (n <= MOST_DENSE).then(|| DenseInverse::new(n, dense(matrix, is_singular))).flatten();
        inverse.map_or_else(
            || {
                let spectrum = Spectrum::UpperEnd(1.0 / 100.0);
                let smoother = Chebyshev::new(matrix, n_pairs, spectrum, COARSEST_DEGREE);
                Self::Smoother(Box::new((matrix.clone(), smoother)))
            },
            Self::Dense,
        )
    }

    fn apply(&mut self, b: &[[f32; B]], x: &mut [[f32; B]]) {
        match self {
            Self::Dense(inverse) => inverse.apply(b.as_flattened(), x.as_flattened_mut()),
            Self::Smoother(smoother) => {
                let (matrix, smoother) = smoother.as_mut();
                smoother.solve(matrix, b, x);
            }
        }
    }
}

/// A matrix as a dense one, row by row. Where constants are in its nullspace they get the mean of its
/// diagonal as their eigenvalue: right-hand sides without a mean are then solved as they were.
fn dense<const B: usize>(matrix: &BlockMatrix<B>, is_singular: bool) -> Vec<f64> {
    let n = matrix.n_rows() * B;
    let mut values = vec![0.0; n * n];
    for row in 0..matrix.n_rows() {
        for (column, block) in matrix.row(row) {
            for b in 0..B {
                for a in 0..B {
                    values[(row * B + a) * n + column * B + b] = f64::from(block[b][a]);
                }
            }
        }
    }
    if is_singular {
        let trace: f64 = (0..n).map(|index| values[index * (n + 1)]).sum();
        let shift = trace / (n * n) as f64;
        values.iter_mut().for_each(|value| *value += shift);
    }
    values
}
