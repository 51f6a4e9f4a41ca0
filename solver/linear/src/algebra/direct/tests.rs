//! Factors, earlier factors and what is kept of them, on chains of velocities and pressures.

use super::*;

/// A chain of velocities with a pressure at every third.
fn chain(n: usize) -> (SparseMatrix, Unknowns) {
    let is_pressure: Vec<bool> = (0..n).map(|index| index % 3 == 2).collect();
    let couples = |row: usize, column: usize| !is_pressure[row] || !is_pressure[column];
    let pattern = Pattern::from_rows((0..n).map(|row| {
        let columns = row.saturating_sub(3)..(row + 4).min(n);
        columns.filter(move |&column| couples(row, column))
    }));
    let mut matrix = SparseMatrix::zeros(pattern);
    let node = (0u32..).take(n).collect();
    let unknowns = Unknowns { node, is_pressure, dense: Vec::new() };
    set_convection(&mut matrix, &unknowns, 0.0);
    (matrix, unknowns)
}

/// Overwrites the values of such a chain, with some convection.
fn set_convection(matrix: &mut SparseMatrix, unknowns: &Unknowns, convection: f64) {
    let pattern = matrix.pattern().clone();
    let values = matrix.values_mut();
    for row in 0..pattern.n() {
        for (entry, &column) in pattern.entries(row).zip(pattern.row(row)) {
            let column = column as usize;
            let distance = row as f64 - column as f64;
            let has_pressure = unknowns.is_pressure[row] || unknowns.is_pressure[column];
            values[entry] = match (has_pressure, row == column) {
                (true, _) => distance,
                (false, true) => 4.0,
                (false, false) => -0.5 + convection * distance * (row as f64 * 0.7).sin(),
            };
        }
    }
}

fn rhs(n: usize) -> Vec<f64> {
    (0..n).map(|index| (index as f64).cos()).collect()
}

#[test]
fn a_solution_has_a_residual_at_rounding() {
    let (matrix, unknowns) = chain(300);
    let mut solver = DirectSolver::new(&matrix.shared_pattern(), &unknowns).unwrap();
    solver.set_up(&matrix).unwrap();
    assert!(solver.solve(&matrix, &mut rhs(300)).unwrap().residual < 1e-15);
}

/// Numbers that small have no sixteen digits, and no residual is small beside them.
#[test]
fn next_to_nothing_gives_nothing() {
    let (matrix, unknowns) = chain(300);
    let mut solver = DirectSolver::new(&matrix.shared_pattern(), &unknowns).unwrap();
    solver.set_up(&matrix).unwrap();
    for size in [1e-240, 1e-260, 1e-300, 1e-315, 0.0] {
        let mut x: Vec<f64> = rhs(300).iter().map(|value| size * value).collect();
        let accuracy = solver.solve(&matrix, &mut x).unwrap();
        assert!(accuracy.residual < 1e-15, "{size} {accuracy:?}");
        assert_eq!(x.iter().all(|value| *value == 0.0), size < 1e-250);
    }
}

#[test]
fn earlier_factors_give_the_solution_of_the_changed_matrix() {
    let n = 300;
    let (mut matrix, unknowns) = chain(n);
    let mut solver = DirectSolver::new(&matrix.shared_pattern(), &unknowns).unwrap();
    // So small a matrix is never worth it by itself.
    solver.policy = ReusePolicy::from_costs(1e9, 1.0);
    solver.set_up(&matrix).unwrap();
    let factorised = solver.hash();
    set_convection(&mut matrix, &unknowns, 1e-3);
    let mut x = rhs(n);
    let typical = vec![1.0; n];
    assert!(solver.solve_with_earlier_set_up(&matrix, &mut x, &typical).unwrap());
    assert_eq!(solver.hash(), factorised, "the factors are the earlier ones");
    let mut exact = rhs(n);
    solver.set_up(&matrix).unwrap();
    assert_ne!(solver.hash(), factorised);
    solver.solve(&matrix, &mut exact).unwrap();
    for (value, exact) in x.iter().zip(exact) {
        assert!((value - exact).abs() < 1e-11);
    }
}

#[test]
fn a_solver_that_recalls_gives_the_same_bits_by_the_same_factors() {
    let n = 300;
    let (mut matrix, unknowns) = chain(n);
    let pattern = matrix.shared_pattern();
    let new = || {
        let mut solver = DirectSolver::new(&pattern, &unknowns).unwrap();
        solver.policy = ReusePolicy::from_costs(1e9, 1.0);
        solver
    };
    let mut solver = new();
    solver.set_up(&matrix).unwrap();
    solver.policy.failed();
    assert_eq!(solver.memory(), SolverMemory { pauses: [0, 2], ..SolverMemory::default() });
    solver.mark();
    let memory = solver.memory();
    let mut other = new();
    other.recall(&pattern, &memory).unwrap();
    assert_eq!(other.memory(), memory);
    set_convection(&mut matrix, &unknowns, 1e-3);
    let solved = [&mut solver, &mut other].map(|solver| {
        let mut x = rhs(n);
        // The pause after a failure ends after two systems
        let tries = [(); 3]
            .map(|()| solver.solve_with_earlier_set_up(&matrix, &mut x, &vec![1.0; n]).unwrap());
        assert_eq!(tries, [false, false, true]);
        x
    });
    assert_eq!(solved[0], solved[1]);
    solver.set_up(&matrix).unwrap();
    assert_eq!(solver.memory(), memory, "it is that at the mark");
    solver.mark();
    assert_ne!(solver.memory(), memory);
    let (smaller, _) = chain(n - 3);
    let foreign = DirectSolver::new(&smaller.shared_pattern(), &chain(n - 3).1)
        .unwrap()
        .recall(&smaller.shared_pattern(), &memory);
    assert_eq!(foreign, Err(ForeignMemory { n_unknowns: n - 3 }.into()));
}

#[test]
fn factors_of_too_different_a_matrix_are_given_up() {
    let n = 300;
    let (mut matrix, unknowns) = chain(n);
    let mut solver = DirectSolver::new(&matrix.shared_pattern(), &unknowns).unwrap();
    solver.policy = ReusePolicy::from_costs(6.0, 1.0);
    solver.set_up(&matrix).unwrap();
    set_convection(&mut matrix, &unknowns, 2.0);
    let (mut x, typical) = (rhs(n), vec![1.0; n]);
    assert!(!solver.solve_with_earlier_set_up(&matrix, &mut x, &typical).unwrap());
    assert_eq!(x, rhs(n));
    assert!(!solver.policy.is_worth_a_trial(1e9), "a pause follows a failure");
}

#[test]
fn an_unchanged_matrix_is_not_factorised_again() {
    let n = 90;
    let (mut matrix, unknowns) = chain(n);
    let mut solver = DirectSolver::new(&matrix.shared_pattern(), &unknowns).unwrap();
    solver.set_up(&matrix).unwrap();
    // A solution with these factors is not finite.
    solver.factors = Factors::new(&solver.analysis);
    solver.set_up(&matrix).unwrap();
    assert_eq!(solver.solve(&matrix, &mut rhs(n)), Err(LinearError::NotFinite));
    // Equal values at another revision
    set_convection(&mut matrix, &unknowns, 0.0);
    assert!(!solver.solve_with_earlier_set_up(&matrix, &mut rhs(n), &vec![1.0; n]).unwrap());
    solver.set_up(&matrix).unwrap();
    assert_eq!(solver.solve(&matrix, &mut rhs(n)), Err(LinearError::NotFinite));
    set_convection(&mut matrix, &unknowns, 1e-12);
    solver.set_up(&matrix).unwrap();
    assert!(solver.solve(&matrix, &mut rhs(n)).is_ok());
}

#[test]
fn infinite_values_are_an_error() {
    let (mut matrix, unknowns) = chain(30);
    let mut solver = DirectSolver::new(&matrix.shared_pattern(), &unknowns).unwrap();
    solver.set_up(&matrix).unwrap();
    let mut b = rhs(30);
    b[7] = f64::NAN;
    assert_eq!(solver.solve(&matrix, &mut b), Err(LinearError::NotFinite));
    matrix.values_mut()[5] = f64::INFINITY;
    assert_eq!(solver.set_up(&matrix), Err(LinearError::NotFinite));
}
