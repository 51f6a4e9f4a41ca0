//! Bodies on joints in space: what is given of them holds, and loads through joints are those of their laws.

mod sliders;

use alewife_core::case::Model;
use alewife_core::run::{RunSummary, simulate};
use nalgebra::{UnitQuaternion, Vector3};
use tests::cases::{case, column, last};
use tests::figure;

/// Two ellipsoids on a joint, turned and pulled askew, with inertia.
fn pair(joint: &str, step: f64) -> Model {
    let fluid =
        r#"model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [0.3, -0.4, 0.5]"#;
    pair_in(fluid, joint, step)
}

/// The same in another fluid.
fn pair_in(fluid: &str, joint: &str, step: f64) -> Model {
    case(&format!(
        r#"
        title = "two bodies on a joint"
        geometry = "spatial"
        fluid = {{ {fluid} }}
        domain.sphere.radius = 4.0
        boundary.wall = "no-slip"
        mesh = {{ size = 3.0, surface = 0.9, growth = 1.0, gap_layers = 1 }}
        time.unsteady = {{ step = {step}, end = 0.2 }}
        body = [
            {{ name = "front", shape.ellipsoid.semi_axes = [0.6, 0.5, 0.4], center = [0.1, 0.2, -0.1], density = 2.0, motion = "free", orientation.turned = {{ axis = [1.0, 2.0, 2.0], angle = 0.4 }} }},
            {{ name = "rear", shape.ellipsoid.semi_axes = [0.4, 0.6, 0.5], density = 3.0, motion = "free", orientation.turned = {{ axis = [0.0, 0.6, 0.8], angle = -0.7 }}, center = {center} }},
        ]
        [[joint]]
        parent = "front"
        child = "rear"
        on_parent = [-0.9, 0.1, 0.0]
        on_child = [0.8, 0.0, 0.1]
        {joint}
        "#,
        center = center(),
    ))
}

fn turned(axis: [f64; 3], angle: f64) -> UnitQuaternion<f64> {
    let axis = Vector3::from(axis);
    UnitQuaternion::from_scaled_axis(axis.normalize() * angle)
}

/// Orientations of both bodies at the start.
fn start() -> [UnitQuaternion<f64>; 2] {
    [turned([1.0, 2.0, 2.0], 0.4), turned([0.0, 0.6, 0.8], -0.7)]
}

/// Where the joint puts the rear body.
fn center() -> String {
    let [front, rear] = start();
    let joint = Vector3::new(0.1, 0.2, -0.1) + front * Vector3::new(-0.9, 0.1, 0.0);
    let center = joint - rear * Vector3::new(0.8, 0.0, 0.1);
    format!("[{:.17}, {:.17}, {:.17}]", center.x, center.y, center.z)
}

fn run(model: &Model) -> RunSummary {
    simulate::<3>(model, &mut []).expect("the case runs")
}

fn rotation(outcome: &RunSummary, body: &str) -> UnitQuaternion<f64> {
    let part = |axis: &str| last(outcome, &format!("{body}.orientation.{axis}"));
    let [w, x, y, z] = ["w", "x", "y", "z"].map(part);
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z))
}

fn vector(outcome: &RunSummary, quantity: &str) -> Vector3<f64> {
    Vector3::from(["x", "y", "z"].map(|axis| last(outcome, &format!("{quantity}{axis}"))))
}

/// How far the ends of the joint are apart (m), and the axis that rear has turned about as seen from front.
fn off(outcome: &RunSummary) -> (f64, Vector3<f64>) {
    let [front, rear] = ["front", "rear"].map(|body| rotation(outcome, body));
    let end = |body: &str, rotation: UnitQuaternion<f64>, lever: [f64; 3]| {
        vector(outcome, &format!("{body}.")) + rotation * Vector3::from(lever)
    };
    let apart = end("front", front, [-0.9, 0.1, 0.0]) - end("rear", rear, [0.8, 0.0, 0.1]);
    let [front_start, rear_start] = start();
    let rest = front_start.inverse() * rear_start;
    (apart.norm(), (front.inverse() * rear * rest.inverse()).scaled_axis())
}

/// A pivot that is bent by a given angle about an oblique axis.
#[test]
fn a_given_bend_is_kept_while_the_pair_turns() {
    let angle = "sine = { amplitude = 0.5, period = 0.8 }";
    let joint = format!("kind.bent = {{ angle = {{ {angle} }}, axis = [2.0, -1.0, 2.0] }}");
    let outcome = run(&pair(&joint, 0.04));
    let (apart, turned) = off(&outcome);
    let wanted = 0.5 * (0.5 * std::f64::consts::PI).sin();
    assert!(apart < 1e-12, "{apart:e}");
    let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    assert!((turned - axis * wanted).norm() < 1e-10, "{turned}");
    // Both turn, by much more than any error
    assert!(vector(&outcome, "front.angular_velocity.").norm() > 0.05);
}

/// Torque of the joint less that of its law, over the largest torque.
fn torque_off(outcome: &RunSummary, law: impl Fn(f64, f64) -> f64) -> f64 {
    let [angle, rate, torque] =
        ["angle", "rate", "torque"].map(|what| column(outcome, &format!("rear.joint.{what}")));
    let (mut off, mut size) = (0.0f64, 0.0f64);
    for row in 1..angle.len() {
        let wanted = law(angle[row], rate[row]);
        off = off.max((torque[row] - wanted).abs());
        size = size.max(wanted.abs());
    }
    off / size
}

#[test]
fn a_hinge_in_space_turns_about_its_axis_alone_under_the_torque_of_its_law() {
    let joint = "kind.hinge = { axis = [2.0, -1.0, 2.0], stiffness = 0.6, damping = 0.2, torque.constant = 2.0 }";
    let offs = [0.04, 0.02].map(|step| {
        let outcome = run(&pair(joint, step));
        let (apart, turned) = off(&outcome);
        let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
        let angle = last(&outcome, "rear.joint.angle");
        assert!(apart < 1e-12, "{apart:e}");
        // It begins with that of the bodies as they are turned at the start
        let gone = angle - column(&outcome, "rear.joint.angle")[0];
        assert!((turned - axis * gone).norm() < 1e-12, "{turned} {gone}");
        assert!(gone > 0.01, "{gone}");
        let [power, rate, torque] =
            ["power", "rate", "torque"].map(|what| last(&outcome, &format!("rear.joint.{what}")));
        assert!((power - rate * torque).abs() < 1e-12 * power.abs());
        torque_off(&outcome, |angle, rate| 2.0 - 0.6 * angle - 0.2 * rate)
    });
    figure!(offs[0].max(offs[1]), "torque of a hinge");
    // The torque is that at the poses of the last pass, which end up elsewhere by less than the tolerance of
    // passes, whatever the step: 1e-6 and 3e-6 were found. Taken at the poses without velocity it was off
    // by up to 5e-5, with the square of the step.
    assert!(offs.iter().all(|off| *off < 1e-5), "{offs:?}");
}

#[test]
fn a_ball_joint_turns_freely_and_keeps_its_ends_together() {
    let outcome = run(&pair("kind.ball = { stiffness = 0.6, damping = 0.2 }", 0.04));
    let (apart, turned) = off(&outcome);
    assert!(apart < 1e-12, "{apart:e}");
    assert!((turned.norm() - last(&outcome, "rear.joint.angle")).abs() < 1e-12);
    assert!(turned.norm() > 1e-3, "{turned}");
    let difference =
        vector(&outcome, "rear.angular_velocity.") - vector(&outcome, "front.angular_velocity.");
    assert!(difference.norm() > 1e-3, "{difference}");
}

/// Without inertia, where a run that starts at once is smooth in time. The first step is made in pieces: it has a
/// part of the error of the others, so that the ratio is 3.6 with 10, 20 and 40 steps (3.1 with half as many).
fn ratios_of_changes(steps: [f64; 3]) -> [f64; 2] {
    let fluid = r#"model = "stokes", viscosity = 1.0, density = 1.0, gravity = [9.0, -12.0, 15.0]"#;
    let joint = "kind.ball = { stiffness = 3.0, damping = 0.2 }";
    let [coarse, middle, fine] = steps.map(|step| {
        let outcome = run(&pair_in(fluid, joint, step));
        let (apart, turned) = off(&outcome);
        assert!(apart < 1e-12, "{apart:e}");
        [turned, vector(&outcome, "rear.")]
    });
    assert!(coarse[0].norm() > 0.05, "{}", coarse[0]);
    let ratio =
        |what: usize| (coarse[what] - middle[what]).norm() / (middle[what] - fine[what]).norm();
    let ratios = [ratio(0), ratio(1)];
    figure!(ratios[0], "ratio of turns, step {}", steps[0]);
    figure!(ratios[1], "ratio of places, step {}", steps[0]);
    ratios
}

/// Half-way between first order, 2, and second, 4, where the start is a smaller part of a run.
#[test]
fn ball_joints_in_space_are_beyond_first_order_in_few_steps() {
    let ratios = ratios_of_changes([0.04, 0.02, 0.01]);
    assert!(ratios.iter().all(|ratio| (2.9..5.0).contains(ratio)), "{ratios:?}");
}

#[test]
#[ignore = "long: 10 s; small: ball_joints_in_space_are_beyond_first_order_in_few_steps"]
fn ball_joints_in_space_are_of_second_order_in_time() {
    let ratios = ratios_of_changes([0.02, 0.01, 0.005]);
    assert!(ratios.iter().all(|ratio| (3.2..5.0).contains(ratio)), "{ratios:?}");
}
