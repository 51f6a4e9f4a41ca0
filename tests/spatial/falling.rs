//! A free body that falls through a mesh of tetrahedra, which follows it and is replaced on the way.

use alewife_core::run::{RunSummary, simulate};
use nalgebra::Vector3;
use tests::cases::{case, last};

/// A body released from rest in a large container, pulled along (0.48, 0.6, 0.64).
fn fall(shape: &str, weight: f64, frame: &str) -> RunSummary {
    let [x, y, z] = [0.48, 0.6, 0.64].map(|part| part * weight);
    let text = format!(
        r#"
        title = "a body falls through its mesh"
        geometry = "spatial"
        {frame}
        fluid = {{ model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [{x}, {y}, {z}] }}
        domain.sphere = {{ radius = 20.0 }}
        boundary = {{ wall = "no-slip" }}
        mesh = {{ size = 5.0, surface = 0.4, growth = 0.45 }}
        time.unsteady = {{ step = 0.05, end = 1.0 }}
        [[body]]
        name = "body"
        {shape}
        center = [0.1, -0.1, 0.2]
        density = 2.0
        motion = "free"
        "#
    );
    simulate::<3>(&case(&text), &mut []).expect("the case runs")
}

fn vector(outcome: &RunSummary, quantity: &str) -> Vector3<f64> {
    let part = |axis: &str| last(outcome, &format!("body.{quantity}{axis}"));
    Vector3::new(part("x"), part("y"), part("z"))
}

/// In a container so large that its walls do not matter it makes no difference whether mesh and container
/// travel along.
fn agrees_with_the_frame_that_travels_along(shape: &str, weight: f64) {
    let through = fall(shape, weight, "");
    let along = fall(shape, weight, "frame = \"body\"");
    for quantity in ["velocity.", "force."] {
        let [one, other] = [&through, &along].map(|outcome| vector(outcome, quantity));
        let difference = (one - other).norm() / vector(&along, quantity).norm();
        println!("{shape}: {quantity} {difference:.1e}");
        assert!(difference < 3e-3, "{quantity} {one} {other}");
    }
    assert!(last(&through, "flow.remeshes") >= 1.0);
}

#[test]
fn a_sphere_that_falls_by_two_radii_falls_as_in_a_frame_that_travels_along() {
    agrees_with_the_frame_that_travels_along("shape.sphere.radius = 1.0", 30.0);
}

#[test]
fn an_ellipsoid_that_falls_and_turns_falls_as_in_a_frame_that_travels_along() {
    let shape = "shape.ellipsoid.semi_axes = [1.2, 0.8, 0.6]";
    agrees_with_the_frame_that_travels_along(shape, 40.0);
}

/// A sphere that sinks from rest: the force on it on a new mesh goes on as on the one before.
#[test]
fn forces_in_space_go_on_smoothly_across_a_new_mesh() {
    let text = r#"
        title = "a sphere sinks through its mesh"
        geometry = "spatial"
        fluid = { model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [9.0, 6.0, 3.0] }
        domain.box = { min = [-4.0, -4.0, -4.0], max = [4.0, 4.0, 4.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }
        mesh = { size = 1.5, surface = 0.3, growth = 0.5, moving.quality = 0.9 }
        time.unsteady = { step = 0.05, end = 1.5 }
        [[body]]
        name = "sphere"
        shape.sphere.radius = 1.0
        center = [-0.6, -0.4, -0.2]
        density = 2.0
        motion = "free"
    "#;
    let outcome = simulate::<3>(&case(text), &mut []).expect("the case runs");
    let column = |name: &str| outcome.series.column(name).expect("it is measured");
    let remeshes = column("flow.remeshes");
    let force = ["x", "y", "z"].map(|axis| column(&format!("sphere.force.{axis}")));
    let at = |step: usize| Vector3::from_fn(|axis, _| force[axis][step]);
    let mut jumps: Vec<f64> = Vec::new();
    for step in 3..remeshes.len() {
        if remeshes[step] > remeshes[step - 1] && remeshes[step - 1] == remeshes[step - 3] {
            // The first force on the new mesh against the parabola through those before
            let ahead = (at(step - 1) - at(step - 2)) * 3.0 + at(step - 3);
            jumps.push((at(step) - ahead).norm() / at(step).norm());
        }
    }
    println!("jumps {jumps:?}");
    assert!(jumps.len() >= 2, "{} meshes", jumps.len());
    assert!(jumps.iter().all(|jump| *jump < 0.01), "{jumps:?}");
}
