//! Parts of the preconditioner against what they stand for, on systems of a few unknowns.

use super::matrix::{Numbering, SaddleMatrix};
use super::preconditioner::{BodyBasis, Commutator, transfer};
use super::{Interpolation, IterativeSettings, IterativeSolver, Part, SaddlePoint, Weights};
use crate::algebra::{CellFolds, CellMaps, ConstraintBuilder, LinearSolver, Term};
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

/// A matrix from one cell that has all unknowns, with what stands in each row and column.
fn matrix(system: &SaddlePoint, entry: impl Fn(usize, usize) -> f64) -> SaddleMatrix {
    let n = system.parts.len();
    let constraints = ConstraintBuilder::new(n).build();
    let folds = CellFolds::new(n, (0..n).map(to_u32).collect(), &constraints);
    let mut matrix = SaddleMatrix::new(system, &folds.unknowns(&constraints));
    let values: Vec<f64> = (0..n * n).map(|index| entry(index % n, index / n)).collect();
    matrix.add_cell(0, &values);
    matrix.complete();
    matrix
}

/// Different entries, but for the rows of pressures, which are their columns.
fn different(row: usize, column: usize) -> f64 {
    f64::from(if (3..5).contains(&row) { value(column, row) } else { value(row, column) })
}

fn value(row: usize, column: usize) -> f32 {
    (1 + column * 6 + row) as f32
}

#[test]
fn velocities_stand_in_blocks_with_bodies_last() {
    let numbering = Numbering::new(&system());
    assert_eq!((numbering.n_nodes, numbering.n_bodies), (2, 1));
    assert_eq!(numbering.blocks[1], [Some(2), None, None]);
    assert_eq!(numbering.blocks[2..], [[None; 3], [None, None, Some(5)]]);
    assert_eq!(numbering.pressures, [3, 4]);
    let matrix = matrix(&system(), different);
    let block = matrix.velocity();
    let mut y = vec![[0.0; 3]; 4];
    // Unknown 1 alone
    block.multiply(&[[0.0, 1.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]], &mut y);
    assert_eq!(y[0], [value(0, 1), value(1, 1), 0.0]);
    assert_eq!(y[1], [value(2, 1), 0.0, 0.0]);
    assert_eq!(y[3], [0.0, 0.0, value(5, 1)]);
    let unknowns = system().unknowns();
    assert_eq!(unknowns.dense, [5]);
    assert_eq!(unknowns.is_pressure, [false, false, false, true, true, false]);
    assert_eq!(unknowns.node[..5], [7, 7, 4, 7, 4]);
}

#[test]
fn components_that_are_no_unknowns_leave_the_block_regular() {
    let matrix = matrix(&system(), different);
    let block = matrix.velocity();
    let mut y = vec![[0.0; 3]; 4];
    // A body that only turns has no unknown in its first row
    block.multiply(&[[0.0; 3], [0.0, 1.0, 1.0], [1.0; 3], [1.0, 0.0, 0.0]], &mut y);
    assert_eq!(y[1], [0.0, value(2, 2), value(2, 2)]);
    assert_eq!(y[2], [value(5, 5); 3]);
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
    let matrix = matrix(&system(), different);
    let gradient = matrix.gradient();
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
    let (diagonal, gradient) = ([2.0, 4.0, 8.0], [[1.0, 0.0], [2.0, 1.0], [0.0, 3.0]]);
    // F diagonal, without the body
    let entry = |row: usize, column: usize| match (row, column) {
        (row, column) if row == column => diagonal.get(row).copied().unwrap_or(0.0),
        (0..3, 3..5) => gradient[row][column - 3],
        (3..5, 0..3) => gradient[column][row - 3],
        _ => 0.0,
    };
    let matrix = matrix(&system(), entry);
    let (block, of_matrix) = (matrix.velocity(), matrix.gradient());
    let mut commutator = Commutator::new(block, of_matrix, matrix.numbering(), false);
    let p = [3.0f64, -2.0];
    let schur = |row: usize| -> f64 {
        let terms = (0..3).flat_map(|velocity| {
            let factor = entry(velocity, 3 + row) / diagonal[velocity];
            (0..2).map(move |column| factor * entry(velocity, 3 + column) * p[column])
        });
        terms.sum()
    };
    let mut solution = [[f32::NAN]; 2];
    commutator.solve(block, &[[single(schur(0))], [single(schur(1))]], &mut solution);
    for (found, expected) in solution.iter().zip(p) {
        assert!((f64::from(found[0]) - expected).abs() < 1e-5 * expected.abs(), "{solution:?}");
    }
}

/// Three velocities, two pressures and nine rates of a body that is stiff beside the fluid.
fn stiff_body(held: f64) -> (SaddlePoint, SaddleMatrix) {
    let mut parts = system().parts[..5].to_vec();
    let rate = |rate: u8| Part::Rate { body: u32::from(rate / 6), mode: rate % 6 };
    parts.extend((0..9).map(rate));
    let system = SaddlePoint { parts, has_held_pressure: false };
    let entry = |row: usize, column: usize| match (row, column) {
        // A chain of springs that may move as a whole
        (5.., 5..) => match row.abs_diff(column) {
            0 => held + if row == 5 || row == 13 { 1e9 } else { 2e9 },
            1 => -1e9,
            _ => 0.0,
        },
        (3..5, 3..5) => 0.0,
        (row, column) => f64::from(u8::try_from((row * column) % 7).expect("it is small")) / 7.0,
    };
    let matrix = matrix(&system, entry);
    (system, matrix)
}

/// What holds the springs as a whole, and what lets them buckle.
const HELD: [f64; 2] = [3.0, -3.0];

#[test]
fn the_own_block_of_a_stiff_body_is_the_identity_in_its_basis() {
    for held in HELD {
        check_own_block(&stiff_body(held).1);
    }
}

fn check_own_block(matrix: &SaddleMatrix) {
    let basis = BodyBasis::new(matrix).expect("a body has coordinates");
    let own = basis.velocity(matrix);
    for row in 2..5 {
        for (column, block) in own.row(row).filter(|(column, _)| *column >= 2) {
            for (b, of_column) in block.iter().enumerate() {
                for (a, value) in of_column.iter().enumerate() {
                    let exact = if (row, a) == (column, b) { 1.0 } else { 0.0 };
                    // What 48 bits of the springs leave of what holds them
                    assert!((value - exact).abs() < 1e-4, "{row} {a} {column} {b}: {value}");
                }
            }
        }
    }
}

#[test]
fn a_matrix_in_the_basis_of_its_bodies_is_the_same_matrix() {
    for held in HELD {
        let (system, matrix) = stiff_body(held);
        check_same(&system, &matrix);
    }
}

fn check_same(system: &SaddlePoint, matrix: &SaddleMatrix) {
    let basis = BodyBasis::new(matrix).expect("a body has coordinates");
    let (velocity, divergence) = (basis.velocity(matrix), basis.divergence(matrix));
    let n = system.parts.len();
    let changed: Vec<f64> = (0..n).map(|at| (1.0 + at as f64).sin()).collect();
    let mut x = changed.clone();
    basis.restore_velocities(&mut x);
    let mut exact = vec![0.0; n];
    matrix.multiply(&x, &mut exact);
    basis.change_loads(&mut exact);
    let w = matrix.numbering().split(&changed, |_, value| single(value));
    let mut found = w.zeros_alike();
    velocity.multiply(&w.velocity, &mut found.velocity);
    basis.gradient(&divergence).multiply_add(&w.pressure, &mut found.velocity);
    divergence.transposed().multiply_transposed(&w.velocity, &mut found.pressure);
    let size = exact.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    for (found, exact) in matrix.numbering().values(&found).into_iter().zip(exact) {
        assert!((f64::from(found) - exact).abs() < 1e-5 * size, "{found} {exact}");
    }
    // And back
    let mut back = matrix.numbering().split(&x, |_, value| single(value));
    basis.change_velocities(&mut back.velocity);
    back.add(-1.0, &w);
    assert!(back.norm() < 1e-3 * w.norm(), "{}", back.norm());
}

/// A mistake of the program must not read as one of the matrix.
#[test]
#[should_panic(expected = "a matrix is set up before systems with it are solved")]
fn no_system_is_solved_before_its_matrix_is_set_up() {
    let system = system();
    let mut interpolation = Interpolation::with_capacity(6);
    (0..6).for_each(|unknown| interpolation.push([Term { unknown, weight: 1.0 }]));
    let weights = Weights {
        interpolation,
        pressure_mass: SparseMatrix::zeros(Pattern::from_rows([[0], [1]])),
        lumped_mass: vec![1.0; 6],
        wall_drag: vec![0.0; 6],
        inertia: 0.0,
        has_convection: false,
    };
    let matrix = matrix(&system, different);
    let mut solver = IterativeSolver::new(system, weights, IterativeSettings::default());
    solver.solve(&matrix, &mut [1.0; 6]).expect("the solver asks for a set-up first");
}

/// Cells with a folded one, given values, and a body: what `CellMaps` stores is stored.
#[test]
fn cells_add_up_to_the_same_matrix_in_blocks_and_in_columns() {
    let velocity = |node, component| Part::Velocity { node, component };
    let parts = vec![
        velocity(0, 0),
        velocity(0, 2),
        velocity(1, 0),
        velocity(1, 1),
        velocity(1, 2),
        Part::Pressure { node: 0 },
        Part::Pressure { node: 1 },
        Part::Rigid { body: 0, mode: 1 },
        Part::Rigid { body: 0, mode: 5 },
    ];
    let is_pressure = |unknown: usize| (5..7).contains(&unknown);
    let system = SaddlePoint { parts, has_held_pressure: false };
    // Raw unknown 9 is given, 10 moves with the body, 11 is a periodic copy
    let mut builder = ConstraintBuilder::new(12);
    builder.fix(9, 1.0);
    let terms = [(7, 1.0), (8, -0.3)].map(|(unknown, weight)| Term { unknown, weight });
    builder.constrain(10, terms.to_vec(), 0.0);
    builder.equate(11, 3);
    let constraints = builder.build();
    let raw = vec![0, 1, 2, 9, 5, 6, 10, 3, 4, 5, 6, 11, 0, 10, 2, 9, 5, 6];
    let folds = CellFolds::new(6, raw, &constraints);
    let cells = folds.unknowns(&constraints);
    let maps = CellMaps::new(&cells, |row, column| !(is_pressure(row) && is_pressure(column)));
    let mut expected = SparseMatrix::zeros(std::sync::Arc::clone(maps.pattern()));
    let mut matrix = SaddleMatrix::new(&system, &cells);
    for cell in 0..folds.n_cells() {
        // Symmetric, as pressures are; a third has no end in either precision
        let entry = |row: usize, column: usize| {
            ((row + 1) * (column + 1) + cell) as f64 / 3.0 + (row + column) as f64
        };
        let raw: Vec<f64> = (0..36).map(|index| entry(index % 6, index / 6)).collect();
        let mut folded = vec![0.0; folds.largest_matrix()];
        let values = if folds.is_folded(cell) {
            folds.fold(cell, &constraints, &raw, &mut folded);
            &folded
        } else {
            &raw
        };
        maps.scatter(cell, values, expected.values_mut());
        matrix.add_cell(cell, values);
    }
    matrix.add(7, 8, 0.25);
    let entry = maps.pattern().entry(7, 8).expect("bodies are in a cell");
    expected.values_mut()[entry] += 0.25;
    matrix.complete();
    let n = system.parts.len();
    let sparse = matrix.to_sparse();
    for unknown in 0..n {
        let mut x = vec![0.0; n];
        x[unknown] = 1.0;
        let [mut found, mut wanted, mut of_sparse] = [(); 3].map(|()| vec![0.0; n]);
        matrix.multiply(&x, &mut found);
        expected.multiply(&x, &mut wanted);
        sparse.multiply(&x, &mut of_sparse);
        for row in 0..n {
            assert!((found[row] - wanted[row]).abs() <= 1e-13 * wanted[row].abs(), "{unknown}");
            assert!((of_sparse[row] - wanted[row]).abs() <= 1e-13 * wanted[row].abs());
        }
    }
    matrix.clear();
    assert!(matrix.parts().into_iter().flatten().all(|number| *number == 0.0));
}
