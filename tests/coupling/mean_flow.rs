//! Flow driven along periodic directions: by a pressure gradient, a body force, or a mean velocity.

use alewife_core::run::RunSummary;
use tests::cases::{PERIODIC_BOX, PERIODIC_CHANNEL, case, last, run};
use tests::figure;

/// A disc in a doubly periodic box, whose mesh does not know of its symmetries.
fn disc(flow: &str, motion: &str) -> RunSummary {
    run(&case(&format!(
        r#"
        title = "a disc in a periodic box"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 2.0 }}
        flow = {{ {flow} }}
        domain.box = {{ min = [-0.5, -0.4], max = [0.7, 0.6] }}
        mesh = {{ size = 0.1, surface = 0.05 }}
        time.steady = {{}}
        {PERIODIC_BOX}
        [[body]]
        name = "disc"
        shape.disc.radius = 0.25
        center = [0.05, 0.02]
        motion = {motion}
        "#
    )))
}

fn values(of: &RunSummary, names: [&str; 4]) -> [f64; 4] {
    names.map(|name| last(of, name))
}

const FLOW: [&str; 4] = [
    "flow.pressure_gradient.x",
    "flow.pressure_gradient.y",
    "flow.mean_velocity.x",
    "flow.mean_velocity.y",
];

/// The gradient that a mean velocity needs brings that velocity about, and the force on the body is
/// minus the gradient times the area of the cell.
#[test]
fn pressure_gradient_and_mean_velocity_follow_from_each_other() {
    let by_velocity = disc("mean_velocity = [1.0, -0.3]", "\"held\"");
    let [gx, gy, u, v] = values(&by_velocity, FLOW);
    assert!((u - 1.0).abs() < 1e-12 && (v + 0.3).abs() < 1e-12, "{u} {v}");
    for (force, gradient) in [("disc.force.x", gx), ("disc.force.y", gy)] {
        let balance = last(&by_velocity, force) + gradient * 1.2;
        // The area of the body is that of its polygon of curved edges in the fluid's integrals
        assert!(balance.abs() < 1e-5 * gradient.abs(), "{force}: {balance} of {gradient}");
    }
    let by_gradient = disc(&format!("pressure_gradient = [{gx:?}, {gy:?}]"), "\"held\"");
    let [_, _, u, v] = values(&by_gradient, FLOW);
    assert!((u - 1.0).abs() < 1e-9 && (v + 0.3).abs() < 1e-9, "{u} {v}");
    assert!(last(&by_gradient, "flow.energy_defect").abs() < 1e-9);
}

/// Held in a stream, or moved against fluid without net flux: the same loads.
#[test]
fn loads_do_not_depend_on_who_moves() {
    let held = disc("mean_velocity = [0.5, 0.2]", "\"held\"");
    let moved = disc("mean_velocity = [0.0, 0.0]", "{ imposed = { velocity = [-0.5, -0.2] } }");
    for name in ["disc.force.x", "disc.force.y", "disc.torque", "disc.surface_force.x"] {
        let (one, other) = (last(&held, name), last(&moved, name));
        assert!((one - other).abs() < 1e-9 * one.abs().max(1.0), "{name}: {one} {other}");
    }
    assert!(last(&held, "disc.force.x") > 1.0);
}

/// Bodies that nothing holds go with the mean flow.
#[test]
fn a_free_body_goes_with_the_mean_flow() {
    let free = disc("mean_velocity = [0.5, 0.2]", "\"free\"");
    for (name, value) in [("disc.velocity.x", 0.5), ("disc.velocity.y", 0.2)] {
        assert!((last(&free, name) - value).abs() < 1e-9, "{name}");
    }
    assert!(last(&free, "disc.force.x").abs() < 1e-9);
    // No work is done, and nothing is dissipated
    assert!(last(&free, "flow.energy_defect").is_nan());
}

/// Sedimentation without net flux: the mean pressure gradient carries what pulls the bodies, and
/// the body falls with the drag of one that is moved through the cell.
#[test]
fn a_pulled_body_in_a_cell_without_walls_falls_by_its_drag() {
    let moved = disc("mean_velocity = [0.0, 0.0]", "{ imposed = { velocity = [-0.5, -0.2] } }");
    let drag = ["disc.force.x", "disc.force.y", "disc.torque"].map(|name| last(&moved, name));
    let [x, y, torque] = drag.map(|load| -load);
    let pulled = format!("\"free\"\n        force = [{x:?}, {y:?}]\n        torque = {torque:?}");
    let falling = disc("mean_velocity = [0.0, 0.0]", &pulled);
    for (name, value) in [("disc.velocity.x", -0.5), ("disc.velocity.y", -0.2)] {
        assert!((last(&falling, name) - value).abs() < 1e-9, "{name} {}", last(&falling, name));
    }
    let [gx, ..] = values(&falling, FLOW);
    assert!((gx * 1.2 / x - 1.0).abs() < 1e-5, "{gx} {x}");
}

/// Poiseuille flow, exact in quadratic elements: mean velocity -G H^2 / (12 mu).
#[test]
fn a_channel_has_the_mean_velocity_of_poiseuille_flow() {
    for (flow, sign) in [
        ("pressure_gradient = [-3.0, 0.0]", 1.0),
        ("body_force = [3.0, 0.0]", 1.0),
        ("pressure_gradient = [6.0, 0.0], factor.ramp.duration = 2.0", -1.0),
    ] {
        let is_ramped = flow.contains("ramp");
        let time = if is_ramped { "unsteady = { step = 0.25, end = 1.0 }" } else { "steady = {}" };
        let channel = run(&case(&format!(
            r#"
            title = "a periodic channel"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 0.5 }}
            flow = {{ {flow} }}
            domain.channel = {{ length = 1.0, height = 2.0 }}
            mesh.size = 0.4
            time.{time}
            {PERIODIC_CHANNEL}
            "#
        )));
        let exact = sign * 3.0 * 4.0 / (12.0 * 0.5);
        let mean = last(&channel, "flow.mean_velocity.x");
        assert!((mean - exact).abs() < 1e-9 * exact.abs(), "{flow}: {mean} {exact}");
    }
}

/// A suspension with inertia keeps the mean velocity in every step, remeshing included, and its energy.
#[test]
fn a_mean_velocity_holds_in_every_step() {
    let rest = r#"
        title = "two discs in a driven channel"
        geometry = "planar"
        fluid = { model = "navier-stokes", density = 1.0, viscosity = 0.05 }
        flow.mean_velocity = [1.0, 0.0]
        domain.box = { min = [-1.0, -0.5], max = [1.0, 0.5] }
        mesh = { size = 0.2, surface = 0.08, gap_layers = 2, moving.quality = 0.8 }
        time.unsteady = { step = 0.02, end = 1.2, initial = "stokes" }
        contact.barrier = { range = 0.05, stiffness = 5.0 }
        [[body]]
        name = "first"
        shape.disc.radius = 0.15
        center = [-0.5, 0.15]
        motion = "free"
        [[body]]
        name = "second"
        shape.disc.radius = 0.15
        center = [-0.1, -0.2]
        density = 2.0
        motion = "free"
        "#;
    let outcome = run(&case(&format!("{PERIODIC_CHANNEL}{rest}")));
    let means = outcome.series.column("flow.mean_velocity.x").expect("a column");
    assert!(means.iter().all(|mean| (mean - 1.0).abs() < 1e-8), "{means:?}");
    assert!(last(&outcome, "flow.remeshes") >= 1.0);
    assert!(last(&outcome, "flow.pressure_gradient.x") < 0.0);
    let defect = last(&outcome, "flow.energy_defect");
    assert!(defect.abs() < 0.02, "{defect}");
}

/// The work and the impulse of a mean velocity count, also where it is switched on with the fluid at rest or
/// changes in time: balances are those of the step.
#[test]
fn a_mean_velocity_that_is_switched_on_or_changes_does_work() {
    for factor in ["", "flow.factor.sine = { mean = 1.0, amplitude = 0.5, period = 0.5 }"] {
        let at = |step: f64| {
            let outcome = run(&case(&format!(
                r#"
                title = "a disc in a channel whose flow is switched on"
                geometry = "planar"
                fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.1 }}
                flow.mean_velocity = [1.0, 0.0]
                {factor}
                domain.box = {{ min = [-1.0, -0.5], max = [1.0, 0.5] }}
                mesh = {{ size = 0.1, surface = 0.05 }}
                time.unsteady = {{ step = {step}, end = 1.0 }}
                {PERIODIC_CHANNEL}
                [[body]]
                name = "disc"
                shape.disc.radius = 0.15
                center = [-0.5, 0.1]
                motion = "held"
                "#
            )));
            let first = outcome.series.column("flow.energy_defect").expect("a column")[0];
            assert!(first.is_nan(), "{first}");
            let of = |name: &str| last(&outcome, &format!("flow.{name}_defect"));
            figure!(of("energy"), "energy defect, step {step}, {factor}");
            [of("energy").abs(), of("momentum")]
        };
        let [[coarse, impulse], [fine, fine_impulse]] = [at(0.02), at(0.01)];
        // What velocities that jump leave for the first steps falls with the root of the step
        assert!(coarse < 0.005 && fine < 0.85 * coarse, "{factor}: {coarse} {fine}");
        let allowed = f64::max(0.3 * impulse, 1e-4);
        assert!(impulse < 0.005 && fine_impulse < allowed, "{factor}: {impulse} {fine_impulse}");
    }
}
