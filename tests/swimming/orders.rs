//! Orders in time of swimmers without inertia, on one mesh, with smooth strokes and with strokes whose
//! rates jump.

use alewife_core::run::{RunSummary, simulate};
use tests::Study;
use tests::cases::{case, last, run};
use tests::figure;

/// Three discs of different sizes, off the middle of a box and turned, so that they move and turn in
/// every way there is.
fn three_discs(scheme: &str, step: f64, arms: [&str; 2]) -> RunSummary {
    three_discs_with("", scheme, step, arms)
}

/// The same with another line in the case.
fn three_discs_with(line: &str, scheme: &str, step: f64, arms: [&str; 2]) -> RunSummary {
    let text = format!(
        r#"
        title = "three discs"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-2.0, -1.2], max = [2.0, 1.2] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 0.8, surface = 0.2, growth = 0.4, gap_layers = 1, moving.layers = 1, moving.quality = 0.05 }}
        time.unsteady = {{ step = {step:e}, end = 0.8, scheme = "{scheme}" }}
        {line}
        [[swimmer]]
        name = "swimmer"
        center = [0.2, -0.3]
        angle = 0.4
        [swimmer.kind.linked-spheres]
        radii = [0.3, 0.2, 0.25]
        arms = [{}, {}]
        "#,
        arms[0], arms[1]
    );
    let outcome = run(&case(&text));
    assert_eq!(last(&outcome, "flow.remeshes"), 0.0);
    outcome
}

fn pose(outcome: &RunSummary) -> [f64; 3] {
    ["x", "y", "angle"].map(|part| last(outcome, &format!("swimmer-2.{part}")))
}

fn distance(one: &[f64; 3], other: &[f64; 3]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

const SMOOTH: [&str; 2] = [
    "{ sine = { mean = 0.9, amplitude = 0.2, period = 1.0, phase = 0.0477465 } }",
    "{ sine = { mean = 0.8, amplitude = 0.15, period = 1.0, phase = 0.270563 } }",
];
/// Knots where no step ends.
const KINKED: [&str; 2] = [
    "{ legs = { period = 1.0, knots = [[0.0, 1.0], [0.23, 0.7], [0.61, 0.75]] } }",
    "{ legs = { period = 1.0, knots = [[0.0, 0.7], [0.37, 0.95], [0.71, 0.9]] } }",
];

#[test]
fn explicit_steps_are_of_third_order_whether_strokes_are_smooth_or_not() {
    for (name, arms) in [("smooth", SMOOTH), ("kinked", KINKED)] {
        let fine = pose(&three_discs("rk3", 0.8 / 48.0, arms));
        let study = Study::run(&[0.8 / 3.0, 0.8 / 6.0, 0.8 / 12.0], |step| {
            distance(&pose(&three_discs("rk3", step, arms)), &fine)
        });
        study.record(&format!("rk3, {name}"));
        assert!(study.order() > 2.7, "{name}: {study:?}");
    }
}

/// The walls are within the range all the time, and never touched.
#[test]
fn explicit_steps_are_of_third_order_with_contact_in_range() {
    let contact = "contact.barrier = { range = 1.0, stiffness = 0.5 }";
    let run = |scheme: &str, step: f64| pose(&three_discs_with(contact, scheme, step, SMOOTH));
    let fine = run("rk3", 0.8 / 48.0);
    let study =
        Study::run(&[0.8 / 3.0, 0.8 / 6.0, 0.8 / 12.0], |step| distance(&run("rk3", step), &fine));
    let implicit = distance(&run("bdf2", 0.8 / 48.0), &fine);
    let without = distance(&pose(&three_discs("rk3", 0.8 / 12.0, SMOOTH)), &fine);
    study.record("rk3 with contact");
    figure!(implicit, "bdf2 with contact");
    assert!(study.order() > 2.7, "{study:?}");
    assert!(implicit < 0.02 * without, "bdf2 is {implicit:e} off, and contact makes {without:e}");
    assert!(study.errors[2] < implicit, "twelve explicit steps and 48 implicit ones: {study:?}");
}

/// A barrier that would push the discs back within a small part of a step.
#[test]
fn stiff_contact_is_no_matter_of_explicit_steps() {
    let run = |line: &str| {
        let text = format!(
            r#"
            title = "a disc pressed on to a wall"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.box = {{ min = [-2.0, 0.0], max = [2.0, 2.0] }}
            boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
            mesh = {{ size = 0.8, surface = 0.2, growth = 0.4, gap_layers = 1 }}
            time.unsteady = {{ step = 0.1, end = 0.2, scheme = "rk3" }}
            {line}
            [[body]]
            name = "disc"
            shape.disc.radius = 0.5
            center = [0.0, 0.6]
            motion = "free"
            force = [0.0, -5.0]
            "#
        );
        simulate::<2>(&case(&text), &mut [])
    };
    assert!(run("contact.barrier = { range = 0.15, stiffness = 50.0 }").is_ok());
    let error = run("contact.barrier = { range = 0.15, stiffness = 1e9 }").unwrap_err();
    let message = error.to_string();
    assert!(message.contains("too fast for a step") && message.contains("bdf2"), "{message}");
}

/// One arm of each: what comes of the smooth one is larger than the trifle to which places settle.
const MIXED: [&str; 2] = [SMOOTH[0], KINKED[1]];

#[test]
fn bdf2_is_of_second_order_whether_strokes_are_smooth_or_not() {
    for (name, arms) in [("smooth", SMOOTH), ("kinked", MIXED)] {
        let fine = pose(&three_discs("rk3", 0.8 / 32.0, arms));
        let study = Study::run(&[0.8 / 16.0, 0.8 / 32.0, 0.8 / 64.0], |step| {
            distance(&pose(&three_discs("bdf2", step, arms)), &fine)
        });
        study.record(&format!("bdf2, {name}"));
        assert!(study.order() > 1.7, "{name}: {study:?}");
    }
}
