//! Orders in time.

use alewife_core::case::Convection;
use alewife_core::simulation::MeshPath;
use alewife_core::space::Metric;
use alewife_core::time::Bdf;
use alewife_mesh::{Domain, Mesh, Point, Sizing, generate};
use tests::exact::{Exact, TaylorGreen};
use tests::{Stepping, Study, fluid_only, sides};

const EXACT: TaylorGreen = TaylorGreen { viscosity: 0.1 };
/// End of all runs.
const END: f64 = 0.5;

fn mesh() -> Mesh<2> {
    let (min, max) = (Point::<2>::new(0.1, -0.3), Point::<2>::new(1.1, 0.7));
    let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
    let sizing = Sizing { gap_layers: 1.0, ..Sizing::graded(0.1, 0.3, 0.1) };
    generate(&domain, &[], &sizing).expect("a rectangle is meshed")
}

/// Velocities at the end of a run with `n_steps` equal steps, started from exact values at the
/// first two levels.
fn run(mesh: &Mesh<2>, n_steps: usize, second_order: bool, choice: Convection) -> Vec<Point<2>> {
    let sides = sides(mesh, |place, time| EXACT.velocity(place, time));
    let problem = fluid_only(mesh, sides, 1.0, EXACT.viscosity, Metric::Cartesian);
    let mut run = Stepping::new(&problem, mesh, choice, MeshPath::Fixed);
    let step = END / n_steps as f64;
    let at = |time: f64| mesh.nodes.iter().map(|place| EXACT.velocity(place, time)).collect();
    run.state.now.velocity = at(0.0);
    run.state.previous.velocity = at(-step);
    let bdf = if second_order { Bdf::second_order(step, step) } else { Bdf::first_order(step) };
    for _ in 0..n_steps {
        run.advance(bdf);
    }
    run.state.now.velocity.clone()
}

fn largest_difference(one: &[Point<2>], other: &[Point<2>]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).norm()).fold(0.0, f64::max)
}

/// Against a run with very small steps on the same mesh, so that only the error in time shows.
#[test]
fn bdf2_is_second_order_in_time_with_extrapolated_convection_and_with_newton() {
    let mesh = mesh();
    for choice in [Convection::Extrapolated, Convection::Newton] {
        let fine = run(&mesh, 640, true, choice);
        let study = Study::run(&[END / 10.0, END / 20.0, END / 40.0, END / 80.0], |step| {
            let n_steps = (END / step).round() as usize;
            largest_difference(&run(&mesh, n_steps, true, choice), &fine)
        });
        study.assert_order(&format!("BDF2, {choice:?}"), 2.0, 0.15);
    }
}

#[test]
fn bdf1_is_first_order_in_time() {
    let mesh = mesh();
    let fine = run(&mesh, 640, true, Convection::Extrapolated);
    let study = Study::run(&[END / 20.0, END / 40.0, END / 80.0], |step| {
        let n_steps = (END / step).round() as usize;
        largest_difference(&run(&mesh, n_steps, false, Convection::Extrapolated), &fine)
    });
    study.assert_order("BDF1", 1.0, 0.1);
}

#[test]
fn decaying_vortices_end_at_their_exact_velocity() {
    let mesh = mesh();
    let computed = run(&mesh, 80, true, Convection::Extrapolated);
    let exact: Vec<_> = mesh.nodes.iter().map(|place| EXACT.velocity(place, END)).collect();
    // The mesh resolves the flow to 4e-4 of its largest speed, 0.37 at the end.
    assert!(largest_difference(&computed, &exact) < 4e-4);
}
