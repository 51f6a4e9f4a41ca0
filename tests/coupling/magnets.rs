//! Bodies with a magnetic moment in fields: where they follow, where they slip, and where the work of the field goes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use alewife_core::run::RunSummary;
use tests::cases::{case, column, last, run};
use tests::figure;

/// Radius of the circle around a disc of radius 1.
const CIRCLE: f64 = 2.0;

/// Torque of the fluid on the disc over its angular velocity, with a viscosity of 1.
fn drag() -> f64 {
    4.0 * PI / (1.0 - 1.0 / (CIRCLE * CIRCLE))
}

/// A disc at the centre of a circle in a field that turns at a rate (rad/s) beside the largest that the disc follows, 1.
fn disc(rate: f64, time: &str, more: &str) -> RunSummary {
    run(&case(&format!(
        r#"
        title = "a magnetic disc in a circle"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.disc.radius = {CIRCLE}
        boundary.wall = "no-slip"
        mesh = {{ size = 0.35, surface = 0.2, gap_layers = 4 }}
        time.unsteady = {{ {time} }}
        field.magnetic.rotating = {{ strength = 0.5, frequency = {frequency:e}{more} }}
        [[body]]
        name = "disc"
        shape.disc.radius = 1.0
        center = [0.0, 0.0]
        motion = "free"
        locked = ["x", "y"]
        magnetic_moment = [0.0, {moment:e}]
        "#,
        frequency = rate / TAU,
        moment = drag() / 0.5,
    )))
}

#[test]
fn below_its_step_out_rate_a_disc_lags_by_the_arcsine_of_the_rate() {
    for (rate, more, sign) in [(0.8, "", 1.0), (0.3, ", clockwise = true", -1.0f64)] {
        let outcome = disc(rate, "step = 0.1, end = 20.0", more);
        let lag = last(&outcome, "disc.magnetic_lag");
        let off = lag.sin() / (sign * rate) - 1.0;
        figure!(off.abs(), "lag at a rate of {rate}");
        assert!(off.abs() < 2e-4, "{rate}: {lag}");
        let spin = last(&outcome, "disc.angular_velocity");
        assert!((spin / (sign * rate) - 1.0).abs() < 1e-3, "{spin}");
        // What the field does is what the fluid takes
        let [torque, taken] =
            ["magnetic_torque", "torque"].map(|what| last(&outcome, &format!("disc.{what}")));
        assert!((torque / taken + 1.0).abs() < 1e-6, "{torque} {taken}");
        let [power, lost] =
            ["disc.magnetic_power", "flow.dissipation"].map(|what| last(&outcome, what));
        assert!((power / lost - 1.0).abs() < 1e-6, "{power} {lost}");
    }
}

/// The mean rate of a disc in a field that is too fast: over a whole period of its slip, whatever the lag.
fn mean_rate(rate: f64, step: f64, scheme: &str) -> f64 {
    let end = TAU / (rate * rate - 1.0).sqrt();
    let step = end / (end / step).ceil();
    let outcome = disc(rate, &format!("step = {step:e}, end = {end:e}{scheme}"), "");
    (last(&outcome, "disc.angle") - column(&outcome, "disc.angle")[0]) / end
}

#[test]
fn beyond_its_step_out_rate_a_disc_slips() {
    for (rate, scheme) in [(1.25f64, ""), (2.0, ""), (1.25, ", scheme = \"rk3\"")] {
        let exact = rate - (rate * rate - 1.0).sqrt();
        let step = if scheme.is_empty() { 0.025 } else { 0.08 };
        let off = mean_rate(rate, step, scheme) / exact - 1.0;
        figure!(off.abs(), "mean rate at {rate}{scheme}");
        assert!(off.abs() < 2e-3, "{rate}{scheme}: {off:e}");
    }
}

/// Errors of the phase of a disc that slips fall with the square of the step.
#[test]
fn the_slip_is_of_second_order_in_the_step() {
    let end = 4.0;
    let angles = [0.1, 0.05, 0.025, 0.0125].map(|step| {
        let outcome = disc(1.5, &format!("step = {step}, end = {end}"), "");
        last(&outcome, "disc.angle")
    });
    let differences = [0, 1, 2].map(|nth| angles[nth + 1] - angles[nth]);
    let orders = [0, 1].map(|nth| (differences[nth] / differences[nth + 1]).abs().log2());
    figure!(orders[1], "order of the slip");
    assert!((orders[1] - 2.0).abs() < 0.3, "{orders:?}");
}

/// A field that could turn the disc a hundred times in a step holds it instead, from wherever it starts.
#[test]
fn a_stiff_field_leads_a_disc_from_anywhere() {
    for start in [0.0, 0.5, 2.0, 2.8, -1.7, -3.0f64] {
        let outcome = run(&case(&format!(
            r#"
            title = "a compass"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.disc.radius = {CIRCLE}
            boundary.wall = "no-slip"
            mesh = {{ size = 0.4, surface = 0.2, gap_layers = 3 }}
            time.unsteady = {{ step = 0.1, end = 0.5 }}
            field.magnetic.components = [{{ constant = 1e4 }}, {{ constant = 0.0 }}]
            [[body]]
            name = "disc"
            shape.disc.radius = 1.0
            center = [0.0, 0.0]
            angle = {start}
            motion = "free"
            locked = ["x", "y"]
            magnetic_moment = [1.0, 0.0]
            "#
        )));
        let angle = last(&outcome, "disc.angle");
        assert!(angle.abs() < 1e-3, "{start}: {angle}");
    }
}

/// A heavy disc in a thin fluid swings as a compass does.
#[test]
fn a_heavy_disc_swings_about_the_field() {
    let off = |step: f64| {
        let outcome = run(&case(&format!(
            r#"
            title = "a compass"
            geometry = "planar"
            fluid = {{ model = "navier-stokes", density = 1e-4, viscosity = 1e-5 }}
            domain.disc.radius = {CIRCLE}
            boundary.wall = "no-slip"
            mesh = {{ size = 0.5, surface = 0.3, gap_layers = 2 }}
            time.unsteady = {{ step = {step}, end = 1.0 }}
            field.magnetic.components = [{{ constant = 0.0 }}, {{ constant = 2.0 }}]
            [[body]]
            name = "disc"
            shape.disc.radius = 1.0
            center = [0.0, 0.0]
            density = 1.0
            angle = 0.01
            motion = "free"
            locked = ["x", "y"]
            magnetic_moment = [0.0, {moment:e}]
            "#,
            // Once a second: m B over the moment of inertia pi / 2 is (2 pi)^2
            moment = TAU * TAU * FRAC_PI_2 / 2.0,
        )));
        (last(&outcome, "disc.angle") / 0.01 - 1.0).abs()
    };
    let off = [0.02, 0.01].map(off);
    figure!(off[1], "amplitude after a period");
    assert!(off[1] < 2e-2 && off[1] < 0.45 * off[0], "{off:?}");
}

/// Two links on a free hinge, the first one with a moment.
#[test]
fn a_moment_on_a_link_turns_a_chain_and_its_work_is_dissipated() {
    let outcome = run(&case(
        r#"
        title = "two links in a field"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.disc.radius = 3.0
        boundary.wall = "no-slip"
        mesh = { size = 1.0, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1 }
        time.unsteady = { step = 0.02, end = 0.4 }
        field.magnetic.rotating = { strength = 2.0, frequency = 0.5, phase = 0.1 }
        [[swimmer]]
        name = "pair"
        [swimmer.kind.chain]
        links = [{ shape = { ellipse = { semi_axes = [0.4, 0.15] } }, magnetic_moment = [3.0, 0.0] }, [0.4, 0.15]]
        gap = 0.3
        joints = [{ hinge = { damping = 0.2 } }]
        "#,
    ));
    let of = |what: &str| column(&outcome, what);
    let [field, lost, hinge] =
        ["pair-1.magnetic_power", "flow.dissipation", "pair-2.joint.power"].map(of);
    let spins = ["pair-1.angular_velocity", "pair-2.angular_velocity"].map(of);
    assert!(spins[0].iter().zip(&spins[1]).all(|(own, other)| own.abs() > 2.0 * other.abs()));
    let off = (2..field.len()).map(|row| ((field[row] + hinge[row]) / lost[row] - 1.0).abs());
    let off = off.fold(0.0, f64::max);
    figure!(off, "work of the field on a chain");
    assert!(off < 2e-4, "{off:e}");
}

/// A gradient pulls: on an axis of symmetry the force is the moment times the derivative of the field.
#[test]
fn a_field_of_place_pulls_a_sphere_along_the_axis() {
    let pulled = |field: &str| {
        let outcome = run(&case(&format!(
            r#"
            title = "a magnetic sphere on the axis"
            geometry = "axisymmetric"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.half-disc.radius = 4.0
            boundary.wall = "no-slip"
            mesh = {{ size = 0.5, surface = 0.15 }}
            time.steady = {{}}
            field.magnetic = {{ {field} }}
            [[body]]
            name = "sphere"
            shape.sphere.radius = 1.0
            center = [0.0, 0.0]
            motion = "free"
            magnetic_moment = [2.0, 0.0]
            "#
        )));
        ["magnetic_force.x", "force.x", "velocity.x"]
            .map(|what| last(&outcome, &format!("sphere.{what}")))
    };
    let ratio = 0.25f64;
    let resistance = 6.0 * PI * (1.0 - ratio.powi(5))
        / (1.0 - 2.25 * ratio + 2.5 * ratio.powi(3) - 2.25 * ratio.powi(5) + ratio.powi(6));
    for (field, exact) in [
        ("linear = { gradient = [[3.0, 0.0], [0.0, -1.5]] }", 6.0),
        // d/dx of s / (2 pi |x|^3), 6 away
        (
            "dipoles = [{ position = [6.0, 0.0], strength = [400.0, 0.0] }]",
            2.0 * 3.0 * 400.0 / (2.0 * PI * 6f64.powi(4)),
        ),
    ] {
        let [force, taken, velocity] = pulled(field);
        assert!((force / exact - 1.0).abs() < 1e-12, "{field}: {force}");
        assert!((taken / exact + 1.0).abs() < 1e-8, "{field}: {taken}");
        assert!((velocity * resistance / exact - 1.0).abs() < 2e-3, "{field}: {velocity}");
    }
}
