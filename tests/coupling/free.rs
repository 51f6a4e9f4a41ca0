//! Free bodies: reciprocity with held ones, inertia, travelling frames.

use std::f64::consts::PI;

use tests::cases::{case, last, run};

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
        println!("density {density}: {computed} for {exact}");
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
