//! Loads by the residual against exact values and against the integral of the stress.

use tests::Study;
use tests::cases::{case, last, run};

/// A sphere that moves at speed 1 in the middle of a resting spherical container.
fn shell(scale: f64, curved: bool) -> String {
    format!(
        r#"
        title = "sphere in a shell"
        geometry = "axisymmetric"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.half-disc = {{ radius = 2.0 }}
        boundary.wall = "no-slip"
        mesh = {{ size = 0.3, growth = 0.4, gap_layers = 2.0, scale = {scale}, curved = {curved} }}
        time.steady = {{}}
        [[body]]
        name = "sphere"
        shape.sphere = {{ radius = 1.0 }}
        center = [0.0, 0.0]
        motion.imposed = {{ velocity = [1.0, 0.0] }}
        "#
    )
}

/// F / (6 pi mu a U) at a / R = 1/2, closed form (@happel1983, 4-22).
const SHELL_FACTOR: f64 = 7.294117647058823;

fn drag_error(scale: f64, curved: bool, quantity: &str) -> f64 {
    let outcome = run(&case(&shell(scale, curved)));
    let factor = -last(&outcome, quantity) / (6.0 * std::f64::consts::PI);
    (factor / SHELL_FACTOR - 1.0).abs()
}

/// Twice the order of the H1 norm, since the residual form is superconvergent.
#[test]
fn the_drag_converges_at_fourth_order_with_curved_cells() {
    let study = Study::run(&[1.0, 0.5, 0.25], |scale| drag_error(scale, true, "sphere.force.x"));
    study.assert_order("drag, curved cells", 4.0, 0.5);
    assert!(study.errors[2] < 2e-5);
}

/// Chords instead of arcs leave an error of second order, however exact the elements are.
#[test]
fn the_drag_converges_at_second_order_with_straight_cells() {
    let study = Study::run(&[1.0, 0.5, 0.25], |scale| drag_error(scale, false, "sphere.force.x"));
    study.assert_order("drag, straight cells", 2.0, 0.3);
}

#[test]
fn the_integral_of_the_stress_tends_to_the_same_drag_at_a_lower_order() {
    let study =
        Study::run(&[0.5, 0.25, 0.125], |scale| drag_error(scale, true, "sphere.surface_force.x"));
    assert!((1.5..3.5).contains(&study.order()), "{study:?}");
    assert!(study.errors[2] < 1e-3);
}

/// In Stokes flow all work of the bodies is dissipated at once.
#[test]
fn the_power_of_the_bodies_is_the_dissipation_of_the_flow() {
    let outcome = run(&case(&shell(1.0, true)));
    let (power, dissipation) = (last(&outcome, "sphere.power"), last(&outcome, "flow.dissipation"));
    assert!((power / dissipation - 1.0).abs() < 1e-11);
}

/// The torque of a disc turning in a resting ring, 4 pi mu a^2 W / (1 - (a/R)^2), and no force.
#[test]
fn a_turning_disc_in_a_ring_has_its_closed_form_torque() {
    let outcome = run(&case(
        r#"
        title = "disc turning in a ring"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.disc = { radius = 2.0 }
        boundary.wall = "no-slip"
        mesh = { size = 0.1 }
        time.steady = {}
        [[body]]
        name = "disc"
        shape.disc = { radius = 1.0 }
        center = [0.0, 0.0]
        motion.imposed = { angular_velocity = 1.0 }
        "#,
    ));
    let exact = -4.0 * std::f64::consts::PI / 0.75;
    let torque = last(&outcome, "disc.torque");
    assert!((torque / exact - 1.0).abs() < 2e-5, "{torque} for {exact}");
    assert!(last(&outcome, "disc.force.x").abs() < 1e-3);
}

/// A disc at a gap of 5.5e-4 radii moves towards a wall of a region 300 times as large as itself. To
/// leading order in the gap the force of the film is 3 sqrt(2) pi mu U gap^(-3/2).
#[test]
fn a_thin_film_beside_a_wide_region_is_solved_to_rounding() {
    let case = case(
        r#"
        title = "a disc close to the wall of a wide region"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-300.0, 0.0], max = [300.0, 300.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 60.0, surface = 0.1, gap_layers = 3, growth = 0.3 }
        time.steady = {}
        [[body]]
        name = "disc"
        shape.disc.radius = 1.0
        center = [0.0, 1.00055]
        motion = { imposed = { velocity = [0.0, -1.0] } }
        "#,
    );
    let force = last(&run(&case), "disc.force.y");
    let film = 3.0 * 2f64.sqrt() * std::f64::consts::PI * 5.5e-4f64.powf(-1.5);
    assert!((force / film - 1.0).abs() < 0.01, "{force} and {film}");
}
