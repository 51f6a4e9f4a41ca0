//! What is reported of joints: the loads that come through them, by an independent way.

use tests::cases::{case, column, last, run};
use tests::{figure, resumed, stopped};

/// Three hinged links with weights in a fluid: torques through the hinges less those of spring, damper
/// and motor there, over the largest torque.
fn torques_off(step: f64) -> f64 {
    let outcome = run(&case(&format!(
        r#"
        title = "three links and two hinges"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 0.1, gravity = [0.3, -1.0] }}
        domain.disc.radius = 3.0
        boundary.wall = "no-slip"
        mesh = {{ size = 1.0, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1 }}
        time.unsteady = {{ step = {step}, end = 0.2 }}
        [[swimmer]]
        name = "eel"
        density = 2.0
        [swimmer.kind.chain]
        links = [[0.3, 0.1], [0.4, 0.15], [0.3, 0.1]]
        gap = 0.3
        joints = [
            {{ hinge = {{ stiffness = 0.2, rest = 0.3, damping = 0.01 }} }},
            {{ hinge = {{ torque = {{ sine = {{ amplitude = 0.1, period = 0.8 }} }} }} }},
        ]
        "#
    )));
    let times = &outcome.series.times;
    let of = |link: usize, what: &str| column(&outcome, &format!("eel-{link}.{what}"));
    let (mut off, mut size) = (0.0f64, 0.0f64);
    for link in [1, 3] {
        let [angle, rate, torque, power] =
            ["angle", "rate", "torque", "power"].map(|what| of(link, &format!("joint.{what}")));
        let turns = of(link, "angle").into_iter().zip(of(2, "angle"));
        for (step, (own, middle)) in turns.enumerate().skip(1) {
            let law = match link {
                1 => -0.2 * (angle[step] - 0.3) - 0.01 * rate[step],
                _ => 0.1 * (2.0 * std::f64::consts::PI * times[step] / 0.8).sin(),
            };
            assert!((angle[step] - (own - middle)).abs() < 1e-14);
            assert!((power[step] - torque[step] * rate[step]).abs() < 1e-14);
            off = off.max((torque[step] - law).abs());
            size = size.max(law.abs());
        }
    }
    off / size
}

/// Newton's and Euler's equations of what hangs on a hinge give the torque of its law, but for levers
/// that are those of the last pass of a step.
#[test]
fn torques_through_hinges_are_those_of_their_laws() {
    let off = [0.02, 0.005].map(torques_off);
    figure!(off[0], "torque, step 0.02");
    figure!(off[1], "torque, step 0.005");
    assert!(off[0] < 4e-5 && off[1] < 1e-6, "{off:?}");
}

/// Without inertia all work of the joints is done on the fluid.
#[test]
fn without_inertia_joints_work_on_the_fluid_alone() {
    let planar = r#"
        geometry = "planar"
        domain.disc.radius = 3.0
        boundary.wall = "no-slip"
        [[swimmer]]
        name = "swimmer"
        [swimmer.kind.chain]
        links = [[0.3, 0.1], [0.4, 0.15], [0.3, 0.1]]
        gap = 0.3
        joints = [
            { bent = { angle = { sine = { amplitude = 0.5, period = 1.0 } } } },
            { bent = { angle = { sine = { amplitude = 0.6, period = 1.0, phase = 0.0397887 } } } },
        ]
        "#;
    let axisymmetric = r#"
        geometry = "axisymmetric"
        domain.half-disc.radius = 6.0
        boundary.wall = "no-slip"
        [[swimmer]]
        name = "swimmer"
        [swimmer.kind.linked-spheres]
        radii = [0.5, 0.4, 0.5]
        arms = [
            { sine = { mean = 1.6, amplitude = 0.3, period = 1.0 } },
            { sine = { mean = 1.7, amplitude = 0.2, period = 1.0, phase = 0.0397887 } },
        ]
        "#;
    for scene in [planar, axisymmetric] {
        let outcome = run(&case(&format!(
            r#"
            title = "work of joints"
            fluid = {{ model = "stokes", density = 1.0, viscosity = 0.7 }}
            mesh = {{ size = 1.0, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1 }}
            time.unsteady = {{ step = 0.05, end = 0.4 }}
            {scene}
            "#
        )));
        let joints: Vec<Vec<f64>> = outcome
            .series
            .names
            .iter()
            .filter(|name| name.ends_with("joint.power"))
            .map(|name| column(&outcome, name))
            .collect();
        assert_eq!(joints.len(), 2);
        for (step, power) in column(&outcome, "swimmer.power").iter().enumerate() {
            let sum: f64 = joints.iter().map(|joint| joint[step]).sum();
            // Rates of strokes are asked just inside the step, the last time is its end.
            assert!((sum / power - 1.0).abs() < 1e-6, "step {step}: {sum} and {power}");
        }
    }
}

/// In a fluid at rest an arm carries the weight of what hangs on it, less buoyancy.
#[test]
fn an_arm_carries_the_weight_of_what_hangs_on_it() {
    let outcome = run(&case(
        r#"
        title = "a weight on an arm"
        geometry = "planar"
        fluid = { model = "stokes", density = 1.0, viscosity = 1.0, gravity = [0.0, -2.0] }
        domain.disc.radius = 3.0
        boundary.wall = "no-slip"
        mesh = { size = 1.0, surface = 0.3, growth = 0.5, gap_layers = 1 }
        time.steady = {}
        [[body]]
        name = "holder"
        shape.disc.radius = 0.3
        center = [0.0, 0.5]
        motion = "held"
        [[body]]
        name = "weight"
        shape.disc.radius = 0.2
        center = [0.0, -0.5]
        density = 4.0
        motion = "free"
        [[joint]]
        parent = "holder"
        child = "weight"
        kind.arm = { length.constant = 1.0, direction = -1.5707963267948966 }
        "#,
    ));
    let weight = 3.0 * 2.0 * std::f64::consts::PI * 0.04;
    let carried = last(&outcome, "weight.joint.force");
    assert!((carried / -weight - 1.0).abs() < 1e-9, "{carried} and {weight}");
    assert!((last(&outcome, "weight.joint.length") - 1.0).abs() < 1e-14);
    assert_eq!(last(&outcome, "weight.joint.power"), 0.0);
}

#[test]
fn a_state_of_other_strokes_is_refused() {
    let with = |amplitude: f64| {
        case(&format!(
            r#"
            title = "three discs"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.disc.radius = 3.0
            boundary.wall = "no-slip"
            mesh = {{ size = 1.0, surface = 0.2, growth = 0.5, gap_layers = 1, moving.layers = 1 }}
            time.unsteady = {{ step = 0.05, end = 0.4 }}
            [[swimmer]]
            name = "three"
            [swimmer.kind.linked-spheres]
            radii = [0.2, 0.2, 0.2]
            arms = [0.7, {{ sine = {{ mean = 0.7, amplitude = {amplitude}, period = 1.0 }} }}]
            "#
        ))
    };
    let saved = stopped::<2>(&with(0.1), 3);
    assert!(resumed(&with(0.1), &saved).is_ok());
    let error = resumed(&with(0.2), &saved).expect_err("other strokes");
    let message = error.to_string();
    let key = "swimmer.0.kind.linked-spheres.arms.1.sine.amplitude = 0.1";
    assert!(message.contains(key), "{message}");
}
