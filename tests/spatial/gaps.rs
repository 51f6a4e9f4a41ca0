//! Iterations among many spheres, and across narrow gaps.

use alewife_core::algebra::IterativeSettings;
use alewife_core::body::Pose;
use alewife_core::coupling::{FluidSystem, SolverChoice};
use alewife_core::simulation::Timing;
use tests::{ChainOfSpheres, one_system_from_rest};

fn iterations(n: usize, gap: f64) -> usize {
    let chain = ChainOfSpheres { n, gap, surface: 0.45 };
    let mesh = chain.mesh();
    let problem = chain.problem(&mesh);
    let poses: Vec<Pose> = problem.bodies.iter().map(|body| body.pose).collect();
    let mut system = FluidSystem::new(&problem, &mesh, &poses, false);
    system.choose_solver(SolverChoice::Iterative(IterativeSettings::default()));
    one_system_from_rest(&mut system, &problem, &mesh, 0.0, &mut Timing::default())
        .expect("the system is solved");
    let iterations = system.accuracy().refinements;
    println!("{chain:?}: {} unknowns, {iterations} iterations", system.n_unknowns);
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
