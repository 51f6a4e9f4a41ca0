//! Unknowns with dense rows: bodies in thin films, and what only their rows determine.

use super::*;

/// Cells in a row from a film under a body, 1e-4 long, to a far field of cells as long as 100: a
/// velocity each, with a pressure on either side but none at the open end, and, where it is free, the
/// body that displaces the fluid of the film.
fn film(is_free: bool) -> System {
    let (n_cells, n_film) = (80, 40);
    let n = 2 * n_cells + usize::from(is_free);
    let mut dense = vec![vec![0.0; n]; n];
    let mut couple = |one: usize, other: usize, value: f64| {
        dense[one][other] = value;
        dense[other][one] = value;
    };
    for cell in 0..n_cells {
        let length = if cell < n_film { 1e-4 } else { 100.0 };
        let (pressure, next) = (n_cells + cell, cell + 1);
        couple(cell, cell, 4.0);
        couple(cell, pressure, length);
        if next < n_cells {
            couple(cell, next, -1.0);
            couple(cell, n_cells + next, -length);
        }
        if is_free && cell < n_film {
            couple(pressure, n - 1, length);
        }
    }
    if is_free {
        couple(n - 1, n - 1, 1.0);
    }
    let is_dense = |index: usize| index == 2 * n_cells;
    let unknowns = Unknowns {
        node: (0..n).map(|index| to_u32(index % n_cells)).collect(),
        is_pressure: (0..n).map(|index| index >= n_cells && !is_dense(index)).collect(),
        dense: (0..n).filter(|&index| is_dense(index)).collect(),
    };
    System::new(&dense, unknowns)
}

#[test]
fn a_free_body_delays_no_pivots_of_the_film_under_it() {
    for ordering in [Ordering::Best, Ordering::MinimumDegree] {
        let [imposed, free] = [false, true].map(film).map(|system| {
            let analysis = system.analyse(ordering);
            let mut factors = Factors::new(&analysis);
            factors.factorise(&analysis, &system.matrix).unwrap();
            let b: Vec<f64> = (0..system.n()).map(|index| (index as f64).cos()).collect();
            let mut x = b.clone();
            factors.solve(&analysis, &mut x);
            let residual = system.matrix.residual(&x, &b).relative();
            assert!(residual < 1e-14, "{residual:e}");
            let added = factors.n_entries(&analysis) - analysis.n_factor_entries();
            (factors.n_delayed_pivots(), added)
        });
        assert!(free <= imposed, "{free:?}, but {imposed:?} where its motion is imposed");
    }
}

/// A periodic chain of velocities is singular but for rounding until the last unknown fixes their mean.
#[test]
fn what_only_a_dense_row_determines_is_solved_for() {
    let n = 2000;
    let mut dense = vec![vec![0.0; n + 1]; n + 1];
    for one in 0..n {
        let other = (one + 1) % n;
        let stiffness = 0.1 + (one as f64 * 0.7).sin().powi(2) / 3.0;
        dense[one][one] += stiffness;
        dense[other][other] += stiffness;
        dense[one][other] -= stiffness;
        dense[other][one] -= stiffness;
        dense[n][one] = 1.0 / n as f64;
        dense[one][n] = 1.0 / n as f64;
    }
    let unknowns = Unknowns { dense: vec![n], ..nodes_of_their_own(n + 1) };
    let system = System::new(&dense, unknowns);
    let b: Vec<f64> = (0..=n).map(|index| (index as f64).cos()).collect();
    let (x, _) = system.solve(Ordering::Best, &b).unwrap();
    let residual = system.matrix.residual(&x, &b).relative();
    assert!(residual < 1e-14, "{residual:e}");
}
