//! Orders in space, on straight and curved domains: planar, axisymmetric and three-dimensional.

use alewife_core::case::Steady;
use alewife_core::coupling::{Problem, Side, Solution};
use alewife_core::space::Metric;
use alewife_mesh::{Domain, Mesh, PlacedShape, Point, Shape, Sizing, generate};
use tests::exact::{Exact, Kovasznay, StokesSphere, SwirlingCells};
use tests::{Errors, Study, errors, fluid_only, rest, sides, steady};

/// Orders of Taylor-Hood elements hold to this on unstructured meshes, whose cell sizes do not
/// halve exactly.
const SLACK: f64 = 0.15;

pub const SETTINGS: Steady = Steady { tolerance: 1e-11, max_iterations: 25 };

fn uniform(size: f64) -> Sizing {
    Sizing { gap_layers: 1.0, ..Sizing::graded(size, 0.3, size) }
}

pub fn solve<const D: usize>(problem: &Problem<D>, mesh: &Mesh<D>) -> Solution<D> {
    steady(problem, mesh, &SETTINGS).solution
}

pub fn assert_orders(name: &str, sizes: &[f64], slack: f64, mut solve: impl FnMut(f64) -> Errors) {
    let found: Vec<Errors> = sizes.iter().map(|&size| solve(size)).collect();
    let study = |pick: fn(&Errors) -> f64| Study {
        sizes: sizes.to_vec(),
        errors: found.iter().map(pick).collect(),
    };
    study(|errors| errors.velocity).assert_order(&format!("{name}: velocity, L2"), 3.0, slack);
    study(|errors| errors.gradient).assert_order(&format!("{name}: velocity, H1"), 2.0, slack);
    study(|errors| errors.pressure).assert_order(&format!("{name}: pressure, L2"), 2.0, slack);
}

#[test]
fn poiseuille_flow_is_exact_in_a_channel_and_in_a_tube() {
    for metric in [Metric::Cartesian, Metric::Revolved] {
        let domain = if metric.is_revolved() {
            Domain::Cylinder { x: [0.0, 2.0], radius: 1.0, periodic_x: false }
        } else {
            let (min, max) = (Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
            Domain::Box { min, max, periodic_x: false, periodic_y: false }
        };
        let mesh = generate(&domain, &[], &uniform(0.4)).expect("a rectangle is meshed");
        let parabola = |place: &Point<2>| Point::<2>::new(1.0 - place[1] * place[1], 0.0);
        let mut sides = sides(&mesh, |_, _| Point::<2>::zeros());
        for (side, boundary) in sides.iter_mut().zip(&mesh.boundaries) {
            if boundary.name == "left" {
                let profile = Box::new(move |place: &Point<2>, _| parabola(place));
                *side = Some(Side::Velocity { profile, is_wall: false });
            } else if boundary.name == "right" {
                *side = Some(Side::DoNothing);
            }
        }
        let problem = fluid_only(&mesh, sides, 1.0, 0.1, metric);
        let solution = solve(&problem, &mesh);
        for (place, velocity) in mesh.nodes.iter().zip(&solution.velocity) {
            assert!((velocity - parabola(place)).norm() < 1e-10, "at {place}");
        }
        // The pressure falls by 2 mu (channel) or 4 mu (tube) per unit length to 0 at the outlet.
        let slope = if metric.is_revolved() { 0.4 } else { 0.2 };
        for (place, pressure) in mesh.nodes.iter().zip(&solution.pressure) {
            assert!((pressure - slope * (2.0 - place[0])).abs() < 1e-10, "at {place}");
        }
    }
}

#[test]
fn kovasznay_flow_converges_at_the_orders_of_taylor_hood_in_a_straight_domain() {
    let exact = Kovasznay { reynolds: 40.0 };
    assert_orders("Kovasznay", &[0.2, 0.1, 0.05, 0.025], SLACK, |size| {
        let (min, max) = (Point::<2>::new(-0.5, -0.5), Point::<2>::new(1.0, 1.5));
        let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
        let mesh = generate(&domain, &[], &uniform(size)).expect("a rectangle is meshed");
        let sides = sides(&mesh, move |place, time| exact.velocity(place, time));
        let problem = fluid_only(&mesh, sides, 1.0, 1.0 / 40.0, Metric::Cartesian);
        errors(&mesh, &solve(&problem, &mesh), &exact, 0.0, Metric::Cartesian)
    });
}

#[test]
fn kovasznay_flow_converges_at_the_same_orders_between_curved_boundaries() {
    let exact = Kovasznay { reynolds: 40.0 };
    assert_orders("Kovasznay in a disc", &[0.1, 0.05, 0.025], SLACK, |size| {
        let domain = Domain::Disc { center: Point::<2>::new(0.3, 0.5), radius: 0.8 };
        let mesh = generate(&domain, &[], &uniform(size)).expect("a disc is meshed");
        let sides = sides(&mesh, move |place, time| exact.velocity(place, time));
        let problem = fluid_only(&mesh, sides, 1.0, 1.0 / 40.0, Metric::Cartesian);
        errors(&mesh, &solve(&problem, &mesh), &exact, 0.0, Metric::Cartesian)
    });
}

#[test]
fn stokes_flow_past_a_sphere_converges_at_the_same_orders_and_its_drag_is_six_pi() {
    let exact = StokesSphere { stream: Point::<2>::new(1.0, 0.0) };
    assert_orders("Stokes sphere", &[0.4, 0.2, 0.1, 0.05], SLACK, |size| {
        let domain = Domain::HalfDisc { center: 0.0, radius: 3.0 };
        let sphere = PlacedShape {
            name: "sphere".to_owned(),
            shape: Shape::Sphere { radius: 1.0 },
            center: Point::<2>::zeros(),
            angle: 0.0,
            size: None,
        };
        let mesh = generate(&domain, &[sphere], &uniform(size)).expect("a shell is meshed");
        let sides = sides(&mesh, move |place, time| exact.velocity(place, time));
        let problem = fluid_only(&mesh, sides, 0.0, 1.0, Metric::Revolved);
        errors(&mesh, &solve(&problem, &mesh), &exact, 0.0, Metric::Revolved)
    });
}

#[test]
fn a_manufactured_axisymmetric_flow_with_convection_converges_at_the_same_orders() {
    static EXACT: SwirlingCells = SwirlingCells { density: 1.0, viscosity: 0.1 };
    assert_orders("toroidal cells", &[0.2, 0.1, 0.05], SLACK, |size| {
        let domain = Domain::Cylinder { x: [-0.5, 1.0], radius: 1.0, periodic_x: false };
        let mesh = generate(&domain, &[], &uniform(size)).expect("a cylinder is meshed");
        let sides = sides(&mesh, move |place, time| EXACT.velocity(place, time));
        let mut problem =
            fluid_only(&mesh, sides, EXACT.density, EXACT.viscosity, Metric::Revolved);
        problem.force = Some(Box::new(|place, _| EXACT.force(place)));
        errors(&mesh, &solve(&problem, &mesh), &EXACT, 0.0, Metric::Revolved)
    });
}

/// Traction-free and do-nothing sides differ by mu (grad u)^T n, which Poiseuille flow shows.
#[test]
fn a_traction_free_outlet_bends_poiseuille_flow_and_a_do_nothing_outlet_does_not() {
    let (min, max) = (Point::<2>::new(0.0, -1.0), Point::<2>::new(1.0, 1.0));
    let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
    let mesh = generate(&domain, &[], &uniform(0.2)).expect("a rectangle is meshed");
    let crossflow = |outlet: Side<2>| {
        let mut sides = sides(&mesh, |_, _| Point::<2>::zeros());
        let parabola =
            Box::new(|place: &Point<2>, _| Point::<2>::new(1.0 - place[1] * place[1], 0.0));
        sides[0] = Some(Side::Velocity { profile: parabola, is_wall: false });
        sides[1] = Some(outlet);
        sides[2] = Some(Side::Velocity { profile: rest(), is_wall: true });
        let solution = solve(&fluid_only(&mesh, sides, 0.0, 1.0, Metric::Cartesian), &mesh);
        solution.velocity.iter().map(|velocity| velocity[1].abs()).fold(0.0, f64::max)
    };
    assert!(crossflow(Side::DoNothing) < 1e-12);
    assert!(crossflow(Side::TractionFree) > 0.05);
}
