//! Sides of the domain against flows they must let through unchanged.

use alewife_core::case::{Convection, Steady};
use alewife_core::coupling::Side;
use alewife_core::space::Metric;
use alewife_core::step::MeshPath;
use alewife_core::time::Bdf;
use alewife_mesh::{Domain, Point, Sizing, generate};
use tests::cases::{case, last, run};
use tests::exact::{Exact, TaylorGreen};
use tests::{Stepping, Study, errors, fluid_only, sides, steady};

fn uniform(size: f64) -> Sizing {
    Sizing { gap_layers: 1.0, ..Sizing::graded(size, 0.3, size) }
}

/// The vortices repeat with period 2 in both directions; a few small steps leave the error of the
/// mesh alone.
#[test]
fn decaying_vortices_in_a_doubly_periodic_box_converge_at_third_order() {
    let exact = TaylorGreen { viscosity: 0.05 };
    let study = Study::run(&[0.25, 0.125, 0.0625], |size| {
        let (min, max) = (Point::<2>::new(-0.3, 0.2), Point::<2>::new(1.7, 2.2));
        let domain = Domain::Box { min, max, periodic_x: true, periodic_y: true };
        let mesh = generate(&domain, &[], &uniform(size)).expect("a rectangle is meshed");
        let sides = mesh.boundaries.iter().map(|_| Some(Side::Periodic)).collect();
        let problem = fluid_only(&mesh, sides, 1.0, exact.viscosity, Metric::Cartesian);
        let choice = Convection::Extrapolated;
        let mut run = Stepping::new(&problem, &mesh, choice, MeshPath::Fixed);
        let step = 1e-3;
        let at = |time: f64| mesh.nodes.iter().map(|place| exact.velocity(place, time)).collect();
        let mut levels = run.state.levels();
        (levels.now.velocity, levels.previous.velocity) = (at(0.0), at(-step));
        run.state.begin(levels);
        let bdf = Bdf::second_order(step, step);
        for _ in 0..10 {
            run.advance(bdf);
        }
        errors(&mesh, &run.state.now, &exact, run.state.time, Metric::Cartesian).velocity
    });
    // Proven are three; on mirror-symmetric meshes it is a little more.
    assert!(study.order() > 2.85, "vortices in a periodic box: {study:?}");
}

#[test]
fn a_uniform_stream_passes_between_symmetry_planes_unchanged() {
    let (min, max) = (Point::<2>::new(0.0, 0.0), Point::<2>::new(2.0, 1.0));
    let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
    let mesh = generate(&domain, &[], &uniform(0.3)).expect("a rectangle is meshed");
    let stream = Point::<2>::new(1.0, 0.0);
    let mut sides = sides(&mesh, move |_, _| stream);
    sides[1] = Some(Side::TractionFree);
    sides[2] = Some(Side::Symmetry { normal_axis: 1 });
    sides[3] = Some(Side::Symmetry { normal_axis: 1 });
    let problem = fluid_only(&mesh, sides, 1.0, 0.01, Metric::Cartesian);
    let settings = Steady { tolerance: 1e-11, max_iterations: 10 };
    let flow = steady(&problem, &mesh, &settings);
    for velocity in &flow.solution.velocity {
        assert!((velocity - stream).norm() < 1e-12);
    }
}

/// Few iterations make Newton's method stall on the way from Stokes flow, so that the density is
/// raised step by step; the flow it ends at is the same.
#[test]
fn continuation_in_the_reynolds_number_ends_at_the_flow_newton_finds() {
    let middle = |max_iterations: usize| {
        let outcome = run(&case(&format!(
            r#"
            title = "driven cavity"
            geometry = "planar"
            fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 1e-3 }}
            domain.box = {{ min = [0.0, 0.0], max = [1.0, 1.0] }}
            mesh = {{ size = 0.05 }}
            time.steady = {{ max_iterations = {max_iterations} }}
            boundary.top.velocity.value = [1.0, 0.0]
            boundary.left = "no-slip"
            boundary.right = "no-slip"
            boundary.bottom = "no-slip"
            [[probe]]
            name = "middle"
            point = [0.5, 0.2]
            "#
        )));
        last(&outcome, "middle.velocity.x")
    };
    let (step_by_step, at_once) = (middle(5), middle(30));
    assert!((step_by_step / at_once - 1.0).abs() < 1e-7, "{step_by_step} and {at_once}");
}
