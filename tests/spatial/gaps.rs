//! Iterations among many spheres, and across narrow gaps.

use alewife_core::algebra::IterativeSettings;
use alewife_core::coupling::SolverChoice;
use tests::ChainOfSpheres;

use super::iterative::{Solved, solve_from_rest};

fn iterations(n: usize, gap: f64) -> usize {
    let chain = ChainOfSpheres { n, gap, surface: 0.45 };
    let mesh = chain.mesh();
    let choice = SolverChoice::Iterative(IterativeSettings::default());
    let solved = solve_from_rest(&chain.problem(&mesh), &mesh, 0.0, choice);
    let Solved { n_unknowns, iterations, .. } = solved.expect("the system is solved");
    println!("{chain:?}: {n_unknowns} unknowns, {iterations} iterations");
    iterations
}

#[test]
fn a_narrow_gap_takes_few_iterations_more() {
    let [wide, narrow] = [0.1, 0.01].map(|gap| iterations(2, gap) as f64);
    assert!(narrow <= 1.5 * wide, "{wide} {narrow}");
}

#[test]
fn many_spheres_take_few_iterations_more_than_one() {
    let [one, many] = [1, 10].map(|n| iterations(n, 0.1) as f64);
    assert!(many <= 1.5 * one, "{one} {many}");
}
