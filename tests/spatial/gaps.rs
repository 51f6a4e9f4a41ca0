//! Iterations among many spheres, and across narrow gaps.

use std::f64::consts::PI;

use alewife_core::algebra::IterativeSettings;
use alewife_core::body::Inertia;
use alewife_core::coupling::SolverChoice;
use nalgebra::Matrix3;
use tests::ChainOfSpheres;

use super::iterative::{Solved, solve_from_rest};

/// Of spheres that sink without inertia.
fn iterations(n: usize, gap: f64) -> usize {
    iterations_with_inertia(n, gap, 0.0)
}

/// Of a time step, with the factor `rate` (1/s) of the new velocity in its rate, of spheres as heavy as the fluid.
fn iterations_with_inertia(n: usize, gap: f64, rate: f64) -> usize {
    let chain = ChainOfSpheres { n, gap, surface: 0.45 };
    let mesh = chain.mesh();
    let choice = SolverChoice::Iterative(IterativeSettings::default());
    let mut problem = chain.problem(&mesh);
    if rate > 0.0 {
        problem.density = 1.0;
        let mass = 4.0 / 3.0 * PI;
        let inertia = Inertia { mass, tensor: Matrix3::identity() * 0.4 * mass };
        problem.bodies.iter_mut().for_each(|body| body.inertia = inertia);
    }
    let solved = solve_from_rest(&problem, &mesh, rate, choice);
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

/// Where most cells have more mass over time step than viscosity: the flat cells of the films, which have not, decide
/// how large the spectrum is that the polynomial in place of a cycle has to know. It took 152 iterations, for 18 of one
/// sphere, with a bound that left them out.
#[test]
fn films_take_few_iterations_more_in_short_steps() {
    let [one, many] = [1, 10].map(|n| iterations_with_inertia(n, 0.05, 75.0) as f64);
    assert!(many <= 2.0 * one, "{one} {many}");
}
