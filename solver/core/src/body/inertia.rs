//! `Inertia`: mass and inertia tensor of a body, its momentum and its kinetic energy.
//!
//! Newton's and Euler's equations of a rigid body: m dU/dt = F and d(I omega)/dt = T with
//! I = R J R^T, J the constant tensor of the body frame. In time differences of the angular momentum
//! I omega the gyroscopic term omega x I omega is contained, and without torque the angular momentum
//! stays the same to rounding.

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::modes::{Modes, RigidVector};
use super::pose::Pose;
use super::twist::Twist;

/// Mass and inertia tensor about the centre of mass; per length in planar problems.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Inertia {
    /// Mass (kg; kg/m planar).
    pub mass: f64,
    /// Inertia tensor in the body frame (kg m2; kg m planar).
    pub tensor: Matrix3<f64>,
}

impl Inertia {
    /// Of a planar body that turns about z only.
    #[must_use]
    pub fn planar(mass: f64, polar: f64) -> Self {
        let mut tensor = Matrix3::zeros();
        tensor[(2, 2)] = polar;
        Self { mass, tensor }
    }

    /// The moment of inertia about z (kg m2; kg m planar).
    #[must_use]
    pub fn about_z(&self) -> f64 {
        self.tensor[(2, 2)]
    }

    /// Factor times this.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { mass: factor * self.mass, tensor: self.tensor * factor }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.mass == 0.0 && self.tensor == Matrix3::zeros()
    }

    /// The matrix that takes a velocity to the momentum of a body with this pose, 6 x 6.
    #[must_use]
    pub fn matrix(&self, pose: &Pose) -> Matrix6<f64> {
        let mut matrix = Matrix6::zeros();
        for axis in 0..3 {
            matrix[(axis, axis)] = self.mass;
        }
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&pose.tensor_to_world(&self.tensor));
        matrix
    }

    /// Linear (kg m/s) and angular momentum about the centre of mass (kg m2/s).
    #[must_use]
    pub fn momentum(&self, pose: &Pose, twist: &Twist) -> RigidVector {
        self.matrix(pose) * twist.to_vector()
    }

    /// Kinetic energy (J; J/m planar).
    #[must_use]
    pub fn kinetic_energy(&self, pose: &Pose, twist: &Twist) -> f64 {
        0.5 * twist.to_vector().dot(&self.momentum(pose, twist))
    }
}

/// The velocity, in the motions of a geometry, to which a momentum belongs: the inverse of a matrix of
/// [`Inertia::matrix`], zero in motions without inertia.
#[must_use]
pub fn velocity_of_momentum(
    matrix: &Matrix6<f64>,
    momentum: &RigidVector,
    modes: Modes,
) -> RigidVector {
    let mut velocity = RigidVector::zeros();
    for mode in modes.iter().filter(|mode| !mode.is_rotation()) {
        let mass = matrix[(mode.index(), mode.index())];
        velocity[mode] = if mass == 0.0 { 0.0 } else { momentum[mode] / mass };
    }
    let tensor: Matrix3<f64> = matrix.fixed_view::<3, 3>(3, 3).into_owned();
    let angular: Vector3<f64> = momentum.fixed_rows::<3>(3).into_owned();
    if modes == Modes::SPATIAL {
        let turn = tensor.try_inverse().map_or_else(Vector3::zeros, |inverse| inverse * angular);
        velocity.fixed_rows_mut::<3>(3).copy_from(&turn);
    } else {
        for mode in modes.rotations() {
            let moment = tensor[(mode.axis(), mode.axis())];
            velocity[mode] = if moment == 0.0 { 0.0 } else { momentum[mode] / moment };
        }
    }
    velocity
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;
    use crate::time::Bdf;

    /// A book thrown into the air, by backward differences of its angular momentum.
    struct Top {
        inertia: Inertia,
        poses: [Pose; 2],
        twists: [Twist; 2],
    }

    impl Top {
        fn new() -> Self {
            let tensor = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
            let rotation = UnitQuaternion::from_euler_angles(0.3, -0.4, 0.8);
            let pose = Pose::spatial(Vector3::new(0.1, -0.2, 0.3), rotation);
            let angular = rotation * Vector3::new(0.2, 1.0, 0.1);
            let twist = Twist { linear: Vector3::new(0.5, 0.0, -0.3), angular };
            Self { inertia: Inertia { mass: 2.0, tensor }, poses: [pose; 2], twists: [twist; 2] }
        }

        fn momentum(&self, level: usize) -> RigidVector {
            self.inertia.momentum(&self.poses[level], &self.twists[level])
        }

        fn energy(&self) -> f64 {
            self.inertia.kinetic_energy(&self.poses[1], &self.twists[1])
        }

        /// Solves a0 L_next = -(a1 L_now + a2 L_previous) by iteration on the pose.
        fn step(&mut self, bdf: &Bdf) {
            let target = -bdf.history(self.momentum(1), self.momentum(0)) / bdf.next;
            let mut twist = self.twists[1];
            let mut pose = self.poses[1];
            for _ in 0..50 {
                pose = self.poses[1].advanced(bdf, &self.poses[0], &twist);
                let matrix = self.inertia.matrix(&pose);
                let velocity = velocity_of_momentum(&matrix, &target, Modes::SPATIAL);
                twist = Twist::from_vector(&velocity);
            }
            self.poses = [self.poses[1], pose];
            self.twists = [self.twists[1], twist];
        }

        fn run(n_steps: u32) -> Self {
            let mut top = Self::new();
            let step = 4.0 / f64::from(n_steps);
            // One step in pieces that double, the first of first order
            let mut before = step / 1024.0;
            top.step(&Bdf::first_order(before));
            let mut pieces = vec![before];
            while pieces.iter().sum::<f64>() < step * (1.0 - 1e-12) {
                pieces.push(pieces.iter().sum());
            }
            for piece in pieces.into_iter().skip(1) {
                top.step(&Bdf::second_order(piece, before));
                before = piece;
            }
            for _ in 1..n_steps {
                top.step(&Bdf::second_order(step, before));
                before = step;
            }
            top
        }
    }

    #[test]
    fn a_free_asymmetric_top_keeps_its_momentum_and_to_second_order_its_energy() {
        let start = Top::new();
        let (momentum, energy) = (start.momentum(1), start.energy());
        let runs = [200, 400, 800].map(Top::run);
        for top in &runs {
            assert!((top.momentum(1) - momentum).norm() < 1e-12 * momentum.norm());
        }
        let errors = [0, 1, 2].map(|run: usize| (runs[run].energy() - energy).abs() / energy);
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1]).log2() > 1.8, "{errors:?}");
        }
        assert!(errors[2] < 1e-4, "{errors:?}");
    }

    #[test]
    fn the_pose_of_a_free_asymmetric_top_is_of_second_order() {
        let [coarse, middle, fine] = [200, 400, 800].map(Top::run);
        let turn =
            |one: &Top, other: &Top| one.poses[1].rotation().angle_to(&other.poses[1].rotation());
        let order = (turn(&coarse, &middle) / turn(&middle, &fine)).log2();
        assert!((order - 2.0).abs() < 0.2, "{order}");
        // The centre moves along a straight line at constant speed
        let end = Vector3::new(0.1 + 4.0 * 0.5, -0.2, 0.3 - 4.0 * 0.3);
        assert!((fine.poses[1].center - end).norm() < 1e-12);
    }

    #[test]
    fn velocity_and_momentum_are_inverse() {
        let top = Top::new();
        let matrix = top.inertia.matrix(&top.poses[1]);
        let back = velocity_of_momentum(&matrix, &top.momentum(1), Modes::SPATIAL);
        assert!((back - top.twists[1].to_vector()).norm() < 1e-14);
        let disc = Inertia::planar(2.0, 0.5);
        let matrix = disc.matrix(&Pose::planar(0.0, 0.0, 1.0));
        let momentum = RigidVector::from_column_slice(&[2.0, 4.0, 0.0, 0.0, 0.0, 3.0]);
        let velocity = velocity_of_momentum(&matrix, &momentum, Modes::PLANAR);
        assert_eq!(velocity.as_slice(), [1.0, 2.0, 0.0, 0.0, 0.0, 6.0]);
    }
}
