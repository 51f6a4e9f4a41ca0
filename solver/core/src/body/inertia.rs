//! `Inertia`: mass and inertia tensor of a body, its momentum and its kinetic energy.
//!
//! Newton's and Euler's equations of a rigid body: m dU/dt = F and d(I omega)/dt = T with
//! I = R J R^T, J the constant tensor of the body frame. In time differences of the angular momentum
//! I omega the gyroscopic term omega x I omega is contained, and without torque the angular momentum
//! stays the same to rounding.

use nalgebra::{Matrix3, Matrix6};

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

/// The velocity with which a body of the mass matrix `next` has the momentum that one of the matrix
/// `then` has with `velocity`: next^-1 then velocity in the motions of a geometry.
///
/// Without inertia, and where both matrices are equal, it is the velocity itself to the last bit.
#[must_use]
pub fn carried_velocity(
    then: &Matrix6<f64>,
    next: &Matrix6<f64>,
    velocity: &RigidVector,
    modes: Modes,
) -> RigidVector {
    if then == next {
        return *velocity;
    }
    let mut carried = *velocity;
    if modes == Modes::SPATIAL {
        let half = |matrix: &Matrix6<f64>| matrix.fixed_view::<3, 3>(3, 3).into_owned();
        let angular = half(then) * velocity.fixed_rows::<3>(3);
        if let Some(inverse) = half(next).try_inverse() {
            carried.fixed_rows_mut::<3>(3).copy_from(&(inverse * angular));
        }
    } else {
        for mode in modes.rotations() {
            let moment = |matrix: &Matrix6<f64>| matrix[(mode.index(), mode.index())];
            if moment(next) > 0.0 {
                carried[mode] *= moment(then) / moment(next);
            }
        }
    }
    carried
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

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

        /// Solves a0 L_next + a1 L_now + a2 L_previous = 0 by iteration on the pose.
        fn step(&mut self, bdf: &Bdf) {
            let mut twist = self.twists[1];
            let mut pose = self.poses[1];
            for _ in 0..50 {
                pose = self.poses[1].advanced(bdf, &self.poses[0], &twist);
                let next = self.inertia.matrix(&pose);
                let [before, now] = [0, 1].map(|level: usize| {
                    let then = self.inertia.matrix(&self.poses[level]);
                    let velocity = self.twists[level].to_vector();
                    carried_velocity(&then, &next, &velocity, Modes::SPATIAL)
                });
                twist = Twist::from_vector(&(bdf.history(now, before) * (-1.0 / bdf.next)));
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
    fn carried_velocities_have_the_same_momentum() {
        let top = Top::new();
        let next = top.inertia.matrix(&Pose::spatial(
            Vector3::zeros(),
            UnitQuaternion::from_euler_angles(-1.0, 0.2, 0.3),
        ));
        let (then, velocity) = (top.inertia.matrix(&top.poses[1]), top.twists[1].to_vector());
        let carried = carried_velocity(&then, &next, &velocity, Modes::SPATIAL);
        assert!((next * carried - top.momentum(1)).norm() < 1e-14);
        assert_eq!(carried_velocity(&then, &then, &velocity, Modes::SPATIAL), velocity);
        let [disc, smaller] = [0.5, 0.25]
            .map(|polar| Inertia::planar(2.0, polar).matrix(&Pose::planar(0.0, 0.0, 1.0)));
        let velocity = RigidVector::from_column_slice(&[2.0, 4.0, 0.0, 0.0, 0.0, 3.0]);
        let carried = carried_velocity(&disc, &smaller, &velocity, Modes::PLANAR);
        assert_eq!(carried.as_slice(), [2.0, 4.0, 0.0, 0.0, 0.0, 6.0]);
    }
}
