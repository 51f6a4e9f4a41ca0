//! Free bodies: reciprocity with held ones, inertia, travelling frames.

use std::f64::consts::PI;

use tests::cases::{case, last, run};
use tests::figure;

/// A sphere on the axis of a tube; `motion` and `flow` differ.
fn tube(motion: &str, peak: f64) -> String {
    format!(
        r#"
        title = "sphere in a tube"
        geometry = "axisymmetric"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.cylinder = {{ x = [-6.0, 6.0], radius = 2.0 }}
        boundary = {{ wall = "no-slip", left.parabolic.peak = {peak}, right.parabolic.peak = {peak} }}
        mesh = {{ size = 0.4, surface = 0.15 }}
        time.steady = {{}}
        [[body]]
        name = "sphere"
        shape.sphere = {{ radius = 1.0 }}
        center = [0.0, 0.0]
        motion{motion}
        "#
    )
}

/// The free speed in a stream is the held drag over the drag of unit motion: the same discrete
/// operators stand on both sides, so it holds to rounding whatever the mesh.
#[test]
fn held_and_free_spheres_agree_by_reciprocity() {
    let moving = run(&case(&tube(".imposed = { velocity = [1.0, 0.0] }", 0.0)));
    let held = run(&case(&tube(" = \"held\"", 1.0)));
    let free = run(&case(&tube(" = \"free\"", 1.0)));
    let expected = -last(&held, "sphere.force.x") / last(&moving, "sphere.force.x");
    assert!((last(&free, "sphere.velocity.x") - expected).abs() < 1e-8);
    assert!(last(&free, "sphere.force.x").abs() < 1e-9);
}

/// A sphere of radius 1 released from rest in a fluid of density and viscosity 1.
fn release(density: f64) -> String {
    format!(
        r#"
        title = "sphere released from rest"
        geometry = "axisymmetric"
        frame = "sphere"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 1.0, gravity = [-1.0, 0.0] }}
        domain.half-disc = {{ radius = 20.0 }}
        boundary.wall = "no-slip"
        mesh = {{ size = 4.0, surface = 0.012, growth = 0.3 }}
        time.unsteady = {{ step = 2e-6, end = {END} }}
        [[body]]
        name = "sphere"
        shape.sphere = {{ radius = 1.0 }}
        center = [0.0, 0.0]
        density = {density}
        motion = "free"
        "#
    )
}

/// So early that the viscous layer, sqrt(t) thick, is thin, and so late that the mesh resolves it.
const END: f64 = 2e-5;

/// dU/dt = (rho_p - rho_f) g / (rho_p + rho_f / 2) at once after release, less the Basset force
/// 12 a^2 sqrt(pi mu rho t) dU/dt of the layer, at any density ratio, a massless body included:
/// fluid and body are one system.
#[test]
fn the_early_acceleration_of_a_sphere_shows_the_added_mass_of_half_its_volume() {
    for density in [2.0, 0.1, 0.0] {
        let outcome = run(&case(&release(density)));
        let inertia = 4.0 / 3.0 * PI * (density + 0.5);
        let basset = 12.0 * (PI * END).sqrt();
        let exact = -(4.0 / 3.0 * PI * (density - 1.0)) / (inertia + basset);
        let computed = last(&outcome, "sphere.acceleration.x");
        figure!(computed / exact - 1.0, "acceleration at density {density}");
        // Terms of second order in the thickness of the layer are below 0.3 %.
        assert!((computed / exact - 1.0).abs() < 5e-3, "{density}: {computed} for {exact}");
    }
}

#[test]
fn a_neutral_squirmer_swims_at_its_stokes_speed_with_inertia_and_a_heavy_one_cannot_start() {
    let squirmer = |time: &str, density: f64| {
        format!(
            r#"
            title = "neutral squirmer"
            geometry = "axisymmetric"
            frame = "squirmer"
            fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.1 }}
            domain.half-disc = {{ radius = 40.0 }}
            boundary.wall = "no-slip"
            mesh = {{ size = 6.0, surface = 0.1, growth = 0.25 }}
            time.{time}
            [[body]]
            name = "squirmer"
            shape.sphere = {{ radius = 1.0 }}
            center = [0.0, 0.0]
            density = {density}
            motion = "free"
            gait.squirmer = {{ modes = [1.5] }}
            "#
        )
    };
    let steady = run(&case(&squirmer("steady = {}", 1.0)));
    assert!((last(&steady, "squirmer.velocity.x") - 1.0).abs() < 1e-3);
    let heavy = run(&case(&squirmer("unsteady = { step = 0.1, end = 1.0 }", 1e9)));
    assert!(last(&heavy, "squirmer.velocity.x").abs() < 1e-6);
}

/// In Stokes flow the speed at the centre of a container that travels along is that of the modes of
/// each instant, and points along the axis of each instant.
#[test]
fn a_squirmer_follows_the_factors_of_its_modes_and_the_turn_of_its_axis() {
    let squirmer = |geometry: &str, domain: &str, shape: &str, gait: &str, end: f64| {
        let text = format!(
            r#"
            title = "a squirmer in time"
            geometry = "{geometry}"
            frame = "squirmer"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.{domain} = {{ radius = 4.0 }}
            boundary.wall = "no-slip"
            mesh = {{ size = 0.8, surface = 0.15 }}
            time.unsteady = {{ step = 0.1, end = {end} }}
            [[body]]
            name = "squirmer"
            shape.{shape} = {{ radius = 1.0 }}
            center = [0.0, 0.0]
            motion = "free"
            gait.squirmer = {{ modes = [1.5, 2.0], {gait} }}
            "#
        );
        let outcome = run(&case(&text));
        ["x", "y"].map(|axis| last(&outcome, &format!("squirmer.velocity.{axis}")))
    };
    let sphere = |gait: &str, end| squirmer("axisymmetric", "half-disc", "sphere", gait, end)[0];
    let alone = sphere("heading = 0.0", 0.1);
    // (1 - 5/2 l^3 + 3/2 l^5) / (1 - l^5) at l = 1/4
    assert!((alone - 0.963_342_907).abs() < 1e-3, "{alone}");
    let factors = "factors = { 1.sine = { mean = 0.5, period = 4.0 }, 2.ramp.duration = 2.0 }";
    let expected = alone * (0.5 + (0.5 * std::f64::consts::PI * 0.6).sin());
    let found = sphere(factors, 0.6);
    assert!((found - expected).abs() < 1e-3 * expected, "{found}, {expected}");

    let disc = |gait: &str, end| squirmer("planar", "disc", "disc", gait, end);
    let ahead = disc("heading = 0.3", 0.1);
    let turned = disc("heading = 0.3, turn.table = [[0.0, 0.0], [1.0, 2.0]]", 0.5);
    let (sin, cos) = 1.0_f64.sin_cos();
    let expected = [cos * ahead[0] - sin * ahead[1], sin * ahead[0] + cos * ahead[1]];
    let error = (turned[0] - expected[0]).hypot(turned[1] - expected[1]);
    assert!(error < 1e-3 * ahead[0], "{turned:?}, {expected:?}");
}

/// A disc free to turn and drift in a shear flow, at its centre: it neither drifts nor is loaded.
#[test]
fn a_disc_in_shear_flow_turns_at_about_half_the_shear_rate() {
    let outcome = run(&case(
        r#"
        title = "disc in shear flow"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-10.0, -10.0], max = [10.0, 10.0] }
        boundary = { left.shear.rate = 1.0, right.shear.rate = 1.0, bottom.shear.rate = 1.0, top.shear.rate = 1.0 }
        mesh = { size = 1.5, surface = 0.15 }
        time.steady = {}
        [[body]]
        name = "disc"
        shape.disc = { radius = 1.0 }
        center = [0.0, 0.0]
        motion = "free"
        "#,
    ));
    // Clockwise for u = y; the walls at ten radii slow it by less than 1 %.
    assert!((last(&outcome, "disc.angular_velocity") + 0.5).abs() < 5e-3);
    assert!(last(&outcome, "disc.velocity.x").abs() < 1e-4);
    assert!(last(&outcome, "disc.torque").abs() < 1e-10);
}
