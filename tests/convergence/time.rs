//! Orders in time.

use alewife_core::case::Convection;
use alewife_core::space::Metric;
use alewife_core::step::MeshPath;
use alewife_core::time::Bdf;
use alewife_mesh::{Domain, Mesh, Point, Sizing, generate};
use tests::exact::{EthierSteinman, Exact, TaylorGreen};
use tests::{BoxOfTetrahedra, Stepping, Study, fluid_only, sides};

const EXACT: TaylorGreen = TaylorGreen { viscosity: 0.1 };

fn mesh() -> Mesh<2> {
    let (min, max) = (Point::<2>::new(0.1, -0.3), Point::<2>::new(1.1, 0.7));
    let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
    let sizing = Sizing { gap_layers: 1.0, ..Sizing::graded(0.1, 0.3, 0.1) };
    generate(&domain, &[], &sizing).expect("a rectangle is meshed")
}

/// A flow that decays in a box, its exact velocities given on all sides.
struct Decay<const D: usize, E> {
    mesh: Mesh<D>,
    exact: E,
    viscosity: f64,
    /// End of all runs.
    end: f64,
}

fn vortices() -> Decay<2, TaylorGreen> {
    Decay { mesh: mesh(), exact: EXACT, viscosity: EXACT.viscosity, end: 0.5 }
}

impl<const D: usize, E: Exact<D> + Copy + Send + 'static> Decay<D, E> {
    /// Velocities at the end of a run with `n_steps` equal steps, started from exact values at the
    /// first two levels.
    fn run(&self, n_steps: usize, second_order: bool, choice: Convection) -> Vec<Point<D>> {
        let Self { mesh, exact, viscosity, end } = self;
        let given = *exact;
        let sides = sides(mesh, move |place, time| given.velocity(place, time));
        let problem = fluid_only(mesh, sides, 1.0, *viscosity, Metric::Cartesian);
        let mut run = Stepping::new(&problem, mesh, choice, MeshPath::Fixed);
        let step = end / n_steps as f64;
        let at = |time: f64| mesh.nodes.iter().map(|place| exact.velocity(place, time)).collect();
        let mut levels = run.state.levels();
        (levels.now.velocity, levels.previous.velocity) = (at(0.0), at(-step));
        run.state.begin(levels);
        let bdf = if second_order { Bdf::second_order(step, step) } else { Bdf::first_order(step) };
        for _ in 0..n_steps {
            run.advance(bdf);
        }
        run.state.now.velocity.clone()
    }

    /// Differences to a run with very small steps on the same mesh, so that only the error in time
    /// shows.
    fn study(&self, n_steps: &[usize], second_order: bool, choice: Convection) -> Study {
        let fine = self.run(8 * n_steps.iter().max().unwrap_or(&1), true, choice);
        let steps: Vec<f64> = n_steps.iter().map(|&n| self.end / n as f64).collect();
        Study::run(&steps, |step| {
            let n_steps = (self.end / step).round() as usize;
            largest_difference(&self.run(n_steps, second_order, choice), &fine)
        })
    }
}

fn largest_difference<const D: usize>(one: &[Point<D>], other: &[Point<D>]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).norm()).fold(0.0, f64::max)
}

#[test]
fn bdf2_is_second_order_in_time_with_extrapolated_convection_and_with_newton() {
    for choice in [Convection::Extrapolated, Convection::Newton] {
        let study = vortices().study(&[10, 20, 40, 80], true, choice);
        study.assert_order(&format!("BDF2, {choice:?}"), 2.0, 0.15);
    }
}

#[test]
fn bdf2_is_second_order_in_time_in_space() {
    let exact = EthierSteinman { viscosity: 1.0 };
    let mesh = BoxOfTetrahedra { cubes: 2, has_body: false }.mesh();
    let flow = Decay { mesh, exact, viscosity: exact.viscosity, end: 1.0 };
    for choice in [Convection::Extrapolated, Convection::Newton] {
        let study = flow.study(&[10, 20, 40], true, choice);
        study.assert_order(&format!("BDF2 in space, {choice:?}"), 2.0, 0.15);
    }
}

#[test]
fn bdf1_is_first_order_in_time() {
    let study = vortices().study(&[10, 20, 40], false, Convection::Extrapolated);
    study.assert_order("BDF1", 1.0, 0.1);
}

#[test]
fn decaying_vortices_end_at_their_exact_velocity() {
    let flow = vortices();
    let computed = flow.run(80, true, Convection::Extrapolated);
    let exact: Vec<_> =
        flow.mesh.nodes.iter().map(|place| EXACT.velocity(place, flow.end)).collect();
    // The mesh resolves the flow to 4e-4 of its largest speed, 0.37 at the end.
    assert!(largest_difference(&computed, &exact) < 4e-4);
}
