//! Parts of the preconditioner against what they stand for, on systems of a few unknowns.

use std::sync::Arc;

use super::blocks::{transfer, velocity_block};
use super::commutator::Commutator;
use super::damping::damping_at_nodes;
use super::gradient::Gradient;
use super::numbering::Numbering;
use super::{Interpolation, Part, SaddlePoint, Weights};
use crate::algebra::Term;
use crate::sparse::index::to_u32;
use crate::sparse::single::single;
use crate::sparse::{Pattern, SparseMatrix};

/// Two nodes in the plane, of which the second has no second component, two pressures and a body that
/// turns about one axis.
fn system() -> SaddlePoint {
    let velocity = |node, component| Part::Velocity { node, component };
    SaddlePoint {
        parts: vec![
            velocity(7, 0),
            velocity(7, 1),
            velocity(4, 0),
            Part::Pressure { node: 7 },
            Part::Pressure { node: 4 },
            Part::Rigid { body: 2, mode: 5 },
        ],
        has_held_pressure: false,
    }
}

/// A dense matrix with different entries.
fn matrix() -> SparseMatrix {
    let n = 6;
    let pattern = Pattern::from_columns((0..n).map(|_| 0..n));
    SparseMatrix::new(pattern, (0..n * n).map(|entry| 1.0 + entry as f64).collect())
}

fn value(row: usize, column: usize) -> f32 {
    (1 + column * 6 + row) as f32
}

#[test]
fn velocities_stand_in_blocks_with_bodies_last() {
    let system = system();
    let numbering = Numbering::new(&system);
    assert_eq!((numbering.n_nodes, numbering.n_bodies), (2, 1));
    assert_eq!(numbering.blocks[1], [Some(2), None, None]);
    assert_eq!(numbering.blocks[2..], [[None; 3], [None, None, Some(5)]]);
    assert_eq!(numbering.pressures, [3, 4]);
    let block = velocity_block(&matrix(), &numbering);
    let mut y = vec![[0.0; 3]; 4];
    // Unknown 1 alone
    block.multiply(&[[0.0, 1.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]], &mut y);
    assert_eq!(y[0], [value(0, 1), value(1, 1), 0.0]);
    assert_eq!(y[1], [value(2, 1), 0.0, 0.0]);
    assert_eq!(y[3], [0.0, 0.0, value(5, 1)]);
    let unknowns = system.unknowns();
    assert_eq!(unknowns.dense, [5]);
    assert_eq!(unknowns.is_pressure, [false, false, false, true, true, false]);
    assert_eq!(unknowns.node[..5], [7, 7, 4, 7, 4]);
}

#[test]
fn components_that_are_no_unknowns_leave_the_block_regular() {
    let numbering = Numbering::new(&system());
    let block = velocity_block(&matrix(), &numbering);
    let mut y = vec![[0.0; 3]; 4];
    block.multiply(&[[0.0; 3], [0.0, 1.0, 1.0], [0.0; 3], [1.0, 0.0, 0.0]], &mut y);
    assert_eq!(y[1], [0.0, value(2, 2), value(2, 2)]);
    assert_eq!(y[3], [value(5, 5), 0.0, 0.0]);
}

#[test]
fn the_transfer_takes_a_node_from_another_and_from_a_body() {
    let numbering = Numbering::new(&system());
    let mut interpolation = Interpolation::with_capacity(6);
    for unknown in 0..6 {
        let term = |unknown, weight| Term { unknown, weight };
        match unknown {
            2 => interpolation.push([term(0, 0.5), term(5, 0.25), term(5, 0.5)]),
            _ => interpolation.push([term(unknown, 1.0)]),
        }
    }
    let transfer = transfer(&interpolation, &numbering);
    assert_eq!((transfer.n_rows(), transfer.n_columns()), (4, 3));
    let mut fine = vec![[0.0; 3]; 4];
    transfer.multiply(&[[2.0, 3.0, 4.0], [5.0, 6.0, 7.0], [8.0, 9.0, 10.0]], &mut fine);
    assert_eq!(fine, [[2.0, 3.0, 4.0], [8.5, 0.0, 0.0], [5.0, 6.0, 7.0], [8.0, 9.0, 10.0]]);
}

#[test]
fn the_laplacian_is_the_product_of_gradients() {
    let numbering = Numbering::new(&system());
    let gradient = Gradient::new(&matrix(), &numbering);
    let mut u = vec![[0.0; 3]; 4];
    gradient.multiply_add(&[1.0, 0.0], &mut u);
    assert_eq!(u[0], [value(0, 3), value(1, 3), 0.0]);
    assert_eq!(u[3], [0.0, 0.0, value(5, 3)]);
    let mut p = vec![f32::NAN; 2];
    gradient
        .transposed()
        .multiply_transposed(&[[0.0, 1.0, 9.0], [0.0; 3], [0.0; 3], [0.0, 9.0, 1.0]], &mut p);
    assert_eq!(p, [3, 4].map(|column| value(1, column) + value(5, column)));
    let damping = [[2.0, 4.0, 0.0], [8.0, 0.0, 0.0]];
    let laplacian = gradient.laplacian(&damping);
    let expected = |p: usize, q: usize| {
        let damped = [(0, 2.0), (1, 4.0), (2, 8.0)];
        damped.map(|(row, by)| value(row, p) * value(row, q) / by).iter().sum::<f32>()
    };
    let mut y = vec![[0.0]; 2];
    laplacian.multiply(&[[1.0], [0.0]], &mut y);
    assert_eq!(y, [[expected(3, 3)], [expected(4, 3)]]);
    // With the one that is held, constants have no gradient
    let mut y = vec![[f32::NAN]; 3];
    gradient.with_held_pressure().laplacian(&damping).multiply(&[[1.0]; 3], &mut y);
    assert!(y.iter().all(|value| value[0].abs() < 1e-2 * expected(3, 3)), "{y:?}");
}

#[test]
fn the_commutator_inverts_the_schur_complement_of_a_diagonal_block() {
    let numbering = Numbering::new(&system());
    let (diagonal, gradient) = ([2.0, 4.0, 8.0], [[1.0, 0.0], [2.0, 1.0], [0.0, 3.0]]);
    // F diagonal, without the body
    let entry = |row: usize, column: usize| match (row, column) {
        (row, column) if row == column => diagonal.get(row).copied().unwrap_or(0.0),
        (0..3, 3..5) => gradient[row][column - 3],
        (3..5, 0..3) => gradient[column][row - 3],
        _ => 0.0,
    };
    let values = (0..36).map(|index| entry(index % 6, index / 6)).collect();
    let matrix = SparseMatrix::new(Pattern::from_columns((0..6).map(|_| 0..6)), values);
    let block = Arc::new(velocity_block(&matrix, &numbering));
    let of_matrix = Gradient::new(&matrix, &numbering);
    let mut commutator = Commutator::new(&block, &of_matrix, &numbering, false);
    let p = [3.0f64, -2.0];
    let schur = |row: usize| -> f64 {
        let terms = (0..3).flat_map(|velocity| {
            let factor = entry(velocity, 3 + row) / diagonal[velocity];
            (0..2).map(move |column| factor * entry(velocity, 3 + column) * p[column])
        });
        terms.sum()
    };
    let mut solution = [[f32::NAN]; 2];
    commutator.solve(&[[single(schur(0))], [single(schur(1))]], &mut solution);
    for (found, expected) in solution.iter().zip(p) {
        assert!((f64::from(found[0]) - expected).abs() < 1e-5 * expected.abs(), "{solution:?}");
    }
}

/// A film of width g between walls: linear elements across it, 4/3 of a Laplacian for each component.
#[test]
fn the_damping_between_walls_is_that_of_a_film() {
    let (n, width, viscosity) = (63, 0.2, 3.0);
    let axes: [u8; 3] = [0, 1, 2];
    let h = width / (n + 1) as f64;
    let of_node = |node| axes.map(|component| Part::Velocity { node: to_u32(node), component });
    let parts = (0..n).flat_map(of_node);
    let system = SaddlePoint { parts: parts.collect(), has_held_pressure: false };
    let numbering = Numbering::new(&system);
    let rows = |unknown: usize| {
        let near = [unknown.checked_sub(3), Some(unknown), Some(unknown + 3)];
        near.into_iter().flatten().filter(|row| *row < 3 * n)
    };
    let stiffness = 4.0 / 3.0 * viscosity / h;
    for inertia in [0.0, 1e6] {
        let mass = inertia * h;
        let entry = |row: usize, column: usize| {
            if row == column { 2.0 * stiffness + mass } else { -stiffness }
        };
        let values = (0..3 * n).flat_map(|column| rows(column).map(move |row| entry(row, column)));
        let pattern = Pattern::from_columns((0..3 * n).map(rows));
        let matrix = SparseMatrix::new(pattern, values.collect());
        let block = velocity_block(&matrix, &numbering);
        let mut interpolation = Interpolation::with_capacity(3 * n);
        for unknown in 0..3 * n {
            let is_coarse = unknown / 3 % 2 == 1;
            let of = if is_coarse {
                vec![unknown]
            } else {
                rows(unknown).filter(|row| *row != unknown).collect()
            };
            let weight = if is_coarse { 1.0 } else { 0.5 };
            interpolation.push(of.into_iter().map(|row| Term { unknown: to_u32(row), weight }));
        }
        let pressure_mass =
            SparseMatrix::new(Pattern::from_columns(std::iter::empty::<[usize; 0]>()), Vec::new());
        let lumped_mass = vec![h; 3 * n];
        let transfer = transfer(&interpolation, &numbering);
        let weights =
            Weights { interpolation, pressure_mass, lumped_mass, inertia, has_convection: false };
        let damping = damping_at_nodes(&block, &transfer, &numbering, &weights);
        let mobility: f64 = damping.iter().map(|d| h * h / f64::from(d[1])).sum();
        // Mean of y (g - y) / 2 mu, which is g^2 / 12 mu; with inertia alone its inverse
        let expected =
            if inertia == 0.0 { width * width / (12.0 * viscosity) } else { 1.0 / inertia };
        let relative = mobility / width / expected - 1.0;
        assert!(relative.abs() < 0.03, "{inertia}: {relative}");
    }
}
