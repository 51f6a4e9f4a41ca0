//! Products, aggregates, bounds and cycles on small problems whose answers are known.

use super::aggregation::aggregate;
use super::chebyshev::{Chebyshev, Spectrum};
use super::dense::{DenseInverse, invert};
use super::hierarchy::{Hierarchy, HierarchySettings};
use super::product::{galerkin, product};
use super::upwind::{Upwinded, upwinded};
use super::{Block, BlockMatrix, RowBuilder};

fn diagonal<const B: usize>(value: f32) -> Block<B> {
    std::array::from_fn(|b| std::array::from_fn(|a| if a == b { value } else { 0.0 }))
}

/// A matrix from what stands in each block; blocks of zeros are not stored.
fn matrix<const B: usize>(
    n_rows: usize,
    n_columns: usize,
    entry: impl Fn(usize, usize) -> Block<B>,
) -> BlockMatrix<B> {
    let mut rows = RowBuilder::new(n_columns);
    for row in 0..n_rows {
        for column in 0..n_columns {
            let block = entry(row, column);
            if block.iter().flatten().any(|value| *value != 0.0) {
                rows.push(u32::try_from(column).expect("the matrix is small"), block);
            }
        }
        rows.end_row();
    }
    rows.build()
}

/// Small whole numbers, of which sums and products are exact.
fn whole(index: usize) -> f32 {
    ((index * 7919 + 13) % 11) as f32 - 5.0
}

fn scattered_matrix(n_rows: usize, n_columns: usize, salt: usize) -> BlockMatrix<3> {
    matrix(n_rows, n_columns, |row, column| {
        if (row * 31 + column * 17 + salt).is_multiple_of(4) {
            let at = |a: usize, b: usize| whole(row * 97 + column * 41 + a * 5 + b + salt);
            std::array::from_fn(|b| std::array::from_fn(|a| at(a, b)))
        } else {
            diagonal(0.0)
        }
    })
}

fn vector(n: usize) -> Vec<[f32; 3]> {
    (0..n).map(|row| std::array::from_fn(|a| whole(row * 3 + a + 2))).collect()
}

fn times(matrix: &BlockMatrix<3>, x: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut y = vec![[f32::NAN; 3]; matrix.n_rows()];
    matrix.multiply(x, &mut y);
    y
}

#[test]
fn the_product_of_matrices_does_what_they_do_one_after_the_other() {
    let (left, right) = (scattered_matrix(700, 9, 1), scattered_matrix(9, 13, 2));
    let x = vector(13);
    assert_eq!(times(&product(&left, &right), &x), times(&left, &times(&right, &x)));
}

#[test]
fn a_transposed_matrix_moves_to_the_other_side_of_a_scalar_product() {
    let matrix = scattered_matrix(8, 14, 3);
    let (x, y) = (vector(14), vector(8));
    let scalar = |one: &[[f32; 3]], other: &[[f32; 3]]| -> f32 {
        one.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| a * b).sum()
    };
    assert_eq!(scalar(&times(&matrix, &x), &y), scalar(&x, &times(&matrix.transposed(), &y)));
    assert_eq!(matrix.transposed().transposed(), matrix);
}

#[test]
fn galerkin_is_the_product_of_three() {
    let (matrix, prolongation) = (scattered_matrix(12, 12, 4), scattered_matrix(12, 5, 5));
    let restriction = prolongation.transposed();
    let x = vector(5);
    let expected = times(&restriction, &times(&matrix, &times(&prolongation, &x)));
    assert_eq!(times(&galerkin(&restriction, &matrix, &prolongation), &x), expected);
}

#[test]
fn inverses_need_exchanges_of_rows() {
    let mut small = [0.0, 2.0, 0.0, 4.0, 0.0, 0.0, 1.0, 0.0, 8.0];
    assert!(invert(3, &mut small));
    assert_eq!(small, [0.0, 0.25, 0.0, 0.5, 0.0, 0.0, 0.0, -0.03125, 0.125]);
    assert!(!invert(2, &mut [1.0, 2.0, 2.0, 4.0]));
    assert!(DenseInverse::new(1, vec![0.0]).is_none());
}

/// The Laplacian of a square of n x n points with zero values around, or with none where it is
/// `singular`, plus twice as strong a second component.
fn laplacian<const B: usize>(n: usize, is_singular: bool) -> BlockMatrix<B> {
    let strength = |factor: f32| -> Block<B> {
        std::array::from_fn(|b| {
            std::array::from_fn(|a| if a == b { factor * (1.0 + a as f32) } else { 0.0 })
        })
    };
    matrix(n * n, n * n, |row, column| {
        let [x, y] = [row % n, row / n];
        let distance = x.abs_diff(column % n) + y.abs_diff(column / n);
        let neighbours = [x > 0, x + 1 < n, y > 0, y + 1 < n].iter().filter(|is| **is).count();
        match distance {
            0 => strength(if is_singular { neighbours as f32 } else { 4.0 }),
            1 => strength(-1.0),
            _ => strength(0.0),
        }
    })
}

#[test]
fn aggregates_are_neighbours_and_pairs_are_their_own() {
    let n = 12;
    let plain = laplacian::<3>(n, false);
    let aggregates = aggregate(&plain, 0);
    assert!((n * n / 6..n * n / 3).contains(&aggregates.count), "{}", aggregates.count);
    for number in 0..aggregates.count {
        let rows: Vec<usize> =
            (0..n * n).filter(|&row| aggregates.of_row[row] as usize == number).collect();
        assert!(!rows.is_empty() && rows.len() <= 9, "{rows:?}");
        // All around one of them, two steps away at most
        let near = |row: usize, other: usize| {
            (row % n).abs_diff(other % n) + (row / n).abs_diff(other / n) <= 2
        };
        assert!(rows.iter().any(|&root| rows.iter().all(|&row| near(root, row))), "{rows:?}");
    }
    let with_pair = aggregate(&plain, 1);
    let last = [n * n - 2, n * n - 1].map(|row| with_pair.of_row[row] as usize);
    assert_eq!(last, [with_pair.count - 2, with_pair.count - 1]);
    let others = &with_pair.of_row[..n * n - 2];
    assert!(others.iter().all(|&number| (number as usize) < with_pair.count - 2));
}

#[test]
fn the_spectrum_is_bounded() {
    // The largest eigenvalue of D^-1 A is 1 + cos(pi / (n + 1))
    for n in [5, 20] {
        let largest = 1.0 + (std::f32::consts::PI / (n as f32 + 1.0)).cos();
        let matrix = laplacian::<3>(n, false);
        let upper = Chebyshev::new(&matrix, 0, Spectrum::UpperEnd(0.1), 2).upper();
        assert!(upper > 0.97 * largest && upper < 1.1001 * largest, "{upper} for {largest}");
    }
}

/// As flat cells in a film have them: three of four thousand rows have the largest eigenvalue, and fewer the larger
/// they are. Unknowns are of very different sizes. After fifteen power steps the bound was 2.96.
#[test]
fn eigenvalues_of_a_few_rows_are_bounded() {
    let n_triples = 1333;
    let size = |row: usize| [0.1f32, 0.3, 1.0, 3.0, 10.0][row % 5];
    let mut rows = RowBuilder::<1>::new(3 * n_triples);
    for row in 0..3 * n_triples {
        let triple = row / 3;
        let coupling = 1.0 - (triple as f32 / n_triples as f32).sqrt().sqrt();
        for column in 3 * triple..3 * triple + 3 {
            let coupling = if column == row { 1.0 } else { coupling };
            let value = coupling * size(row) * size(column);
            rows.push(u32::try_from(column).expect("there are few"), [[value]]);
        }
        rows.end_row();
    }
    let largest = 3.0;
    let upper = Chebyshev::new(&rows.build(), 0, Spectrum::UpperEnd(0.1), 2).upper();
    assert!(upper > 1.05 * largest && upper < 1.1001 * largest, "{upper}");
}

#[test]
fn a_polynomial_on_the_whole_spectrum_solves() {
    let matrix = laplacian::<3>(4, false);
    let edge = (std::f32::consts::PI / 5.0).cos();
    let spectrum = Spectrum::Between(1.0 - edge, 1.0 + edge);
    let exact = vector(16);
    let mut x = vec![[0.0; 3]; 16];
    Chebyshev::new(&matrix, 0, spectrum, 40).solve(&matrix, &times(&matrix, &exact), &mut x);
    for (value, exact) in x.iter().flatten().zip(exact.iter().flatten()) {
        assert!((value - exact).abs() < 1e-4, "{value} for {exact}");
    }
}

/// How much the residual shrinks in each of the last of ten cycles, in the worse of two components.
fn contraction<const B: usize>(n: usize, is_singular: bool) -> f64 {
    let matrix = laplacian::<B>(n, is_singular);
    let settings = HierarchySettings { n_pairs: 0, degree: 2, is_singular, is_convective: false };
    let mut hierarchy = Hierarchy::new(&matrix, None, settings);
    let mut residual: Vec<[f32; B]> =
        (0..n * n).map(|row| std::array::from_fn(|a| whole(row * 5 + a))).collect();
    for a in 0..B {
        let mean = residual.iter().map(|value| value[a]).sum::<f32>() / (n * n) as f32;
        residual.iter_mut().for_each(|value| value[a] -= mean);
    }
    let mut x = residual.clone();
    let size = |residual: &[[f32; B]]| -> f64 {
        residual.iter().flatten().map(|value| f64::from(value * value)).sum::<f64>().sqrt()
    };
    let mut last = 1.0;
    for _ in 0..5 {
        let before = size(&residual);
        hierarchy.cycle(&matrix, &residual, &mut x);
        matrix.multiply_subtract(&x, &mut residual);
        last = size(&residual) / before;
    }
    last
}

#[test]
fn cycles_converge_alike_on_any_size() {
    for n in [24, 48] {
        let regular = contraction::<2>(n, false);
        let singular = contraction::<1>(n, true);
        println!("{n}: {regular:.3}, {singular:.3}");
        assert!(regular < 0.35 && singular < 0.35, "{n}: {regular} {singular}");
    }
}

/// Convection and diffusion along a line, with a pair of rows at the end.
fn convection(convection: f32) -> BlockMatrix<2> {
    matrix(8, 8, |row, column| {
        let coupling = match (column, row) {
            _ if column == row => 2.0,
            _ if column == row + 1 => convection - 1.0,
            _ if column + 1 == row => -convection - 1.0,
            _ => 0.0,
        };
        diagonal(coupling)
    })
}

#[test]
fn upwinding_adds_the_least_diffusion_without_positive_couplings() {
    for (size, added) in [(0.0, 0.0), (0.5, 0.0), (3.0, 2.0), (-3.0, 2.0)] {
        let Upwinded { matrix, part } = upwinded(&convection(size), 1);
        assert_eq!(part > 0.0, added > 0.0);
        for row in 1..5 {
            let value = |other: usize| {
                let block = matrix.row(row).find(|(column, _)| *column == other);
                block.map_or(f32::NAN, |(_, block)| block[0][0])
            };
            assert_eq!(value(row), 2.0 + 2.0 * added);
            assert_eq!(value(row + 1), size - 1.0 - added);
            assert_eq!(value(row - 1), -size - 1.0 - added);
        }
        // The couplings with the pair stay
        let last: Vec<f32> = matrix.row(5).map(|(_, block)| block[1][1]).collect();
        assert_eq!(last, [-size - 1.0 - added, 2.0 + added, size - 1.0]);
    }
}
