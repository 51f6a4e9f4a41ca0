//! Fluid and a free body in three dimensions, on meshes of a few tetrahedra.

mod contact;
mod deforming;
mod falling;
mod gaps;
mod imported;
mod iterative;
mod joints;
mod mirror;
mod periodic;
mod reciprocity;
mod remesh;
mod rods;
mod rotation;
mod scene;
mod walks;

use alewife_core::body::{Inertia, Pose, Twist, Wrench};
use alewife_core::case::{Convection, Scheme};
use alewife_core::coupling::{Problem, RigidBody, Side};
use alewife_core::motion::{MotionKind, Transfer};
use alewife_core::motion::{MotionSettings, MovingMesh};
use alewife_core::run::{Attempt, CellBound, Simulation, StepControl, StepScheme};
use alewife_core::space::{CellValues, Metric, Tables};
use alewife_core::state::{InitialLevels, State};
use alewife_core::step::MeshPath;
use alewife_core::time::Bdf;
use alewife_mesh::{BoundaryId, Mesh, Point};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use scene::Bipyramid;
use tests::{Stepping, fluid_only, three_tetrahedra, two_tetrahedra, workspace};

const DENSITY: f64 = 1.3;

/// A free body on one facet of the mesh, and no traction on the others.
fn problem(mesh: &Mesh<3>, has_convection: bool) -> Problem<3> {
    let sides = vec![None, Some(Side::TractionFree)];
    let turn = UnitQuaternion::from_euler_angles(0.3, -0.5, 1.1);
    let pose = Pose::spatial(Vector3::new(0.6, 0.9, -0.2), turn);
    let tensor = Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.8, 0.3, -0.2, 0.3, 1.7);
    let body = RigidBody {
        inertia: Inertia { mass: 2.1, tensor },
        ..RigidBody::held("body", BoundaryId::new(0), pose).free()
    };
    let fluid = fluid_only(mesh, sides, DENSITY, 0.7, Metric::Cartesian);
    Problem { bodies: vec![body], has_convection, ..fluid }
}

/// Momentum of the fluid, and its angular momentum about a point (m).
fn fluid_momentum(state: &State<3>, about: &Vector3<f64>) -> Wrench {
    let mut momentum = Wrench::default();
    for_each_part(state, |position, part| {
        momentum.force += part;
        momentum.torque += (position - about).cross(&part);
    });
    momentum
}

/// Angular momentum of the fluid with an arm (m) for each point.
fn fluid_angular_momentum(
    state: &State<3>,
    arm: impl Fn(Vector3<f64>) -> Vector3<f64>,
) -> Vector3<f64> {
    let mut sum = Vector3::zeros();
    for_each_part(state, |position, part| sum += arm(position).cross(&part));
    sum
}

/// Calls `add` with points of the fluid (m) and the momentum of the fluid around them.
fn for_each_part(state: &State<3>, mut add: impl FnMut(Vector3<f64>, Vector3<f64>)) {
    let (tables, mut values) = (Tables::new(Metric::Cartesian), CellValues::default());
    for cell in state.mesh.cell_ids() {
        let nodes = state.mesh.cell(cell);
        values.for_each_point(&tables, &state.mesh, cell, |at| {
            let velocity = nodes.iter().zip(at.phi);
            let velocity: Vector3<f64> =
                velocity.map(|(&node, phi)| state.now.velocity[node] * *phi).sum();
            add(at.position, velocity * (DENSITY * at.dx));
        });
    }
}

#[test]
fn a_load_on_a_free_body_becomes_momentum_of_body_and_fluid() {
    let mesh = two_tetrahedra();
    let mut problem = problem(&mesh, false);
    let load = Wrench { force: Vector3::new(0.4, -1.1, 0.7), torque: Vector3::new(-0.6, 0.2, 0.9) };
    problem.bodies[0].load = load;
    let mut run = Stepping::new(&problem, &mesh, Convection::Extrapolated, MeshPath::Fixed);
    let step = 0.05;
    let report = run.advance(Bdf::first_order(step));

    let (body, state) = (&problem.bodies[0], &run.state);
    let center = body.pose.center;
    let own = Wrench::from_vector(&body.inertia.momentum(&body.pose, &state.now.twists[0]));
    let fluid = fluid_momentum(state, &center);
    // Rigid motions are tests of the discrete equations: the balance holds to rounding
    let force = (own.force + fluid.force) / step - load.force;
    let torque = (own.torque + fluid.torque) / step - load.torque;
    assert!(force.norm() < 1e-12 && torque.norm() < 1e-12, "{force} {torque}");
    let [part, turned] = [fluid.force.norm(), fluid.torque.norm()].map(|sum| sum / step);
    assert!(part > 0.01 && turned > 0.01, "the fluid takes {part} N and {turned} N m");
    // What the fluid gains, the body loses
    let on_body = report.loads.bodies[0].load;
    assert!((on_body.force + fluid.force / step).norm() < 1e-12);
    assert!((on_body.torque + fluid.torque / step).norm() < 1e-12);
}

#[test]
fn fields_of_the_element_are_transferred_exactly_between_tetrahedra() {
    let (old, new) = (two_tetrahedra(), three_tetrahedra());
    let transfer = Transfer::new(&old, &new, &[]).expect("the meshes fill the same region");
    let quadratic = |x: &Point<3>| {
        Point::<3>::new(x[0] * x[1] - x[2], x[2] * x[2] + 0.5 * x[0], x[1] * x[2] - x[0] * x[0])
    };
    let linear = |x: &Point<3>| 1.0 + 2.0 * x[0] - 0.3 * x[1] + 0.7 * x[2];
    let velocity: Vec<_> = old.nodes.iter().map(quadratic).collect();
    let pressure: Vec<_> = old.nodes[..old.n_vertices].iter().map(linear).collect();
    for (found, at) in transfer.quadratic(&velocity).iter().zip(&new.nodes) {
        assert!((found - quadratic(at)).norm() < 1e-13);
    }
    for (found, at) in transfer.linear(&pressure).iter().zip(&new.nodes) {
        assert!((found - linear(at)).abs() < 1e-13);
    }
}

/// A simulation on a mesh that follows its body, in uniform flow.
fn in_uniform_flow(velocity: &Vector3<f64>, convection: Convection) -> Simulation<3> {
    let mesh = two_tetrahedra();
    let problem = problem(&mesh, true);
    let mut state = State::at_rest(&problem, mesh.clone());
    let mut flow = state.now.clone();
    flow.velocity.fill(*velocity);
    flow.twists = vec![Twist { linear: *velocity, ..Twist::default() }];
    state.begin(InitialLevels::steady(flow));
    let work = workspace(&problem, &mesh);
    let poses = state.in_mesh(&state.poses);
    let settings = MotionSettings { kind: MotionKind::default(), turns: vec![true] };
    let scene = Box::new(Bipyramid::of(&mesh, poses[0]));
    let moving = MovingMesh::new(&mesh, scene, settings, poses, 0.0).expect("the mesh can move");
    let scheme = StepScheme { method: Scheme::Bdf2, convection, unknown_frame: false };
    let moving_mesh = Some(moving);
    let control = StepControl::default();
    Simulation {
        problem,
        state,
        control,
        work,
        moving_mesh,
        law: None,
        scheme,
        cell_bound: CellBound::none(),
        is_fresh: true,
        tracers: None,
        scalars: None,
        stop: None,
    }
}

#[test]
fn uniform_flow_carries_a_free_body_along_through_steps_and_a_new_mesh() {
    let velocity = Vector3::new(0.8, -0.3, 0.5);
    for convection in [Convection::Extrapolated, Convection::Newton] {
        let mut simulation = in_uniform_flow(&velocity, convection);
        for size in [0.02, 0.03, 0.025] {
            let attempt = simulation.try_step(size, f64::INFINITY).expect("the step can be made");
            assert!(matches!(attempt, Attempt::Made(_)));
        }
        let state = &simulation.state;
        assert_eq!((state.step, state.remeshes, state.mesh.n_cells()), (3, 1, 3));
        let body = &simulation.problem.bodies[0];
        let pose = body.pose.shifted(&(velocity * state.time));
        let off = state.poses[0].displacement_from(&pose);
        assert!(off.norm() < 1e-12, "{off}");
        for found in &state.now.velocity {
            assert!((found - velocity).norm() < 1e-11, "{found}");
        }
        let spin = state.now.twists[0].angular;
        assert!((state.now.twists[0].linear - velocity).norm() < 1e-12 && spin.norm() < 1e-12);
        assert!(state.now.pressure.iter().all(|pressure| pressure.abs() < 1e-10));
    }
}
