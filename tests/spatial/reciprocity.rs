//! Resistances of a body near a wall are symmetric, and invert the velocities of the free body.

use alewife_core::run::{RunSummary, simulate};
use nalgebra::Vector3;
use tests::cases::{case, last};
use tests::figure;

const ELLIPSOID: &str = "shape.ellipsoid.semi_axes = [1.2, 0.9, 0.7]";

const HELIX: &str = "shape.helix = { radius = 0.5, pitch = 1.5, turns = 1.1, tube_radius = 0.25 }";

/// A head and a tail that is part of the same body.
const HEAD_AND_HELIX: &str = "shape.union = [
    { shape = { ellipsoid = { semi_axes = [0.9, 0.6, 0.6] } } },
    { shape = { helix = { radius = 0.3, pitch = 1.5, turns = 0.7, tube_radius = 0.2 } }, center = [0.6, 0.0, 0.0] },
]";

/// An oblique body above the wall of a box, on a coarse mesh that is solved iteratively.
fn run(shape: &str, motion: &str) -> RunSummary {
    let text = format!(
        r#"
        title = "a body near a wall"
        geometry = "spatial"
        fluid = {{ model = "stokes", viscosity = 0.7 }}
        domain.box = {{ min = [-4.0, -4.0, 0.0], max = [4.0, 4.0, 5.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip", back = "no-slip", front = "no-slip" }}
        mesh = {{ size = 3.0, surface = 0.4, growth = 0.5, gap_layers = 2 }}
        time.steady = {{}}
        [[body]]
        name = "body"
        {shape}
        center = [0.2, -0.1, 1.6]
        orientation.turned = {{ axis = [1.0, 2.0, -1.0], angle = 0.8 }}
        {motion}
        "#
    );
    simulate::<3>(&case(&text), &mut []).expect("the case runs")
}

fn vector(outcome: &RunSummary, quantity: &str) -> Vector3<f64> {
    let part = |axis: &str| last(outcome, &format!("body.{quantity}.{axis}"));
    Vector3::new(part("x"), part("y"), part("z"))
}

/// Velocity and angular velocity, or force and torque.
#[derive(Debug, Clone, Copy)]
struct Screw {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
}

impl Screw {
    fn new(linear: [f64; 3], angular: [f64; 3]) -> Self {
        Self { linear: linear.into(), angular: angular.into() }
    }

    fn of(outcome: &RunSummary, quantities: [&str; 2]) -> Self {
        let [linear, angular] = quantities.map(|quantity| vector(outcome, quantity));
        Self { linear, angular }
    }

    fn work(&self, other: &Self) -> f64 {
        self.linear.dot(&other.linear) + self.angular.dot(&other.angular)
    }

    /// Load of the fluid on the body that moves this way.
    fn resistance(&self, shape: &str) -> Self {
        let [velocity, angular_velocity] =
            [self.linear, self.angular].map(|vector| vector.as_slice().to_vec());
        let motion = format!(
            "motion.imposed = {{ velocity = {velocity:?}, angular_velocity = {angular_velocity:?} }}"
        );
        Self::of(&run(shape, &motion), ["force", "torque"])
    }
}

#[test]
fn a_free_ellipsoid_moves_with_the_velocities_whose_resistances_pull_it() {
    assert_reciprocity(ELLIPSOID);
}

#[test]
fn so_does_a_free_helix() {
    assert_reciprocity(HELIX);
}

#[test]
fn and_a_head_with_a_helical_tail() {
    assert_reciprocity(HEAD_AND_HELIX);
}

fn assert_reciprocity(shape: &str) {
    let first = Screw::new([0.48, 0.6, 0.64], [0.3, -0.5, 0.2]);
    let second = Screw::new([-0.7, 0.1, 0.4], [0.2, 0.6, -0.9]);
    let [of_first, of_second] = [first, second].map(|motion| motion.resistance(shape));
    let [one, other] = [of_first.work(&second), of_second.work(&first)];
    let size = (of_first.work(&first) * of_second.work(&second)).sqrt();
    figure!((one - other) / size, "{shape}: work");
    assert!((one - other).abs() < 1e-8 * size, "{one} {other}");

    let [force, torque] =
        [of_first.linear, of_first.angular].map(|vector| (-vector).as_slice().to_vec());
    let pulled = run(shape, &format!("motion = \"free\"\nforce = {force:?}\ntorque = {torque:?}"));
    let moved = Screw::of(&pulled, ["velocity", "angular_velocity"]);
    let off = (moved.linear - first.linear).amax().max((moved.angular - first.angular).amax());
    figure!(off, "{shape}: free");
    assert!(off < 1e-8, "{moved:?}");
}
