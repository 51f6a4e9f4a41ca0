//! Gradients in periodic domains, in given meshes, and of bodies with a magnetic moment, against differences.

use alewife_core::case::Case;
use alewife_core::gradient::{GradientTask, gradients};

use super::{agrees, compared, refusal};

/// A disc in Couette flow that repeats itself; it lies across the periodic side.
const COUETTE: &str = r#"
    title = "disc in periodic Couette flow"
    geometry = "planar"
    fluid = { model = "navier-stokes", viscosity = 0.5, density = 1.0 }
    domain.box = { min = [-1.0, -1.0], max = [1.0, 1.0] }
    boundary = { left = { periodic = "right" }, bottom = "no-slip", top = { velocity = { value = [1.0, 0.0] } } }
    mesh = { size = 0.4, surface = 0.12 }
    time.steady = {}
    [[body]]
    name = "disc"
    shape = { ellipse = { semi_axes = [0.35, 0.25] } }
    center = [0.95, 0.15]
    angle = 0.4
    motion = "held"
"#;

const NUMBERS: [&str; 6] = [
    "boundary.top.velocity.value.0",
    "body.0.shape.ellipse.semi_axes.0",
    "body.0.center.1",
    "body.0.angle",
    "fluid.viscosity",
    "fluid.density",
];

#[test]
fn loads_across_periodic_sides_follow_numbers() {
    agrees(COUETTE, &["disc.force.x", "disc.force.y", "disc.torque"], &NUMBERS, 1e-4);
    // All places along the period are the same place, but for the mesh
    let by = ["body.0.center.0", "body.0.center.1"];
    let of = ["disc.force.x".to_owned()];
    let by = by.map(str::to_owned);
    let read = |settings: &[String]| Case::parse("case.toml", COUETTE, settings);
    let found = gradients(&GradientTask { read: &read, of: &of, by: &by, checks: true }).unwrap();
    let [along, across] = [found[0].by[0], found[0].by[1]];
    assert!(along.abs() < 1e-2 * across.abs(), "{along} {across}");
    assert!((along - found[0].differences[0]).abs() < 1e-4 * across.abs(), "{found:?}");
}

#[test]
fn velocities_across_periodic_sides_follow_numbers() {
    let free = COUETTE.replace("motion = \"held\"", "motion = \"free\"");
    agrees(&free, &["disc.velocity.x", "disc.angular_velocity"], &NUMBERS, 1e-4);
    agrees(
        &free.replace("\"navier-stokes\"", "\"stokes\""),
        &["disc.velocity.x", "disc.velocity.y", "disc.angular_velocity"],
        &NUMBERS[..5],
        1e-4,
    );
}

/// A ball that is held between two plates, in a cell that repeats itself along both.
const CELL: &str = r#"
    title = "ball between plates"
    geometry = "spatial"
    fluid = { model = "stokes", viscosity = 2.0, density = 1.0 }
    domain.box = { min = [-1.5, -1.5, -1.5], max = [1.5, 1.5, 1.5] }
    boundary = { left = { periodic = "right" }, back = { periodic = "front" }, bottom = "no-slip", top = { velocity = { value = [1.0, 0.0, 0.5] } } }
    mesh = { size = 1.2, surface = 0.6 }
    time.steady = {}
    [[body]]
    name = "ball"
    shape = { ellipsoid = { semi_axes = [0.8, 0.6, 0.7] } }
    center = [1.4, 0.2, -1.3]
    motion = "held"
"#;

#[test]
fn loads_in_a_periodic_cell_in_space_follow_numbers() {
    let by =
        ["body.0.shape.ellipsoid.semi_axes.1", "body.0.center.1", "boundary.top.velocity.value.2"];
    agrees(CELL, &["ball.force.x", "ball.torque.z"], &by, 1e-4);
}

/// A ball in a box whose mesh is given.
const GIVEN: &str = r#"
    title = "ball in a given box"
    geometry = "spatial"
    fluid = { model = "stokes", viscosity = 1.0 }
    boundary = { wall = "no-slip" }
    mesh = { size = 0.9, surface = 0.35, growth = 0.6, gap_layers = 1 }
    time.steady = {}
    [[body]]
    name = "ball"
    shape = { sphere = { radius = 0.4 } }
    center = [0.1, -0.1, 0.05]
    motion = { imposed = { velocity = [1.0, 0.5, 0.0] } }
"#;

#[test]
fn loads_in_a_given_mesh_follow_numbers() {
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/../mesh/tests/msh/data/box-1-text.msh");
    let read = |settings: &[String]| {
        let mesh = format!("domain.mesh.file={mesh}");
        Case::parse("case.toml", GIVEN, &[&[mesh], settings].concat())
    };
    let of = ["ball.force.x", "ball.force.y"];
    let by = ["body.0.shape.sphere.radius", "body.0.center.0", "fluid.viscosity"];
    compared(&read, &of, &by, 1e-4);
}

/// A disc with a magnetic moment in a field of all kinds.
const MAGNET: &str = r#"
    title = "magnet in a circle"
    geometry = "planar"
    fluid = { model = "stokes", viscosity = 1.5 }
    domain.disc = { radius = 2.0 }
    boundary = { wall = "no-slip" }
    mesh = { size = 0.4, surface = 0.15 }
    time.steady = {}
    [field.magnetic]
    components = [{ constant = 0.5 }, { constant = 0.2 }]
    linear = { gradient = [[0.3, 0.1], [0.1, -0.3]] }
    dipoles = [{ position = [3.0, 1.0], strength = [2.0, -1.0] }]
    [[body]]
    name = "disc"
    shape = { ellipse = { semi_axes = [0.6, 0.5] } }
    center = [0.2, -0.1]
    angle = 0.3
    motion = "free"
    magnetic_moment = [4.0, 1.0]
"#;

#[test]
fn velocities_of_magnets_follow_moment_field_place_and_angle() {
    let by = [
        "body.0.magnetic_moment.0",
        "body.0.magnetic_moment.1",
        "body.0.angle",
        "body.0.center.0",
        "body.0.shape.ellipse.semi_axes.1",
        "field.magnetic.components.1.constant",
        "field.magnetic.dipoles.0.position.1",
        "field.magnetic.dipoles.0.strength.0",
        "fluid.viscosity",
    ];
    let of = [
        "disc.velocity.x",
        "disc.velocity.y",
        "disc.angular_velocity",
        "disc.force.x",
        "disc.torque",
    ];
    agrees(MAGNET, &of, &by, 1e-4);
    // Without a force of the flow there is none to follow
    let found = refusal(MAGNET, &["disc.magnetic_torque"], &by[..1]);
    assert!(found.contains("no quantity whose gradient is known"), "{found}");
}
