//! `Hierarchy`: levels of a multigrid method, and one V-cycle through them.

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

/// Levels from the finest to the one before the coarsest, and the inverse of that. The finest matrix stays
/// with whoever has it.
#[derive(Debug)]
pub(crate) struct Hierarchy<const B: usize> {
    levels: Vec<Level<B>>,
    coarsest: Coarsest<B>,
}

/// One level with the transfers to the next, and the matrix of that.
#[derive(Debug)]
struct Level<const B: usize> {
    smoother: Chebyshev<B>,
    prolongation: BlockMatrix<B>,
    restriction: BlockMatrix<B>,
    residual: Vec<[f32; B]>,
    coarse_matrix: BlockMatrix<B>,
    /// Right-hand side and solution of the next level.
    coarse_rhs: Vec<[f32; B]>,
    coarse: Vec<[f32; B]>,
}

impl<const B: usize> Level<B> {
    /// Above the level that a prolongation begins on, which is upwinded if it has so many pairs.
    fn new(
        matrix: &BlockMatrix<B>,
        smoother: Chebyshev<B>,
        prolongation: BlockMatrix<B>,
        upwinded_pairs: Option<usize>,
    ) -> Self {
        let restriction = prolongation.transposed();
        let product = galerkin(&restriction, matrix, &prolongation);
        let coarse_matrix = match upwinded_pairs {
            Some(n_pairs) => upwinded(&product, n_pairs).matrix,
            None => product,
        };
        let residual = vec![[0.0; B]; matrix.n_rows()];
        let coarse_rhs = vec![[0.0; B]; prolongation.n_columns()];
        let coarse = coarse_rhs.clone();
        Self { smoother, prolongation, restriction, residual, coarse_matrix, coarse_rhs, coarse }
    }

    fn n_bytes(&self) -> usize {
        self.coarse_matrix.n_bytes() + self.prolongation.n_bytes() + self.restriction.n_bytes()
    }
}

impl<const B: usize> Hierarchy<B> {
    /// The levels below a matrix; `transfer`, if given, is the prolongation from the second level to
    /// the first.
    pub fn new(
        matrix: &BlockMatrix<B>,
        transfer: Option<BlockMatrix<B>>,
        settings: HierarchySettings,
    ) -> Self {
        let HierarchySettings { n_pairs, degree, is_singular, is_convective } = settings;
        let upwinded_pairs = is_convective.then_some(n_pairs);
        let mut levels: Vec<Level<B>> = Vec::new();
        if let Some(transfer) = transfer {
            let smoother = Chebyshev::new(matrix, n_pairs, SMOOTHED, degree);
            levels.push(Level::new(matrix, smoother, transfer, upwinded_pairs));
        }
        loop {
            let matrix = levels.last().map_or(matrix, |level| &level.coarse_matrix);
            if (matrix.n_rows() - 2 * n_pairs) * B <= COARSEST {
                break;
            }
            let aggregates = aggregate(matrix, n_pairs);
            if aggregates.count as f64 > COARSENING * matrix.n_rows() as f64 {
                break;
            }
            let smoother = Chebyshev::new(matrix, n_pairs, SMOOTHED, DEGREE);
            let prolongation = smoothed_prolongation(matrix, &smoother, &aggregates);
            let level = Level::new(matrix, smoother, prolongation, upwinded_pairs);
            levels.push(level);
        }
        let matrix = levels.last().map_or(matrix, |level| &level.coarse_matrix);
        let coarsest = Coarsest::new(matrix, n_pairs, is_singular);
        Self { levels, coarsest }
    }

    /// Memory of the matrices below the finest (bytes).
    pub fn n_bytes(&self) -> usize {
        self.levels.iter().map(Level::n_bytes).sum()
    }

    /// Overwrites x with an approximation of A^-1 b by one V-cycle, for the finest matrix A.
    pub fn cycle(&mut self, matrix: &BlockMatrix<B>, b: &[[f32; B]], x: &mut [[f32; B]]) {
        cycle(&mut self.levels, &mut self.coarsest, matrix, b, x);
    }
}

fn cycle<const B: usize>(
    levels: &mut [Level<B>],
    coarsest: &mut Coarsest<B>,
    matrix: &BlockMatrix<B>,
    b: &[[f32; B]],
    x: &mut [[f32; B]],
) {
    let Some((level, coarser)) = levels.split_first_mut() else {
        coarsest.apply(matrix, b, x);
        return;
    };
    let Level { smoother, prolongation, restriction, residual, coarse_matrix, coarse_rhs, coarse } =
        level;
    smoother.solve(matrix, b, x);
    residual.copy_from_slice(b);
    matrix.multiply_subtract(x, residual);
    restriction.multiply(residual, coarse_rhs);
    cycle(coarser, coarsest, coarse_matrix, coarse_rhs, coarse);
    prolongation.multiply_add(coarse, x);
    smoother.improve(matrix, b, x);
}

/// A matrix with the levels below it.
#[derive(Debug)]
pub(crate) struct Multigrid<const B: usize> {
    matrix: BlockMatrix<B>,
    hierarchy: Hierarchy<B>,
}

impl<const B: usize> Multigrid<B> {
    /// See [`Hierarchy::new`].
    pub fn new(
        matrix: BlockMatrix<B>,
        transfer: Option<BlockMatrix<B>>,
        settings: HierarchySettings,
    ) -> Self {
        let hierarchy = Hierarchy::new(&matrix, transfer, settings);
        Self { matrix, hierarchy }
    }

    /// Memory of the matrices (bytes).
    pub fn n_bytes(&self) -> usize {
        self.matrix.n_bytes() + self.hierarchy.n_bytes()
    }

    /// Overwrites y with A x.
    pub fn multiply(&self, x: &[[f32; B]], y: &mut [[f32; B]]) {
        self.matrix.multiply(x, y);
    }

    /// Overwrites x with an approximation of A^-1 b by one V-cycle.
    pub fn cycle(&mut self, b: &[[f32; B]], x: &mut [[f32; B]]) {
        self.hierarchy.cycle(&self.matrix, b, x);
    }
}

/// What stands for the inverse on the coarsest level.
#[derive(Debug)]
enum Coarsest<const B: usize> {
    Dense(DenseInverse),
    /// Where the matrix is singular, or large because aggregation has ended.
    Smoother(Box<Chebyshev<B>>),
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
                Self::Smoother(Box::new(smoother))
            },
            Self::Dense,
        )
    }

    fn apply(&mut self, matrix: &BlockMatrix<B>, b: &[[f32; B]], x: &mut [[f32; B]]) {
        match self {
            Self::Dense(inverse) => inverse.apply(b.as_flattened(), x.as_flattened_mut()),
            Self::Smoother(smoother) => smoother.solve(matrix, b, x),
        }
    }
}

/// A matrix as a dense one, row by row. Where constants are in its nullspace they get its diagonal as their
/// image: right-hand sides without a mean are then solved as they were.
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
        let diagonal: Vec<f64> = (0..n).map(|index| values[index * (n + 1)]).collect();
        let trace: f64 = diagonal.iter().sum();
        for (row, one) in values.chunks_exact_mut(n).zip(&diagonal) {
            for (value, other) in row.iter_mut().zip(&diagonal) {
                *value += one * other / trace;
            }
        }
    }
    values
}
