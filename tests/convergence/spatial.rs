//! Orders in space of tetrahedra, in a box and beside curved bodies.

use alewife_core::body::MeshPoses;
use alewife_core::coupling::{Problem, ResidualAt};
use alewife_core::space::Metric;
use alewife_mesh::spatial::{Body, Domain, Shape, generate};
use alewife_mesh::{BoundaryKind, Mesh, Point, Sizing};
use nalgebra::Isometry3;
use tests::exact::{EthierSteinman, Exact, StokesSphere};
use tests::{Errors, Study, errors, fluid_only, sides, steady_with, workspace};

use super::space::{SETTINGS, assert_orders, solve};

/// Sizes of tetrahedra follow the lattice they are cut from, and with it what is wanted only roughly.
const SLACK: f64 = 0.2;

const SUSTAINED: EthierSteinman = EthierSteinman { viscosity: 0.2 };

/// Cells around a sphere in the origin, however it is curved.
fn mesh(domain: &Domain, radius: Option<f64>, sizing: Sizing<3>) -> Mesh<3> {
    let sphere = |radius| Body::new("sphere", Shape::Sphere { radius }, Isometry3::identity());
    let bodies: Vec<Body> = radius.map(sphere).into_iter().collect();
    let sizing = Sizing { gap_layers: 1.0, turn: 1.0, ..sizing };
    generate(domain, &bodies, &sizing).expect("a sphere is meshed")
}

fn uniform(size: f64) -> Sizing<3> {
    Sizing::graded(size, 0.3, size)
}

fn cube() -> Domain {
    Domain::walls(Point::<3>::repeat(-1.0), Point::<3>::repeat(1.0))
}

/// All velocities of the boundary are given, on the body too.
fn sustained(mut mesh: Mesh<3>) -> Errors {
    for boundary in &mut mesh.topology_mut().boundaries {
        boundary.kind = BoundaryKind::Side;
    }
    let sides = sides(&mesh, |place, time| SUSTAINED.velocity(place, time));
    let fluid = fluid_only(&mesh, sides, 1.0, SUSTAINED.viscosity, Metric::Cartesian);
    let force = Box::new(|place: &Point<3>, _| SUSTAINED.sustaining_force(place));
    let problem = Problem { force: Some(force), ..fluid };
    errors(&mesh, &solve(&problem, &mesh), &SUSTAINED, 0.0, Metric::Cartesian)
}

#[test]
fn the_flow_of_ethier_and_steinman_converges_on_coarse_meshes() {
    assert_orders("Ethier-Steinman, coarse", &[0.5, 0.35, 0.25], SLACK, |size| {
        sustained(mesh(&cube(), None, uniform(size)))
    });
}

#[test]
#[ignore = "long: 10 s; small: the_flow_of_ethier_and_steinman_converges_on_coarse_meshes"]
fn the_flow_of_ethier_and_steinman_converges_at_the_orders_of_taylor_hood_in_a_box() {
    assert_orders("Ethier-Steinman", &[0.5, 0.35, 0.25, 0.18], SLACK, |size| {
        sustained(mesh(&cube(), None, uniform(size)))
    });
}

/// What is curved is tested daily by the flow past a sphere.
#[test]
#[ignore = "long: 20 s; small: the_flow_of_ethier_and_steinman_converges_on_coarse_meshes"]
fn the_flow_of_ethier_and_steinman_converges_at_the_same_orders_beside_a_sphere() {
    assert_orders("Ethier-Steinman beside a sphere", &[0.44, 0.31, 0.22, 0.16], SLACK, |size| {
        sustained(mesh(&cube(), Some(0.6), uniform(size)))
    });
}

/// The drag has twice the order of the H1 norm, since the residual form is superconvergent.
#[test]
fn stokes_flow_past_a_sphere_converges_at_the_same_orders_and_its_drag_at_fourth() {
    let exact = StokesSphere { stream: Point::<3>::new(0.48, -0.6, 0.64) };
    let mut drag = Study { sizes: Vec::new(), errors: Vec::new() };
    assert_orders("Stokes sphere in space", &[0.5, 0.4, 0.3], SLACK, |size| {
        let domain = Domain::Ball { center: Point::<3>::zeros(), radius: 1.6 };
        let mesh = mesh(&domain, Some(1.0), Sizing::graded(0.3 * size, 0.6 * size, size));
        let sides = sides(&mesh, move |place, time| exact.velocity(place, time));
        let problem = fluid_only(&mesh, sides, 0.0, 1.0, Metric::Cartesian);
        let mut work = workspace(&problem, &mesh);
        let flow = steady_with(&mut work, &problem, &SETTINGS, false);
        let poses = MeshPoses::of([problem.bodies[0].pose]);
        let at = ResidualAt { solution: &flow.solution, residual: &flow.residual, time: 0.0 };
        let loads = work.system.surface_loads(&problem, &mesh, &poses, at);
        let errors = errors(&mesh, &flow.solution, &exact, 0.0, Metric::Cartesian);
        let off = loads.bodies[0].load.force / (6.0 * std::f64::consts::PI) - exact.stream;
        drag.sizes.push(size);
        drag.errors.push(off.norm());
        errors
    });
    drag.assert_order("drag in space", 4.0, 0.5);
}
