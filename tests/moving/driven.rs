//! Bodies some of whose motions are given while others are free.

use std::f64::consts::{PI, TAU};

use alewife_core::case::Model;
use alewife_core::run::{RunSummary, SavedState, simulate};
use tests::cases::{case, column, last, run};
use tests::{Study, figure, resumed, stopped};

fn foil(time: &str, body: &str) -> Model {
    case(&format!(
        r#"
        title = "a foil that heaves and pitches"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.05 }}
        domain.box = {{ min = [-4.0, -3.0], max = [4.0, 3.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ size = 1.0, surface = 0.1 }}
        time.unsteady = {{ {time} }}
        [[body]]
        name = "foil"
        shape.ellipse.semi_axes = [0.5, 0.1]
        center = [0.5, 0.0]
        density = 2.0
        {body}
        "#
    ))
}

const WAYS: &str = r#"motion = { x = "free", y.imposed.sine = { amplitude = 0.3, period = 1.0, ramp = 0.5 }, rotation.imposed.sine = { amplitude = "20 deg", period = 1.0, phase = 0.25, ramp = 0.5 } }"#;

/// What is given is followed to second order, and what is free obeys Newton's law: its acceleration is that of the
/// force of the fluid.
#[test]
fn a_foil_heaves_and_pitches_as_given_and_swims_freely() {
    let errors = |step: f64| {
        let outcome = run(&foil(&format!("step = {step}, end = 1.2"), WAYS));
        let way = last(&outcome, "foil.y") - 0.3 * (TAU * 1.2).sin();
        let turn = last(&outcome, "foil.angle") - PI / 9.0 * (TAU * 1.45).sin();
        let mass = 2.0 * PI * 0.5 * 0.1;
        let push = last(&outcome, "foil.force.x") / mass - last(&outcome, "foil.acceleration.x");
        assert!(push.abs() < 1e-7, "{push:e}");
        let speed = last(&outcome, "foil.velocity.y") - 0.3 * TAU * (TAU * 1.2).cos();
        assert!(speed.abs() < 1e-8, "{speed:e}");
        assert!((last(&outcome, "foil.x") - 0.5).abs() > 1e-4, "{}", last(&outcome, "foil.x"));
        way.abs().max(turn.abs())
    };
    let study = Study::run(&[0.04, 0.02], errors);
    study.record("way of a foil");
    assert!(study.order() > 1.7, "{study:?}");
}

/// Locks and factors are another way to say the same.
#[test]
fn what_is_held_and_free_by_axis_is_what_locks_say() {
    let time = "step = 0.05, end = 0.5";
    let load = "force = [1.0, 0.5]\ntorque = 0.1";
    let by_axis =
        run(&foil(time, &format!("motion = {{ x = \"free\", rotation = \"free\" }}\n{load}")));
    let locked = run(&foil(time, &format!("motion = \"free\"\nlocked = [\"y\"]\n{load}")));
    assert_eq!(bits(&by_axis), bits(&locked));
    let factor = "{ sine = { period = 1.0, phase = 0.25 } }";
    let turn = "{ sine = { period = 0.7 } }";
    let by_axis = run(&foil(
        time,
        &format!(
            "motion = {{ y.velocity = {{ value = 0.5, factor = {factor} }}, rotation.velocity = {{ value = 1.0, factor = {turn} }} }}"
        ),
    ));
    let imposed = run(&foil(
        time,
        &format!(
            "motion.imposed = {{ velocity = [0.0, 0.5], angular_velocity = 1.0, factor = {factor}, angular_factor = {turn} }}"
        ),
    ));
    for quantity in ["foil.y", "foil.angle", "foil.force.x", "foil.force.y", "foil.torque"] {
        let [one, other] = [&by_axis, &imposed].map(|outcome| column(outcome, quantity));
        assert_eq!(one, other, "{quantity}");
    }
}

fn bits(outcome: &RunSummary) -> Vec<u64> {
    outcome.series.rows.iter().flatten().map(|value| value.to_bits()).collect()
}

#[test]
fn a_driven_body_ends_with_the_same_bits_when_it_resumes() {
    for time in ["step = 0.05, end = 0.4", "step = 0.05, end = 0.4, adaptive.tolerance = 1e-2"] {
        let model = foil(time, WAYS);
        let saved: SavedState<2> = stopped(&model, 3);
        assert_eq!(bits(&resumed(&model, &saved).expect("it continues")), bits(&run(&model)));
    }
}

/// On the axis and in space, where it turns about an axis as well.
#[test]
fn spheres_are_driven_on_the_axis_and_in_space() {
    let sphere = |geometry: &str, domain: &str, center: &str, motion: &str| {
        let surface = if geometry == "spatial" { 0.9 } else { 0.6 };
        case(&format!(
            r#"
            title = "a driven sphere"
            geometry = "{geometry}"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.{domain}.radius = 4.0
            boundary.wall = "no-slip"
            mesh = {{ size = 2.0, surface = {surface}, gap_layers = 1 }}
            time.unsteady = {{ step = 0.05, end = 0.5 }}
            [[body]]
            name = "s"
            shape.sphere.radius = 1.0
            center = {center}
            motion = {motion}
            "#
        ))
    };
    let way = "imposed.sine = { amplitude = 0.3, period = 2.0 }";
    let outcome =
        run(&sphere("axisymmetric", "half-disc", "[0.0, 0.0]", &format!("{{ x.{way} }}")));
    let error = last(&outcome, "s.x") - 0.3;
    figure!(error, "way on the axis");
    // Of second order in the step: a fortieth of a period
    assert!(error.abs() < 3e-3, "{error:e}");
    let motion = format!(
        "{{ x = \"free\", z.{way}, rotation.imposed.steady.rate = 1.0, axis = [0.0, 3.0, 4.0] }}"
    );
    let model = sphere("spatial", "sphere", "[0.0, 0.0, 0.0]", &motion);
    let outcome = simulate::<3>(&model, &mut []).expect("the case runs");
    assert!((last(&outcome, "s.z") - 0.3).abs() < 3e-3);
    assert!(last(&outcome, "s.y") == 0.0 && last(&outcome, "s.x").abs() < 1e-2);
    let spin = ["x", "y", "z"].map(|axis| last(&outcome, &format!("s.angular_velocity.{axis}")));
    assert!(spin[0] == 0.0 && (spin[1] - 0.6).abs() < 1e-15 && (spin[2] - 0.8).abs() < 1e-15);
}
