//! Runs that continue from about the step in which other velocities of bodies on a joint become the unknowns.
//!
//! The unknown of a slider or hinge is the velocity along, or about, the axis of the laboratory to which its own
//! axis is closest. Where it turns past the diagonal of two of them the system is numbered again, and a run has to
//! resume with what the solver kept for the state it resumes from.

use std::f64::consts::{FRAC_PI_4, SQRT_2};

use alewife_core::case::Model;
use alewife_core::run::{Dimension, SavedState, Solve, simulate};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use tests::cases::{case, column};
use tests::{stopped, stopped_again, stopped_within_a_step};

/// A joint whose axis, in some direction at first, turns with body `a`.
struct Turning {
    /// The case of an axis in a direction, measured in the plane of the diagonal, for a number of steps.
    model: fn(f64, usize) -> Model,
    /// Steps after which the axis is to be near the diagonal.
    steps: usize,
}

const WITH_INERTIA: &str =
    r#"{ model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [0.3, -0.4] }"#;
const WITHOUT: &str =
    r#"{ model = "stokes", viscosity = 1.0, density = 1.0, gravity = [0.3, -0.4] }"#;

/// By passes, with cells fine enough for factors to serve several steps.
fn slider_by_passes(direction: f64, n_steps: usize) -> Model {
    let time = format!("{{ step = 0.01, end = {}, scheme = \"bdf1\" }}", 0.01 * n_steps as f64);
    slider(
        direction,
        WITH_INERTIA,
        &time,
        "stiffness = 2.0, rest = 1.6, damping = 0.3",
        [0.2, 0.03],
    )
}

/// By stages, of which each has a number of its own.
fn slider_by_stages(direction: f64, n_steps: usize) -> Model {
    let time = format!("{{ step = 0.001, end = {}, scheme = \"rk3\" }}", 0.001 * n_steps as f64);
    slider(direction, WITHOUT, &time, "stiffness = 0.0", [0.3, 0.06])
}

/// Two discs on an arm of free length, which a torque turns.
fn slider(direction: f64, fluid: &str, time: &str, arm: &str, [size, surface]: [f64; 2]) -> Model {
    let (x, y) = (1.36 * direction.cos() - 0.4, 1.36 * direction.sin() - 0.5);
    case(&format!(
        r#"
        title = "two discs on an arm that turns"
        geometry = "planar"
        fluid = {fluid}
        domain.disc.radius = 4.0
        boundary.wall = "no-slip"
        mesh = {{ size = {size}, surface = {surface}, growth = 0.6, gap_layers = 1 }}
        time.unsteady = {time}
        body = [
            {{ name = "a", shape.disc.radius = 0.5, center = [-0.4, -0.5], density = 2.0, motion = "free", torque = 3.0 }},
            {{ name = "b", shape.disc.radius = 0.4, center = [{x}, {y}], density = 3.0, motion = "free" }},
        ]
        [[joint]]
        parent = "a"
        child = "b"
        kind.slider = {{ direction = {direction}, {arm} }}
        "#
    ))
}

/// Two ellipsoids on a hinge whose axis, in a direction from y at first, a torque turns about x.
fn hinge(direction: f64, n_steps: usize) -> Model {
    let [y, z] = [direction.cos(), direction.sin()].map(|part| SQRT_2 * part);
    let end = 0.02 * n_steps as f64;
    case(&format!(
        r#"
        title = "two ellipsoids on a hinge that turns"
        geometry = "spatial"
        fluid = {{ model = "navier-stokes", viscosity = 1.0, density = 1.0, gravity = [0.3, -0.4, 0.5] }}
        domain.sphere.radius = 2.5
        boundary.wall = "no-slip"
        mesh = {{ size = 2.0, surface = 0.8, growth = 1.0, gap_layers = 1 }}
        time.unsteady = {{ step = 0.02, end = {end}, scheme = "bdf1" }}
        body = [
            {{ name = "a", shape.ellipsoid.semi_axes = [0.6, 0.5, 0.4], center = [0.9, 0.1, 0.0], density = 2.0, motion = "free", torque = [4.0, 0.0, 0.0] }},
            {{ name = "b", shape.ellipsoid.semi_axes = [0.4, 0.6, 0.5], center = [-0.8, 0.1, 0.0], density = 3.0, motion = "free" }},
        ]
        [[joint]]
        parent = "a"
        child = "b"
        on_parent = [-0.9, 0.1, 0.0]
        on_child = [0.8, 0.1, 0.0]
        kind.hinge = {{ axis = [0.2, {y}, {z}], stiffness = 0.6, damping = 0.2, torque.constant = 2.0 }}
        "#,
    ))
}

/// More questions whether to stop than are asked within a step, factorisations and assembly included.
const MOST_QUESTIONS: usize = 5000;

impl Turning {
    /// How far the axis is beyond the diagonal after the steps, from its direction at first.
    fn beyond_diagonal<const D: usize>(&self, direction: f64) -> f64
    where
        Dimension<D>: Solve<D>,
    {
        let whole = simulate::<D>(&(self.model)(direction, self.steps), &mut []);
        let whole = whole.expect("the case runs");
        let of_a = |what: &str| column(&whole, &format!("a.{what}"))[self.steps];
        if D == 2 {
            return direction + of_a("angle") - FRAC_PI_4;
        }
        let [w, x, y, z] = ["w", "x", "y", "z"].map(|part| of_a(&format!("orientation.{part}")));
        let axis = Vector3::new(0.2, SQRT_2 * direction.cos(), SQRT_2 * direction.sin());
        let turned = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)) * axis;
        turned.z.atan2(turned.y) - FRAC_PI_4
    }

    /// The direction at first of an axis that is at the diagonal after the steps: it turns by about the same angle
    /// from all of them.
    fn to_diagonal<const D: usize>(&self) -> f64
    where
        Dimension<D>: Solve<D>,
    {
        let nearer = |direction: f64, _| direction - self.beyond_diagonal::<D>(direction);
        (0..2).fold(FRAC_PI_4, nearer)
    }

    /// Stops a run before the last of the steps, at the first questions whether to stop in it, at some of those that
    /// follow, and after it: what continues from there has the same state, with all quantities so far, one step
    /// later. Most stops in a step leave the same state, from which it is enough to continue once.
    fn goes_on_with_the_same_bits<const D: usize>(&self, direction: f64, off: f64)
    where
        Dimension<D>: Solve<D>,
    {
        let is = self.beyond_diagonal::<D>(direction);
        assert!((is - off).abs() < 0.5 * off.abs(), "{off:e} was wanted, and it is {is:e}");
        let (model, end) = ((self.model)(direction, self.steps + 2), self.steps + 1);
        let whole: SavedState<D> = stopped(&model, end);
        let next = |spared: &usize| Some(spared + 1 + spared / 2);
        let mut tried: Vec<SavedState<D>> = Vec::new();
        for spared in std::iter::successors(Some(0), next).take_while(|n| *n < MOST_QUESTIONS) {
            let stopped = stopped_within_a_step::<D>(&model, self.steps - 1, spared).state;
            let saved = stopped.expect("it left a state");
            if tried.contains(&saved) {
                continue;
            }
            let rest = stopped_again(&model, &saved, end);
            assert!(rest == whole, "{off:e} beyond the diagonal, {spared} questions in the step");
            if saved.step() == self.steps {
                return;
            }
            tried.push(saved);
        }
        panic!("the step does not end");
    }
}

/// It ends the step before the diagonal by less than a nanoradian, past which the flow of the step was solved.
#[test]
fn an_arm_that_does_not_reach_the_diagonal_by_a_hair_goes_on_with_the_same_bits() {
    let turning = Turning { model: slider_by_passes, steps: 3 };
    let off = -3e-10;
    turning.goes_on_with_the_same_bits::<2>(turning.to_diagonal::<2>() + off, off);
}

/// In a step it turns by 2.5e-4, so that it passes the diagonal between any two stages.
#[test]
fn an_arm_that_passes_the_diagonal_between_stages_goes_on_with_the_same_bits() {
    let turning = Turning { model: slider_by_stages, steps: 2 };
    let to_diagonal = turning.to_diagonal::<2>();
    for off in [2e-5, 1e-4, 2e-4] {
        turning.goes_on_with_the_same_bits::<2>(to_diagonal + off, off);
    }
}

#[test]
#[ignore = "long: 25 s; small: an_arm_that_does_not_reach_the_diagonal_by_a_hair_goes_on_with_the_same_bits"]
fn a_hinge_in_space_that_does_not_reach_the_diagonal_by_a_hair_goes_on_with_the_same_bits() {
    let turning = Turning { model: hinge, steps: 3 };
    let off = -1e-8;
    turning.goes_on_with_the_same_bits::<3>(turning.to_diagonal::<3>() + off, off);
}
