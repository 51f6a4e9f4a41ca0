//! What a new mesh in space leaves as it was: momentum and angular momentum of fluid and bodies together.

use alewife_core::body::Wrench;
use alewife_core::simulation::{Attempt, Simulation, build_mesh, simulation_on};
use nalgebra::Vector3;
use tests::cases::case;

use super::{DENSITY, fluid_momentum};

/// Two ellipsoids in a periodic box, pulled and turned in opposite ways; any motion asks for a new mesh.
fn pulled_apart(scale: f64) -> Simulation<3> {
    let model = case(&format!(
        r#"
        title = "two ellipsoids, opposite loads"
        geometry = "spatial"
        fluid = {{ model = "navier-stokes", density = {DENSITY}, viscosity = 0.1 }}
        domain.box = {{ min = [-1.0, -1.0, -1.0], max = [1.0, 1.0, 1.0] }}
        boundary.left.periodic = "right"
        boundary.bottom.periodic = "top"
        boundary.back.periodic = "front"
        mesh = {{ size = 0.45, surface = 0.2, growth = 0.5, gap_layers = 1, scale = {scale}, moving.quality = 0.9999 }}
        time.unsteady = {{ step = 0.04, end = 1.0 }}
        [[body]]
        name = "one"
        shape.ellipsoid.semi_axes = [0.3, 0.2, 0.25]
        center = [-0.45, 0.1, -0.1]
        density = 2.0
        motion = "free"
        force = [-0.4, 0.5, 0.3]
        torque = [0.05, 0.02, -0.04]
        [[body]]
        name = "two"
        shape.ellipsoid.semi_axes = [0.2, 0.3, 0.25]
        center = [0.4, -0.1, 0.15]
        density = 2.0
        motion = "free"
        force = [0.4, -0.5, -0.3]
        torque = [0.03, -0.05, 0.02]
        "#
    ));
    let mesh = build_mesh::<3>(&model).expect("it is meshed");
    simulation_on(&model, mesh).expect("the case is a problem")
}

/// Momentum of bodies, and their angular momentum about the origin.
fn momentum_of_bodies(simulation: &Simulation<3>) -> Wrench {
    let state = &simulation.state;
    let mut sum = Wrench::default();
    for (body, (pose, twist)) in
        simulation.problem.bodies.iter().zip(state.poses.iter().zip(&state.now.twists))
    {
        let own = Wrench::from_vector(&body.inertia.momentum(pose, twist));
        sum.force += own.force;
        sum.torque += own.torque + pose.center.cross(&own.force);
    }
    sum
}

/// What a new mesh changes, over what bodies have.
#[derive(Debug)]
struct Jump {
    momentum: f64,
    angular_momentum: f64,
}

/// In a step so small that nothing moves in it, all that changes is due to the new mesh before it.
fn jump(scale: f64) -> Jump {
    let mut simulation = pulled_apart(scale);
    let mut step = |size: f64| {
        let attempt = simulation.try_step(size, f64::INFINITY).expect("the step can be made");
        assert!(matches!(attempt, Attempt::Made(_)));
        let fluid = fluid_momentum(&simulation.state, &Vector3::zeros());
        let bodies = momentum_of_bodies(&simulation);
        let force = fluid.force + bodies.force;
        let all = Wrench { force, torque: fluid.torque + bodies.torque };
        (simulation.state.remeshes, all)
    };
    let (before, old) = (0..5).map(|_| step(0.04)).last().expect("steps were made");
    let (after, new) = step(1e-7);
    assert_eq!(after, before + 1);
    let one = &simulation.problem.bodies[0];
    let speed = simulation.state.now.twists[0].linear.norm();
    let size = one.inertia.mass * speed;
    // The same at the distance of the bodies from the origin
    let arm = simulation.state.poses[0].center.norm();
    Jump {
        momentum: (new.force - old.force).norm() / size,
        angular_momentum: (new.torque - old.torque).norm() / (arm * size),
    }
}

#[test]
fn a_new_mesh_keeps_momentum_and_angular_momentum_of_fluid_and_bodies() {
    let (coarse, fine) = (jump(1.0), jump(0.7));
    println!("{coarse:?}\n{fine:?}");
}
