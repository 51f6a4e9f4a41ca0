//! What a new mesh in space leaves as it was: the momentum of fluid and bodies together.

use alewife_core::body::Wrench;
use alewife_core::run::{Attempt, Simulation, build_mesh, simulation_on};
use nalgebra::Vector3;
use tests::cases::case;
use tests::figure;

use super::{DENSITY, fluid_angular_momentum, fluid_momentum};

/// Two ellipsoids, pulled and turned in opposite ways.
const PULLED_APART: &str = r#"
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
"#;
/// An ellipsoid that is turned, alone.
const TURNED: &str = r#"
[[body]]
name = "one"
shape.ellipsoid.semi_axes = [0.35, 0.25, 0.3]
center = [0.1, -0.05, 0.0]
density = 2.0
motion = "free"
torque = [0.05, 0.02, -0.04]
"#;

/// Bodies in a periodic box; any motion asks for a new mesh.
fn in_a_box(bodies: &str, scale: f64) -> Simulation<3> {
    let model = case(&format!(
        r#"
        title = "bodies in a periodic box"
        geometry = "spatial"
        fluid = {{ model = "navier-stokes", density = {DENSITY}, viscosity = 0.1 }}
        domain.box = {{ min = [-1.0, -1.0, -1.0], max = [1.0, 1.0, 1.0] }}
        boundary.left.periodic = "right"
        boundary.bottom.periodic = "top"
        boundary.back.periodic = "front"
        mesh = {{ size = 0.45, surface = 0.2, growth = 0.5, gap_layers = 1, scale = {scale}, moving.quality = 0.9999 }}
        time.unsteady = {{ step = 0.04, end = 1.0 }}
        {bodies}"#
    ));
    let mesh = build_mesh::<3>(&model).expect("it is meshed");
    simulation_on(&model, mesh).expect("the case is a problem")
}

/// Momentum of fluid and bodies together.
fn momentum(simulation: &Simulation<3>) -> Vector3<f64> {
    let state = &simulation.state;
    let of_bodies = simulation.problem.bodies.iter().zip(&state.now.twists);
    let of_bodies: Vector3<f64> =
        of_bodies.map(|(body, twist)| twist.linear * body.inertia.mass).sum();
    fluid_momentum(state, &Vector3::zeros()).force + of_bodies
}

/// Angular momentum of the only body and of the fluid around it: as far as an arm of 0.4 whole, then less, and none
/// from 0.95 on.
///
/// The whole of a periodic box has none: its mesh is cut open elsewhere each time, and what is on the other side of
/// a cut has another arm; besides, the pressure of the projection turns a box. The rotation of spheres about the
/// body, each as fast as it likes, is free of divergence and one field on the torus, as the projection's tests are.
fn angular_momentum(simulation: &Simulation<3>) -> Vector3<f64> {
    let state = &simulation.state;
    let body = &simulation.problem.bodies[0];
    let own = Wrench::from_vector(&body.inertia.momentum(&body.pose, &state.now.twists[0]));
    let nearest = |arm: Vector3<f64>| arm.map(|along| along - 2.0 * (along / 2.0).round());
    let share = |arm: f64| {
        let along = ((arm - 0.4) / 0.55).clamp(0.0, 1.0);
        1.0 - along.powi(3) * (10.0 - 15.0 * along + 6.0 * along.powi(2))
    };
    let arm = |position: Vector3<f64>| {
        let arm = nearest(position - body.pose.center);
        arm * share(arm.norm())
    };
    own.torque + fluid_angular_momentum(state, arm)
}

/// What a new mesh changes of a momentum, over `size`: in a step so small that nothing moves in it, and
/// without walls, all that changes is due to the mesh made before it.
fn jump(
    bodies: &str,
    scale: f64,
    momentum: impl Fn(&Simulation<3>) -> Vector3<f64>,
    size: impl Fn(&Simulation<3>) -> f64,
) -> f64 {
    let mut simulation = in_a_box(bodies, scale);
    let step = |simulation: &mut Simulation<3>, size: f64| {
        let attempt = simulation.try_step(size, f64::INFINITY).expect("the step can be made");
        assert!(matches!(attempt, Attempt::Made(_)));
    };
    for _ in 0..5 {
        step(&mut simulation, 0.04);
    }
    let (meshes, before) = (simulation.state.remeshes, momentum(&simulation));
    step(&mut simulation, 1e-7);
    assert_eq!(simulation.state.remeshes, meshes + 1);
    (momentum(&simulation) - before).norm() / size(&simulation)
}

/// The projection onto the new mesh gives the fluid the momentum it had, to the accuracy of the step after it: without
/// that it loses 3.8e-4, and 8.1e-5 at 0.7 of the edges, as bodies and their velocities are held in it.
fn jump_of_momentum(scale: f64) -> f64 {
    let size = |simulation: &Simulation<3>| {
        simulation.problem.bodies[0].inertia.mass * simulation.state.now.twists[0].linear.norm()
    };
    jump(PULLED_APART, scale, momentum, size)
}

#[test]
fn a_new_coarse_mesh_keeps_momentum() {
    let coarse = jump_of_momentum(1.5);
    figure!(coarse, "momentum, coarse");
    assert!(coarse < 1e-6, "{coarse:e}");
}

#[test]
#[ignore = "long: 10 s; small: a_new_coarse_mesh_keeps_momentum"]
fn a_new_mesh_keeps_the_momentum_of_fluid_and_bodies() {
    let [coarse, fine] = [1.0, 0.7].map(jump_of_momentum);
    figure!(fine, "momentum, fine");
    assert!(coarse < 1e-6 && fine < 1e-6, "{coarse:e} {fine:e}");
}

/// As above for angular momentum, over that of the body, which no condition keeps: the error of taking a quadratic field
/// over at the points of a rule is left, of third order: a third at 0.7 of the edges.
fn jump_of_angular_momentum(scale: f64) -> f64 {
    let size = |simulation: &Simulation<3>| {
        let body = &simulation.problem.bodies[0];
        let momentum = body.inertia.momentum(&body.pose, &simulation.state.now.twists[0]);
        Wrench::from_vector(&momentum).torque.norm()
    };
    jump(TURNED, scale, angular_momentum, size)
}

#[test]
fn a_new_coarse_mesh_keeps_angular_momentum() {
    // 3.1e-4 was seen
    let coarse = jump_of_angular_momentum(1.0);
    figure!(coarse, "angular momentum, coarse");
    assert!(coarse < 2e-3, "{coarse:e}");
}

#[test]
#[ignore = "long: 9 s; small: a_new_coarse_mesh_keeps_angular_momentum"]
fn a_new_mesh_keeps_the_angular_momentum_of_a_body_and_the_fluid_around_it() {
    let [coarse, fine] = [1.0, 0.7].map(jump_of_angular_momentum);
    figure!(fine, "angular momentum, fine");
    // 3.1e-4 and 7.4e-5 were seen
    assert!(coarse < 2e-3, "{coarse:e}");
    assert!(fine < 0.6 * coarse, "{coarse:e} {fine:e}");
}

/// Steps that each mesh lasted for bodies in a closed box of these half sides (m), of a number of steps of a size (s).
fn lives(half_sides: [f64; 3], bodies: &str, steps: usize, size: f64) -> Vec<usize> {
    let [x, y, z] = half_sides;
    let end = steps as f64 * size;
    let model = case(&format!(
        r#"
        title = "spheres that move steadily"
        geometry = "spatial"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-{x:?}, -{y:?}, -{z:?}], max = [{x:?}, {y:?}, {z:?}] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }}
        mesh = {{ size = 1.5, surface = 0.5, growth = 0.6, gap_layers = 1 }}
        time.unsteady = {{ step = {size:?}, end = {end:?} }}
        {bodies}"#
    ));
    let mesh = build_mesh::<3>(&model).expect("it is meshed");
    let mut simulation = simulation_on(&model, mesh).expect("the case is a problem");
    let mut lives = vec![0];
    for _ in 0..steps {
        let meshes = simulation.state.remeshes;
        let attempt = simulation.try_step(size, f64::INFINITY).expect("the step can be made");
        assert!(matches!(attempt, Attempt::Made(_)));
        if simulation.state.remeshes > meshes {
            lives.push(0);
        }
        *lives.last_mut().expect("there is one") += 1;
    }
    lives
}

/// They are best half-way through their life, the first one at its beginning.
#[test]
fn meshes_of_bodies_that_move_on_last_longer_than_the_first() {
    let sphere = r#"
        [[body]]
        name = "sphere"
        shape.sphere.radius = 1.0
        center = [-3.0, 0.1, -0.1]
        motion.imposed = { velocity = [1.0, 0.0, 0.0] }
        "#;
    let lives = lives([5.0, 2.5, 2.5], sphere, 60, 0.1);
    println!("{lives:?}");
    let replaced = &lives[1..lives.len() - 1];
    assert!(replaced.len() >= 2, "{lives:?}");
    let mean = replaced.iter().sum::<usize>() as f64 / replaced.len() as f64;
    figure!(mean / lives[0] as f64, "life of a mesh over that of the first");
    assert!(mean > 1.35 * lives[0] as f64, "{lives:?}");
}

/// The mesh rolls with them: two meshes for a way of ten thicknesses of the film. Five where cells in it are sheared.
#[test]
fn spheres_that_pass_each_other_keep_their_mesh() {
    let spheres = r#"
        [[body]]
        name = "lower"
        shape.sphere.radius = 1.0
        center = [-0.3, -1.05, 0.0]
        motion.imposed = { velocity = [0.5, 0.0, 0.1] }
        [[body]]
        name = "upper"
        shape.sphere.radius = 1.0
        center = [0.3, 1.05, 0.0]
        motion.imposed = { velocity = [-0.5, 0.0, -0.1] }
        "#;
    let lives = lives([3.0, 4.0, 3.0], spheres, 50, 0.02);
    println!("{lives:?}");
    assert!(lives.len() <= 3, "{lives:?}");
}
