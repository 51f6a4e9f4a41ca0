//! Against dense LU on random saddle-point matrices and on those that are hard to eliminate.

mod film;
mod stopped;
mod transposed;

use faer::Mat;
use faer::linalg::solvers::Solve;
use proptest::prelude::*;

use super::analysis::MIN_PARALLEL_FLOPS;
use super::{Analysis, Factors, NoFactors, Ordering, Singular};
use crate::sparse::index::to_u32;
use crate::sparse::{Pattern, SparseMatrix, Unknowns};

/// A matrix with what each unknown is.
struct System {
    matrix: SparseMatrix,
    unknowns: Unknowns,
    /// Operations from which on the tree is cut into subtrees.
    least_flops: f64,
}

impl System {
    /// Stores the entries of a dense matrix that are not zero.
    fn new(dense: &[Vec<f64>], unknowns: Unknowns) -> Self {
        let n = dense.len();
        let is_stored = |&[row, column]: &[usize; 2]| dense[row][column] != 0.0;
        let stored = |row: usize| (0..n).map(move |column| [row, column]).filter(is_stored);
        let columns = |row: usize| stored(row).map(|[_, column]| column).collect::<Vec<_>>();
        let pattern = Pattern::from_rows((0..n).map(columns));
        let values = (0..n).flat_map(stored).map(|[row, column]| dense[row][column]).collect();
        Self {
            matrix: SparseMatrix::new(pattern, values),
            unknowns,
            least_flops: MIN_PARALLEL_FLOPS,
        }
    }

    /// The same, cut into subtrees or not.
    fn cut(self, is_cut: bool) -> Self {
        Self { least_flops: if is_cut { 0.0 } else { f64::INFINITY }, ..self }
    }

    fn n(&self) -> usize {
        self.matrix.n()
    }

    fn analyse(&self, ordering: Ordering) -> Analysis {
        Analysis::cut(self.matrix.pattern(), &self.unknowns, ordering, self.least_flops)
    }

    fn dense(&self) -> Mat<f64> {
        let pattern = self.matrix.pattern();
        let mut dense = Mat::zeros(self.n(), self.n());
        for row in 0..self.n() {
            let values = &self.matrix.values()[pattern.entries(row)];
            for (&column, value) in pattern.row(row).iter().zip(values) {
                dense[(row, column as usize)] = *value;
            }
        }
        dense
    }

    /// The solutions for `n_sides` right-hand sides, with the number of delayed fronts.
    fn solve(&self, ordering: Ordering, b: &[f64]) -> Result<(Vec<f64>, usize), NoFactors> {
        let analysis = self.analyse(ordering);
        let mut factors = Factors::new(&analysis);
        // The second factorisation works in used memory.
        let other: Vec<f64> = self.matrix.values().iter().map(|value| value * 3.0).collect();
        let other = SparseMatrix::new(self.matrix.pattern().clone(), other);
        factors.factorise(&analysis, &other)?;
        factors.factorise(&analysis, &self.matrix)?;
        let mut x = b.to_vec();
        factors.solve(&analysis, &mut x);
        Ok((x, factors.n_delayed_fronts()))
    }
}

/// What a matrix without an inverse leaves.
fn singular(system: &System) -> Singular {
    match system.solve(Ordering::Best, &vec![1.0; system.n()]) {
        Err(NoFactors::Singular(singular)) => singular,
        other => panic!("the matrix is singular: {other:?}"),
    }
}

fn nodes_of_their_own(n: usize) -> Unknowns {
    Unknowns { node: (0..to_u32(n)).collect(), is_pressure: vec![false; n], dense: Vec::new() }
}

/// Numbers in [-1, 1] that depend on a seed alone.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 / (1u64 << 53) as f64) * 2.0 - 1.0
    }
}

/// A saddle-point matrix on a grid of nodes: two velocities a node, a pressure at every other one,
/// both coupled to the eight neighbours.
fn saddle_point(width: usize, height: usize, seed: u64, hard: f64, n_dense: usize) -> System {
    let mut random = Random(seed);
    let mut node = Vec::new();
    let mut is_pressure = Vec::new();
    for index in 0..width * height {
        // Nodes on the boundary may have lost their velocities to boundary values.
        let has_velocity = random.next() > hard - 1.0;
        if has_velocity {
            node.extend([to_u32(index); 2]);
            is_pressure.extend([false; 2]);
        }
        if (index % width + index / width).is_multiple_of(3) {
            node.push(to_u32(index));
            is_pressure.push(true);
        }
    }
    let n_fluid = node.len();
    for _ in 0..n_dense {
        node.push(u32::MAX - 1);
        is_pressure.push(false);
    }
    let n = node.len();
    let near = |a: u32, b: u32| {
        let (a, b) = (a as usize, b as usize);
        (a % width).abs_diff(b % width) <= 1 && (a / width).abs_diff(b / width) <= 1
    };
    let mut dense = vec![vec![0.0; n]; n];
    for row in 0..n {
        for column in 0..n {
            let is_dense = row >= n_fluid || column >= n_fluid;
            let couples = is_dense || near(node[row], node[column]);
            if !couples || (is_pressure[row] && is_pressure[column]) {
                continue;
            }
            dense[row][column] = random.next();
            if row == column && !is_dense {
                // Some velocity blocks are singular, some are not.
                dense[row][column] = if random.next() > hard - 1.0 { 8.0 } else { 0.0 };
            }
        }
    }
    let dense_unknowns = (n_fluid..n).collect();
    System::new(&dense, Unknowns { node, is_pressure, dense: dense_unknowns })
}

/// Compares with dense LU where that is accurate; returns whether it was.
fn agrees_with_dense_lu(system: &System, ordering: Ordering, n_sides: usize) -> Option<bool> {
    let n = system.n();
    let b: Vec<f64> = (0..n * n_sides).map(|index| ((index * 7919) % 101) as f64 - 50.0).collect();
    let dense = system.dense();
    let rhs = Mat::from_fn(n, n_sides, |row, side| b[side * n + row]);
    let exact = dense.partial_piv_lu().solve(&rhs);
    let inverse_size = exact.norm_max();
    if !inverse_size.is_finite() || inverse_size > 1e7 {
        return None;
    }
    let (x, _) = system.solve(ordering, &b).ok()?;
    let mut worst = 0.0f64;
    for side in 0..n_sides {
        for row in 0..n {
            worst = worst.max((x[side * n + row] - exact[(row, side)]).abs());
        }
    }
    Some(worst <= 1e-8 * inverse_size)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn random_saddle_points_agree_with_dense_lu(
        width in 1usize..9,
        height in 1usize..9,
        seed in any::<u64>(),
        hard in 0.0f64..1.2,
        n_dense in 0usize..4,
        minimum_degree in any::<bool>(),
        n_sides in 1usize..4,
        is_cut in any::<bool>(),
    ) {
        let system = saddle_point(width, height, seed, hard, n_dense).cut(is_cut);
        let ordering = if minimum_degree { Ordering::MinimumDegree } else { Ordering::Best };
        prop_assert!(system.n() == 0 || agrees_with_dense_lu(&system, ordering, n_sides) != Some(false));
    }

    /// The last fronts alone give the values of unknowns with dense rows, with delayed pivots or without.
    #[test]
    fn the_inverse_in_dense_rows_is_that_of_complete_solves(
        width in 1usize..9,
        height in 1usize..9,
        seed in any::<u64>(),
        hard in 0.0f64..1.2,
        n_dense in 1usize..40,
        minimum_degree in any::<bool>(),
        is_cut in any::<bool>(),
    ) {
        let system = saddle_point(width, height, seed, hard, n_dense).cut(is_cut);
        let ordering = if minimum_degree { Ordering::MinimumDegree } else { Ordering::Best };
        let analysis = system.analyse(ordering);
        let mut factors = Factors::new(&analysis);
        if factors.factorise(&analysis, &system.matrix).is_ok() {
            let unknowns: Vec<usize> = system.unknowns.dense.iter().rev().copied().collect();
            let inverse = factors.inverse_of_dense(&analysis, &unknowns);
            for (nth, &column) in unknowns.iter().enumerate() {
                let mut whole = vec![0.0; system.n()];
                whole[column] = 1.0;
                factors.solve(&analysis, &mut whole);
                let size = whole.iter().fold(0.0f64, |most, value| most.max(value.abs()));
                for (row, found) in unknowns.iter().zip(&inverse[nth * unknowns.len()..]) {
                    prop_assert!((whole[*row] - found).abs() <= 1e-9 * size);
                }
            }
        }
    }
}

#[test]
fn most_random_saddle_points_are_compared() {
    let compared = (0..100)
        .filter(|&seed| {
            let system = saddle_point(6, 5, seed, 0.3, 2);
            agrees_with_dense_lu(&system, Ordering::Best, 2) == Some(true)
        })
        .count();
    assert!(compared > 60, "{compared}");
}

#[test]
fn columns_without_pivots_of_their_own_are_delayed_to_the_root() {
    // Every diagonal entry is zero and each pair (2 i, 2 i + 1) in different nodes needs the other:
    // no front has a pivot until both are in it.
    let n = 40;
    let mut dense = vec![vec![0.0; n]; n];
    for i in 0..n {
        let far = (i + n / 2) % n;
        dense[i][far] = 1.0 + i as f64 * 0.1;
        let next = (i + 1) % n;
        if next != far {
            dense[i][next] = 1e-9;
            dense[next][i] = 1e-9;
        }
    }
    let system = System::new(&dense, nodes_of_their_own(n));
    let (_, delayed) = system.solve(Ordering::MinimumDegree, &vec![1.0; n]).unwrap();
    assert!(delayed > 2, "{delayed}");
    for ordering in [Ordering::Best, Ordering::MinimumDegree] {
        assert_eq!(agrees_with_dense_lu(&system, ordering, 2), Some(true));
    }
    let system = system.cut(true);
    let analysis = system.analyse(Ordering::MinimumDegree);
    let mut factors = Factors::new(&analysis);
    factors.factorise(&analysis, &system.matrix).unwrap();
    assert!(factors.delays.len() > 2, "out of subtrees: {}", factors.delays.len());
    for n_sides in [1, 2] {
        assert_eq!(agrees_with_dense_lu(&system, Ordering::MinimumDegree, n_sides), Some(true));
    }
}

#[test]
fn a_pressure_before_its_velocities_is_delayed() {
    // One pressure in a node of its own, coupled to one velocity: minimum degree takes it first.
    let dense = vec![
        vec![0.0, 2.0, 0.0, 0.0],
        vec![2.0, 4.0, 1.0, 1.0],
        vec![0.0, 1.0, 4.0, 1.0],
        vec![0.0, 1.0, 1.0, 4.0],
    ];
    let mut unknowns = nodes_of_their_own(4);
    unknowns.is_pressure[0] = true;
    let system = System::new(&dense, unknowns);
    assert_eq!(agrees_with_dense_lu(&system, Ordering::Best, 1), Some(true));
}

#[test]
fn the_smallest_systems_are_solved() {
    for (dense, expected) in [
        (vec![vec![4.0]], vec![0.25]),
        (vec![vec![0.0, 2.0], vec![4.0, 0.0]], vec![0.25, 0.5]),
        (vec![vec![1e-300, 1.0], vec![1.0, 1e-300]], vec![1.0, 1.0]),
    ] {
        let n = dense.len();
        let system = System::new(&dense, nodes_of_their_own(n));
        let (x, _) = system.solve(Ordering::Best, &vec![1.0; n]).unwrap();
        assert_eq!(x, expected);
    }
}

#[test]
fn nothing_is_solved_without_unknowns() {
    let system = System::new(&[], Unknowns::default());
    assert_eq!(system.solve(Ordering::Best, &[]).unwrap().0, Vec::<f64>::new());
}

#[test]
fn a_singular_matrix_names_the_unknown_and_the_equation_left() {
    // Unknown 2 is in no equation, equation 1 has no unknown.
    let dense = vec![
        vec![2.0, 1.0, 0.0, 0.0],
        vec![0.0, 0.0, 0.0, 0.0],
        vec![1.0, 3.0, 0.0, 1.0],
        vec![0.0, 1.0, 0.0, 5.0],
    ];
    let system = System::new(&dense, nodes_of_their_own(4));
    let singular = singular(&system);
    assert_eq!(singular.unknowns, [2]);
    assert_eq!(singular.equations, [1]);
}

#[test]
fn a_constant_pressure_that_nothing_fixes_is_singular() {
    // Velocities between pressures on a ring: the pressure gradient does not see a constant.
    let n_cells = 30;
    let n = 2 * n_cells;
    for scale in [1e-8, 1.0, 1e8] {
        let mut dense = vec![vec![0.0; n]; n];
        for cell in 0..n_cells {
            let (velocity, right) = (cell, (cell + 1) % n_cells);
            dense[velocity][velocity] = 2.1;
            dense[velocity][right] = -1.0;
            dense[right][velocity] = -1.0;
            for (pressure, sign) in [(n_cells + cell, scale), (n_cells + right, -scale)] {
                dense[velocity][pressure] = sign;
                dense[pressure][velocity] = sign;
            }
        }
        let unknowns = Unknowns {
            node: (0..n).map(|index| to_u32(index % n_cells)).collect(),
            is_pressure: (0..n).map(|index| index >= n_cells).collect(),
            dense: Vec::new(),
        };
        let mut system = System::new(&dense, unknowns.clone());
        let singular = singular(&system);
        assert_eq!(singular.unknowns.len(), 1);
        assert!(singular.unknowns[0] >= n_cells, "a pressure is left over: {singular:?}");
        // With one pressure fixed the same matrix is regular.
        for other in 0..n {
            dense[n_cells][other] = 0.0;
        }
        dense[n_cells][n_cells] = scale;
        system = System::new(&dense, unknowns);
        assert!(system.solve(Ordering::Best, &vec![1.0; n]).is_ok());
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let system = saddle_point(44, 40, 7, 0.1, 3);
    let b: Vec<f64> = (0..system.n()).map(|index| (index as f64).sin()).collect();
    let solve_with = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| system.solve(Ordering::Best, &b).unwrap().0)
    };
    let analysis = system.analyse(Ordering::Best);
    assert!(analysis.subtrees.len() > 4, "the test needs subtrees: {}", analysis.subtrees.len());
    let one = solve_with(1);
    for n_threads in [2, 5] {
        assert_eq!(solve_with(n_threads), one);
    }
}
