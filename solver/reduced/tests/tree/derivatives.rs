//! Derivatives of whole motions by coefficients, gaits and actions against central differences, to 1e-6.

use alewife_reduced::tree::loads::{Load, Vehicle};
use alewife_reduced::tree::{
    Command, Drive, Inputs, Joint, JointKind, Link, Number, Root, Scheme, Site, Stepper, Symmetric,
    Tendon, Tree, Wrench, real, vector,
};
use nalgebra::Matrix3;
use num_dual::Dual64;

use super::chains::{Eel, ellipsoids, moving};

/// Largest difference of a derivative, of the derivatives' size.
const CLOSE: f64 = 1e-6;

/// A motion: some results of some parameters.
trait Motion {
    fn results<T: Number>(&self, parameters: &[T]) -> Vec<T>;
}

fn compare(name: &str, motion: &impl Motion, at: &[f64]) {
    for k in 0..at.len() {
        let dual: Vec<Dual64> =
            (0..at.len()).map(|j| Dual64::new(at[j], if j == k { 1.0 } else { 0.0 })).collect();
        let found = motion.results(&dual);
        // Richardson's extrapolation of central differences
        let h = 1e-3 * at[k].abs().max(0.1);
        let difference = |h: f64| {
            let moved = |by: f64| {
                let mut at = at.to_vec();
                at[k] += by;
                motion.results(&at)
            };
            let (up, down) = (moved(h), moved(-h));
            up.iter().zip(down).map(|(a, b)| (a - b) / (2.0 * h)).collect::<Vec<f64>>()
        };
        let (coarse, fine) = (difference(h), difference(0.5 * h));
        let size = fine.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        assert!(size > 1e-9, "{name}, parameter {k}: nothing depends on it");
        for (j, found) in found.iter().enumerate() {
            let expected = (4.0 * fine[j] - coarse[j]) / 3.0;
            let wrong = (found.eps - expected).abs() / size;
            assert!(wrong < CLOSE, "{name}, parameter {k}, result {j}: {wrong:e}");
        }
    }
}

struct OfEel(Scheme);

impl Motion for OfEel {
    fn results<T: Number>(&self, p: &[T]) -> Vec<T> {
        let eel = Eel::of([p[0], p[1], p[2], p[3], p[4], p[5], p[6]], 3);
        let tree = eel.tree();
        let mut state = tree.rest();
        let mut stepper = Stepper::new(&tree, self.0);
        let mut work: T = real(0.0);
        for _ in 0..60 {
            let command = |time: f64, link: usize| eel.command(time, link);
            stepper.step(&tree, &mut state, real(0.02), &command).expect("it moves");
            work += state.efforts[3] * state.velocities[3] * 0.02;
        }
        vec![state.root.position.x, state.root.position.y, state.root.heading(), work]
    }
}

#[test]
fn by_coefficients_and_gait_of_an_eel() {
    for scheme in [Scheme::Euler, Scheme::Midpoint] {
        compare("eel", &OfEel(scheme), &[1.1, 4.0, 2.0, 3.0, 0.2, 0.5, 1.6]);
    }
}

struct OfEllipsoids;

impl Motion for OfEllipsoids {
    fn results<T: Number>(&self, p: &[T]) -> Vec<T> {
        let tree = ellipsoids([p[0], p[1], p[2], p[3], p[4]], p[5], p[6]);
        let mut state = moving(&tree);
        let mut stepper = Stepper::new(&tree, Scheme::Euler);
        // Actions: torques of both hinges
        let command = |time: f64, link: usize| Command {
            effort: p[6 + link] * (3.0 * time).sin(),
            ..Command::none()
        };
        for _ in 0..50 {
            stepper.step(&tree, &mut state, real(0.01), &command).expect("it moves");
        }
        let r = state.root.rotation();
        let mut results = vec![r[(0, 1)], r[(1, 2)], state.coordinates[6], state.coordinates[7]];
        results.extend(state.root.position.iter());
        results
    }
}

#[test]
fn by_coefficients_springs_and_torques_of_ellipsoids() {
    compare("chain", &OfEllipsoids, &[0.4, 7.8, 2.8, 3.8, 0.3, 0.5, 0.02, 0.01, -0.02]);
}

struct OfTendon;

/// Its thrust and the rate its servo is to reach are actions.
struct Drives<T: Number>([T; 2]);

impl<T: Number> Inputs<T> for Drives<T> {
    fn command(&self, _: f64, _: usize) -> Command<T> {
        Command { rate: self.0[0], ..Command::none() }
    }

    fn wrench(&self, _: f64, link: usize, _: &Matrix3<T>) -> Option<Wrench<T>> {
        let force = vector::<T>([1.0, 0.2, 0.0]) * self.0[1];
        (link == 0).then_some(Wrench { force, torque: vector([0.0, 0.1, 0.0]) })
    }
}

impl Motion for OfTendon {
    fn results<T: Number>(&self, p: &[T]) -> Vec<T> {
        let body = Symmetric::diagonal(vector([2.0, 2.0, 2.0]), vector([0.1, 0.2, 0.2]));
        let damping = Vehicle {
            added: [p[0], real(1.0), real(1.5), real(0.1), real(0.1), real(0.1)],
            linear: [p[1], real(1.0), real(1.0), real(0.1), real(0.1), real(0.1)],
            quadratic: [p[2], real(3.0), real(3.0), real(0.2), real(0.2), real(0.2)],
        };
        let servo = Drive::Servo { gain: real(0.4), limit: real(5.0) };
        let hinge = |parent| {
            Link::new(parent, Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0]), body)
                .placed([-0.3, 0.0, 0.0])
        };
        let mut first = hinge(0);
        first.joint.drive = servo;
        let links = vec![Link::root(body).loaded(Load::Vehicle(damping)), first, hinge(1)];
        let site = |link, place| Site { link, place: vector(place) };
        let tendon = Tendon {
            sites: vec![
                site(0, [0.1, 0.05, 0.0]),
                site(1, [0.0, 0.06, 0.0]),
                site(2, [-0.1, 0.05, 0.0]),
            ],
            stiffness: p[3],
            damping: real(0.5),
            rest: p[4],
            pushes: false,
        };
        let tree = Tree::new(Root::Free, links).and_then(|tree| tree.with_tendons(vec![tendon]));
        let tree = tree.expect("it is a tree");
        let mut state = tree.rest();
        let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
        for _ in 0..40 {
            stepper.step(&tree, &mut state, real(0.01), &Drives([p[5], p[6]])).expect("it moves");
        }
        vec![
            state.root.position.x,
            state.root.position.z,
            state.coordinates[6],
            state.coordinates[7],
        ]
    }
}

#[test]
fn by_a_tendon_a_servo_and_a_thrust() {
    compare("tendon", &OfTendon, &[0.7, 2.0, 3.0, 40.0, 0.6, 0.5, 3.0]);
}
