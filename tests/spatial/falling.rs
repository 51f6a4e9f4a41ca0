//! A free body that falls through a mesh of tetrahedra, which follows it and is replaced on the way.

use alewife_core::run::{RunSummary, simulate};
use nalgebra::Vector3;
use tests::cases::{case, last};
use tests::figure;

/// Step (s) and sizes of cells, over those on which two radii are a long way.
const COARSE: [f64; 2] = [0.1, 1.5];
const FINE: [f64; 2] = [0.05, 1.0];

/// A body released from rest in a large container, pulled along (0.48, 0.6, 0.64).
fn fall(shape: &str, weight: f64, frame: &str, [step, scale]: [f64; 2]) -> RunSummary {
    let [x, y, z] = [0.48, 0.6, 0.64].map(|part| part * weight);
    let text = format!(
        r#"
        title = "a body falls through its mesh"
        geometry = "spatial"
        {frame}
        fluid = {{ model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [{x}, {y}, {z}] }}
        domain.sphere = {{ radius = 20.0 }}
        boundary = {{ wall = "no-slip" }}
        mesh = {{ size = 5.0, surface = 0.4, growth = 0.45, scale = {scale} }}
        time.unsteady = {{ step = {step}, end = 1.0 }}
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
fn agrees_with_the_frame_that_travels_along(shape: &str, weight: f64, sizes: [f64; 2], most: f64) {
    let through = fall(shape, weight, "", sizes);
    let along = fall(shape, weight, "frame = \"body\"", sizes);
    for quantity in ["velocity.", "force."] {
        let [one, other] = [&through, &along].map(|outcome| vector(outcome, quantity));
        let difference = (one - other).norm() / vector(&along, quantity).norm();
        let name = shape.split('.').nth(1).unwrap_or(shape);
        figure!(difference, "{name}, step {}: {}", sizes[0], quantity.trim_end_matches('.'));
        assert!(difference < most, "{quantity} {one} {other}");
    }
    assert!(last(&through, "flow.remeshes") >= 1.0);
}

const SPHERE: &str = "shape.sphere.radius = 1.0";
const ELLIPSOID: &str = "shape.ellipsoid.semi_axes = [1.2, 0.8, 0.6]";

#[test]
fn a_body_on_a_coarse_mesh_falls_as_in_a_frame_that_travels_along() {
    agrees_with_the_frame_that_travels_along(ELLIPSOID, 40.0, COARSE, 3e-3);
}

#[test]
#[ignore = "long: 10 s; small: a_body_on_a_coarse_mesh_falls_as_in_a_frame_that_travels_along"]
fn a_sphere_that_falls_by_two_radii_falls_as_in_a_frame_that_travels_along() {
    agrees_with_the_frame_that_travels_along(SPHERE, 30.0, FINE, 3e-3);
}

#[test]
#[ignore = "long: 30 s; small: a_body_on_a_coarse_mesh_falls_as_in_a_frame_that_travels_along"]
fn an_ellipsoid_that_falls_and_turns_falls_as_in_a_frame_that_travels_along() {
    agrees_with_the_frame_that_travels_along(ELLIPSOID, 40.0, FINE, 3e-3);
}

/// Jumps of the force on a sphere that sinks from rest, on each new mesh, over the force.
fn jumps(scale: f64, end: f64) -> Vec<f64> {
    let text = format!(
        r#"
        title = "a sphere sinks through its mesh"
        geometry = "spatial"
        fluid = {{ model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [9.0, 6.0, 3.0] }}
        domain.box = {{ min = [-4.0, -4.0, -4.0], max = [4.0, 4.0, 4.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }}
        mesh = {{ size = 1.5, surface = 0.3, growth = 0.5, scale = {scale}, moving.quality = 0.9 }}
        time.unsteady = {{ step = 0.05, end = {end} }}
        [[body]]
        name = "sphere"
        shape.sphere.radius = 1.0
        center = [-0.6, -0.4, -0.2]
        density = 2.0
        motion = "free"
    "#
    );
    let outcome = simulate::<3>(&case(&text), &mut []).expect("the case runs");
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
    figure!(jumps.iter().copied().fold(0.0, f64::max), "largest jump, scale {scale}");
    jumps
}

/// The force on a new mesh continues as on the one before.
#[test]
fn forces_on_a_coarse_mesh_go_on_smoothly_across_a_new_one() {
    let jumps = jumps(1.6, 1.0);
    // 1.0e-2 was seen: they fall with the size of the cells
    assert!(!jumps.is_empty() && jumps.iter().all(|jump| *jump < 0.015), "{jumps:?}");
}

#[test]
#[ignore = "long: 13 s; small: forces_on_a_coarse_mesh_go_on_smoothly_across_a_new_one"]
fn forces_in_space_go_on_smoothly_across_a_new_mesh() {
    let jumps = jumps(1.0, 1.5);
    assert!(jumps.len() >= 2, "{} meshes", jumps.len());
    assert!(jumps.iter().all(|jump| *jump < 0.01), "{jumps:?}");
}
