//! Gradients of steady flows and of motions against differences of complete solutions, and against what is known exactly.

mod exact;
mod in_time;
mod kinds;

use alewife_core::case::Case;
use alewife_core::gradient::{Derivatives, GradientError, GradientTask, ReadCase, gradients};

/// The gradients of quantities of a case, with differences where they are wanted.
fn gradients_of(
    text: &str,
    of: &[&str],
    by: &[&str],
    checks: bool,
) -> Result<Vec<Derivatives>, GradientError> {
    let read = |settings: &[String]| Case::parse("case.toml", text, settings);
    gradients_by(&read, of, by, checks)
}

/// The same of a case that is read so.
fn gradients_by(
    read: ReadCase<'_>,
    of: &[&str],
    by: &[&str],
    checks: bool,
) -> Result<Vec<Derivatives>, GradientError> {
    let [of, by] =
        [of, by].map(|names| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
    gradients(&GradientTask { read, of: &of, by: &by, checks })
}

/// Compares with differences, relative to the largest product of a derivative with its number.
fn agrees(text: &str, of: &[&str], by: &[&str], tolerance: f64) {
    compared(&|settings: &[String]| Case::parse("case.toml", text, settings), of, by, tolerance);
}

/// The same of a case that is read so.
fn compared(read: ReadCase<'_>, of: &[&str], by: &[&str], tolerance: f64) {
    for Derivatives { of, value, by: found, differences, .. } in
        gradients_by(read, of, by, true).unwrap()
    {
        assert!(value.is_finite());
        let size = found.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        assert!(size > 0.0, "{of} follows from none of {by:?}");
        for ((key, found), wanted) in by.iter().zip(&found).zip(&differences) {
            let error = (found - wanted).abs() / wanted.abs().max(1e-3 * size);
            assert!(error < tolerance, "{of} by {key}: {found} and {wanted}, off by {error:.1e}");
        }
    }
}

/// A disc between two walls, nearer to one of them.
const CHANNEL: &str = r#"
    title = "disc in a channel"
    geometry = "planar"
    fluid = { model = "navier-stokes", viscosity = 0.02, density = 1.0 }
    domain.channel = { length = 4.0, height = 2.0 }
    boundary = { left = { parabolic = { peak = 1.0 } }, right = "do-nothing", bottom = "no-slip", top = "no-slip" }
    mesh = { size = 0.4, surface = 0.12 }
    time.steady = {}
    scales = { length = 0.5, velocity = 1.0 }
    [[body]]
    name = "disc"
    shape = { disc = { radius = 0.25 } }
    center = [1.2, 0.9]
    motion = "held"
"#;

#[test]
fn loads_in_plane_flow_follow_viscosity_inflow_radius_and_position() {
    agrees(
        CHANNEL,
        &["disc.force.x", "disc.force.y", "disc.torque", "disc.drag_coefficient"],
        &[
            "fluid.viscosity",
            "fluid.density",
            "boundary.left.parabolic.peak",
            "body.0.shape.disc.radius",
            "body.0.center.0",
            "body.0.center.1",
        ],
        1e-4,
    );
}

/// A swimmer that is free in an enclosed fluid, in a frame of its own.
const SWIMMER: &str = r#"
    title = "swimmer"
    geometry = "planar"
    frame = "swimmer"
    fluid = { model = "navier-stokes", viscosity = 0.1, density = 1.0 }
    domain.disc = { center = [0.0, 0.0], radius = 4.0 }
    boundary = { wall = "no-slip" }
    mesh = { size = 0.8, surface = 0.2 }
    time.steady = {}
    [[body]]
    name = "swimmer"
    shape = { ellipse = { semi_axes = [1.0, 0.7] } }
    center = [0.3, 0.2]
    angle = 0.3
    motion = { imposed = { velocity = [0.2, 0.1], angular_velocity = 0.3 } }
"#;

#[test]
fn loads_follow_the_velocity_the_angle_and_the_axes_of_a_body() {
    agrees(
        SWIMMER,
        &["swimmer.force.x", "swimmer.force.y", "swimmer.torque", "swimmer.power"],
        &[
            "body.0.motion.imposed.velocity.0",
            "body.0.motion.imposed.angular_velocity",
            "body.0.angle",
            "body.0.shape.ellipse.semi_axes.0",
            "body.0.shape.ellipse.semi_axes.1",
        ],
        1e-4,
    );
}

#[test]
fn a_free_squirmer_follows_its_modes_and_radius_in_the_plane() {
    let squirmer =
        SWIMMER.replace("ellipse = { semi_axes = [1.0, 0.7] }", "disc = { radius = 1.0 }").replace(
            "motion = { imposed = { velocity = [0.2, 0.1], angular_velocity = 0.3 } }",
            "motion = \"free\"\ngait = { squirmer = { modes = [0.5, 0.8] } }",
        );
    agrees(
        &squirmer,
        &["swimmer.velocity.x", "swimmer.velocity.y", "swimmer.angular_velocity", "swimmer.power"],
        &[
            "body.0.gait.squirmer.modes.0",
            "body.0.gait.squirmer.modes.1",
            "body.0.shape.disc.radius",
            "body.0.center.0",
            "fluid.viscosity",
        ],
        1e-4,
    );
}

/// A squirmer and a ball on the axis of a tube.
const TUBE: &str = r#"
    title = "squirmer behind a ball"
    geometry = "axisymmetric"
    fluid = { model = "stokes", viscosity = 2.0, density = 1.0 }
    domain.cylinder = { x = [-4.0, 6.0], radius = 3.0 }
    boundary = { left = { velocity = { value = [0.1, 0.0] } }, right = "do-nothing", wall = "no-slip" }
    mesh = { size = 0.8, surface = 0.25 }
    time.steady = {}
    [[body]]
    name = "squirmer"
    shape = { sphere = { radius = 1.0 } }
    center = [0.0, 0.0]
    motion = "free"
    gait = { squirmer = { modes = [1.0, -0.5, 0.2] } }
    [[body]]
    name = "ball"
    shape = { spheroid = { semi_axes = [0.8, 0.5] } }
    center = [2.5, 0.0]
    motion = "held"
"#;

#[test]
fn bodies_on_the_axis_follow_modes_axes_positions_and_inflow() {
    let of = ["squirmer.velocity.x", "squirmer.power", "ball.force.x"];
    let by = [
        "boundary.left.velocity.value.0",
        "body.0.gait.squirmer.modes.0",
        "body.0.gait.squirmer.modes.1",
        "body.0.gait.squirmer.modes.2",
        "body.0.shape.sphere.radius",
        "body.1.shape.spheroid.semi_axes.0",
        "body.1.shape.spheroid.semi_axes.1",
        "body.1.center.0",
        "fluid.viscosity",
    ];
    agrees(TUBE, &of, &by, 1e-4);
    agrees(&TUBE.replace("\"stokes\"", "\"navier-stokes\""), &of, &by, 1e-4);
}

/// A ball beside the middle of a box.
const BOX: &str = r#"
    title = "ball in a box"
    geometry = "spatial"
    fluid = { model = "stokes", viscosity = 2.0, density = 1.0 }
    domain.box = { min = [-2.0, -2.0, -2.0], max = [2.0, 2.0, 2.0] }
    boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }
    mesh = { size = 2.0, surface = 0.9, gap_layers = 1 }
    time.steady = {}
    [[body]]
    name = "ball"
    shape = { ellipsoid = { semi_axes = [0.9, 0.7, 0.8] } }
    center = [0.3, 0.2, 0.0]
    motion = { imposed = { velocity = [1.0, 0.0, 0.5] } }
"#;

#[test]
fn loads_in_space_follow_axes_and_positions() {
    let by = ["body.0.shape.ellipsoid.semi_axes.0", "body.0.center.1"];
    agrees(BOX, &["ball.force.x", "ball.torque.y"], &by, 1e-4);
}

/// The transposed system of a flow with inertia is solved by factors, where others are by iterations.
#[test]
#[ignore = "long: a minute; small: loads_in_space_follow_axes_and_positions"]
fn loads_in_space_follow_all_numbers_with_inertia() {
    let of = ["ball.force.x", "ball.torque.y", "ball.power"];
    let by = [
        "body.0.shape.ellipsoid.semi_axes.0",
        "body.0.shape.ellipsoid.semi_axes.2",
        "body.0.center.0",
        "body.0.center.1",
        "body.0.motion.imposed.velocity.2",
        "fluid.viscosity",
    ];
    agrees(&BOX.replace("\"stokes\"", "\"navier-stokes\""), &of, &by, 1e-4);
}

/// The message of a refusal.
fn refusal(text: &str, of: &[&str], by: &[&str]) -> String {
    gradients_of(text, of, by, false).unwrap_err().to_string()
}

#[test]
fn what_has_no_gradient_is_refused_with_what_has_one() {
    let ok = ["fluid.viscosity"];
    let found = refusal(CHANNEL, &["disc.force.X"], &ok);
    assert!(found.contains("do you mean `disc.force.x`?"), "{found}");
    let found = refusal(CHANNEL, &["flow.dissipation"], &ok);
    assert!(found.contains("no quantity whose gradient is known"), "{found}");
    let found = refusal(CHANNEL, &["disc.force.x"], &["body.0.shape.disc.radus"]);
    assert!(found.contains("do you mean `body.0.shape.disc.radius`?"), "{found}");
    let found = refusal(CHANNEL, &["disc.force.x"], &["mesh.size"]);
    assert!(
        found.contains("no number of what is solved") && found.contains("case.toml:7"),
        "{found}"
    );
    let found = refusal(CHANNEL, &["disc.force.x"], &["domain.channel.length"]);
    assert!(found.contains("sides of the domain stay"), "{found}");
    let unsteady = CHANNEL.replace("time.steady = {}", "time.unsteady = { step = 0.1, end = 1.0 }");
    let found = refusal(&unsteady, &["disc.force.x"], &ok);
    assert!(found.contains("write [time.steady]") && found.contains("case.toml:8"), "{found}");
}
