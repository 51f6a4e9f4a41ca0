//! `Pose`: centre of mass and orientation of a body; how a pose follows from velocities.
//!
//! Displacements between poses are [`RigidVector`]s: the displacement of the centre, and the rotation vector
//! phi of the relative rotation, R_b = exp([phi]) R_a. Poses are advanced by backward differences of
//! these increments, which in the plane is the backward difference of the angle, and in space is of
//! second order as well: with omega the angular velocity at the new time,
//! R_next = exp([theta]) R_now, theta = (omega + a2 phi) / a0, phi the rotation vector of the step
//! before and a0, a2 as in [`Bdf`]. The rate of a rotation vector differs from omega by theta x omega / 2;
//! theta is the step times omega up to first order, so that this is of second order in the step.

use nalgebra::{Matrix3, UnitQuaternion, UnitVector3, Vector3, Vector4};
use serde::{Deserialize, Serialize};

use super::modes::RigidVector;
use super::twist::Twist;
use crate::time::Bdf;

/// How a body is turned from its own frame to the world.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Orientation {
    /// By an angle about z (rad), which counts full turns.
    Planar(f64),
    /// By a rotation of space.
    Spatial(UnitQuaternion<f64>),
}

impl Orientation {
    /// A weighted mean of orientations that are near each other (weights of sum 1).
    #[must_use]
    pub fn mean<const N: usize>(of: [Self; N], weights: [f64; N]) -> Self {
        let (mut angle, mut sum) = (0.0, Vector4::zeros());
        let mut first = None;
        for (orientation, weight) in of.into_iter().zip(weights) {
            match orientation {
                Self::Planar(own) => angle += weight * own,
                Self::Spatial(own) => {
                    // The one of both quaternions of a rotation that is near
                    let coords = own.into_inner().coords;
                    let first = first.get_or_insert(coords);
                    let sign = if first.dot(&coords) < 0.0 { -1.0 } else { 1.0 };
                    sum += coords * (sign * weight);
                }
            }
        }
        match first {
            Some(_) => Self::Spatial(UnitQuaternion::new_normalize(sum.into())),
            None => Self::Planar(angle),
        }
    }

    /// The angle turned since another orientation (rad): in the plane over all turns, in space that
    /// of the shortest rotation.
    #[must_use]
    pub fn angle_from(&self, start: &Self) -> f64 {
        match (self, start) {
            (Self::Planar(end), Self::Planar(begin)) => end - begin,
            (Self::Spatial(end), Self::Spatial(begin)) => begin.angle_to(end),
            _ => f64::NAN,
        }
    }
}

/// Where a body is and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Centre of mass, in the world (m).
    pub center: Vector3<f64>,
    /// Rotation from the body frame to the world.
    pub orientation: Orientation,
}

impl Pose {
    /// A pose in the plane: the centre's z is zero and the body is turned about z.
    #[must_use]
    pub fn planar(x: f64, y: f64, angle: f64) -> Self {
        Self { center: Vector3::new(x, y, 0.0), orientation: Orientation::Planar(angle) }
    }

    /// A pose in space.
    #[must_use]
    pub fn spatial(center: Vector3<f64>, rotation: UnitQuaternion<f64>) -> Self {
        Self { center, orientation: Orientation::Spatial(rotation) }
    }

    /// The pose of the laboratory, in the plane or in space as this one is.
    #[must_use]
    pub fn laboratory(&self) -> Self {
        let orientation = match self.orientation {
            Orientation::Planar(_) => Orientation::Planar(0.0),
            Orientation::Spatial(_) => Orientation::Spatial(UnitQuaternion::identity()),
        };
        Self { center: Vector3::zeros(), orientation }
    }

    /// Angle of the rotation about z (rad): of a planar pose the one that counts full turns, of a
    /// spatial one that of the image of the x axis, within (-pi, pi].
    #[must_use]
    pub fn angle(&self) -> f64 {
        match self.orientation {
            Orientation::Planar(angle) => angle,
            Orientation::Spatial(_) => self.heading(),
        }
    }

    /// The direction of the body's x axis in the x-y plane (rad), within (-pi, pi].
    #[must_use]
    pub fn heading(&self) -> f64 {
        let ahead = self.rotation() * Vector3::x();
        ahead.y.atan2(ahead.x)
    }

    /// The rotation from the body frame to the world.
    #[must_use]
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        match self.orientation {
            Orientation::Planar(angle) => {
                UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle)
            }
            Orientation::Spatial(rotation) => rotation,
        }
    }

    /// A vector of the body frame in the world.
    #[must_use]
    pub fn to_world(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        match self.orientation {
            Orientation::Planar(angle) => {
                let (sin, cos) = angle.sin_cos();
                let [x, y] = [cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y];
                Vector3::new(x, y, vector.z)
            }
            Orientation::Spatial(rotation) => rotation * vector,
        }
    }

    /// A vector of the world in the body frame.
    #[must_use]
    pub fn to_body(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.rotation().inverse() * vector
    }

    /// A symmetric tensor of the body frame in the world: R T R^T.
    #[must_use]
    pub fn tensor_to_world(&self, tensor: &Matrix3<f64>) -> Matrix3<f64> {
        match self.orientation {
            Orientation::Planar(_) if is_diagonal_about_z(tensor) => *tensor,
            _ => {
                let rotation = self.rotation().to_rotation_matrix();
                rotation * tensor * rotation.transpose()
            }
        }
    }

    /// The pose turned about its centre by an angle (rad) about an axis of the body frame.
    #[must_use]
    pub fn turned(&self, axis: &UnitVector3<f64>, angle: f64) -> Self {
        let orientation = match self.orientation {
            Orientation::Planar(before) => Orientation::Planar(before + axis.z * angle),
            Orientation::Spatial(rotation) => {
                Orientation::Spatial(rotation * UnitQuaternion::from_axis_angle(axis, angle))
            }
        };
        Self { orientation, ..*self }
    }

    /// The pose turned about its centre by a rotation of the body frame; a planar one stays as it is.
    #[must_use]
    pub fn composed(&self, rotation: &UnitQuaternion<f64>) -> Self {
        let orientation = match self.orientation {
            Orientation::Planar(angle) => Orientation::Planar(angle),
            Orientation::Spatial(before) => Orientation::Spatial(before * rotation),
        };
        Self { orientation, ..*self }
    }

    /// The pose with its centre moved by a vector (m).
    #[must_use]
    pub fn shifted(&self, shift: &Vector3<f64>) -> Self {
        Self { center: self.center + shift, ..*self }
    }

    /// The displacement that leads here from another pose (m, rad): displacement of the centre and rotation
    /// vector of the relative rotation; in the plane full turns count.
    #[must_use]
    pub fn displacement_from(&self, start: &Self) -> RigidVector {
        let shift = self.center - start.center;
        let turn = match (self.orientation, start.orientation) {
            (Orientation::Planar(end), Orientation::Planar(begin)) => {
                Vector3::new(0.0, 0.0, end - begin)
            }
            _ => (self.rotation() * start.rotation().inverse()).scaled_axis(),
        };
        RigidVector::from_fn(|i, _| if i < 3 { shift[i] } else { turn[i - 3] })
    }

    /// The pose a displacement (m, rad) leads to from here. A planar pose stays planar: it has no
    /// part in what turns it about x or y.
    #[must_use]
    pub fn displaced(&self, displacement: &RigidVector) -> Self {
        let (shift, turn) = (displacement.fixed_rows::<3>(0), displacement.fixed_rows::<3>(3));
        let orientation = match self.orientation {
            Orientation::Planar(angle) => Orientation::Planar(angle + turn.z),
            Orientation::Spatial(rotation) => {
                let mut turned = UnitQuaternion::from_scaled_axis(turn.into_owned()) * rotation;
                turned.renormalize();
                Orientation::Spatial(turned)
            }
        };
        Self { center: self.center + shift, orientation }
    }

    /// The pose a body that is here, and was at `previous` one step before, gets to with a velocity at
    /// the new time; what rests stays where it is to the last bit.
    #[must_use]
    pub fn advanced(&self, bdf: &Bdf, previous: &Self, velocity: &Twist) -> Self {
        self.displaced(&bdf.increment(velocity.to_vector(), self.displacement_from(previous)))
    }

    /// The velocity at the new time of a body that gets to `next` from here, and was at `previous` one
    /// step before: the inverse of [`Self::advanced`].
    #[must_use]
    pub fn velocity_to(&self, bdf: &Bdf, next: &Self, previous: &Self) -> Twist {
        let increments = [next.displacement_from(self), self.displacement_from(previous)];
        Twist::from_vector(&bdf.rate_of_increments(increments))
    }
}

/// The rate of a displacement (m, rad) of a body with a velocity: with the rotation vector theta and the
/// angular velocity omega, omega - theta x omega / 2 + theta x (theta x omega) / 12, to fourth order in theta.
#[must_use]
pub fn rate_of_displacement(displacement: &RigidVector, velocity: &Twist) -> RigidVector {
    let turn = Vector3::from(displacement.fixed_rows::<3>(3));
    let across = turn.cross(&velocity.angular);
    let angular = velocity.angular - across / 2.0 + turn.cross(&across) / 12.0;
    Twist { linear: velocity.linear, angular }.to_vector()
}

/// Whether turns about z leave a tensor as it is.
fn is_diagonal_about_z(tensor: &Matrix3<f64>) -> bool {
    let off = |i: usize, j: usize| i != j && tensor[(i, j)] != 0.0;
    let has_off = (0..9).any(|entry| off(entry / 3, entry % 3));
    !has_off && tensor[(0, 0)] == tensor[(1, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(pose: &Pose, vector: &Vector3<f64>) -> Vector3<f64> {
        pose.rotation() * vector
    }

    #[test]
    fn planar_and_spatial_poses_turn_vectors_alike() {
        let vector = Vector3::new(0.3, -1.2, 0.4);
        for angle in [0.0, 0.4, -2.0, 3.1, 7.0] {
            let planar = Pose::planar(1.0, 2.0, angle);
            let spatial = Pose::spatial(planar.center, planar.rotation());
            assert!((planar.to_world(&vector) - spatial.to_world(&vector)).norm() < 1e-15);
            assert!((planar.to_body(&planar.to_world(&vector)) - vector).norm() < 1e-15);
            assert!((planar.to_world(&vector) - turned(&planar, &vector)).norm() < 1e-15);
            assert!((spatial.angle() - angle).sin().abs() < 1e-15);
        }
    }

    #[test]
    fn rates_of_rotation_vectors_are_those_of_angular_velocities() {
        let path =
            |time: f64| Vector3::new(0.1 * time, -0.05 + 0.2 * time, 0.08 - 0.3 * time * time);
        let at = |time: f64| UnitQuaternion::from_scaled_axis(path(time));
        let small = 1e-5;
        let angular = (at(small) * at(-small).inverse()).scaled_axis() / (2.0 * small);
        let velocity = Twist { linear: Vector3::x(), angular };
        let way = RigidVector::from_fn(|i, _| if i < 3 { 0.0 } else { path(0.0)[i - 3] });
        let rate = rate_of_displacement(&way, &velocity);
        let exact = (path(small) - path(-small)) / (2.0 * small);
        let off = (Vector3::from(rate.fixed_rows::<3>(3)) - exact).norm();
        // Its rotation vector is 0.1 long: the next term of the series is its fourth power over 720
        assert!(off < 1e-7, "{off:e}");
        assert!((angular - exact).norm() > 1e-3);
        assert_eq!(rate.fixed_rows::<3>(0), Vector3::x());
    }

    #[test]
    fn orientations_between_are_near_those_of_a_steady_turn() {
        let axis = Vector3::new(0.3, -0.5, 0.8).normalize();
        let at = |time: f64| UnitQuaternion::from_scaled_axis(axis * time);
        // The quaternion of the middle one has the other sign
        let other = UnitQuaternion::new_unchecked(-at(0.1).into_inner());
        let three = [at(0.0), other, at(0.2)].map(Orientation::Spatial);
        let between = Orientation::mean(three, [0.375, 0.75, -0.125]);
        // A parabola is off by the third derivative of sin(angle / 2)
        assert!((between.angle_from(&three[0]) - 0.05).abs() < 2e-5, "{between:?}");
        let planar = [1.0, 2.0, 9.0].map(Orientation::Planar);
        assert_eq!(Orientation::mean(planar, [0.5, 0.5, 0.0]), Orientation::Planar(1.5));
    }

    #[test]
    fn a_displacement_leads_from_pose_to_pose() {
        let start = Pose::spatial(
            Vector3::new(0.1, 0.2, 0.3),
            UnitQuaternion::from_euler_angles(0.4, -0.2, 1.1),
        );
        let end = Pose::spatial(
            Vector3::new(-1.0, 0.5, 2.0),
            UnitQuaternion::from_euler_angles(-0.3, 0.6, 2.0),
        );
        let reached = start.displaced(&end.displacement_from(&start));
        assert!((reached.center - end.center).norm() < 1e-15);
        assert!(reached.rotation().angle_to(&end.rotation()) < 1e-14);
        // Angles of the plane count full turns
        let many = Pose::planar(0.0, 0.0, 20.0).displacement_from(&Pose::planar(0.0, 0.0, 1.0));
        assert_eq!(many[5], 19.0);
        let tensor = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
        let world = end.tensor_to_world(&tensor);
        let axis = turned(&end, &Vector3::y());
        assert!((world * axis - axis * 2.0).norm() < 1e-14);
    }

    /// A body that spins about z while it drifts: the planar pose and the quaternion agree.
    #[test]
    fn a_quaternion_follows_a_planar_angle() {
        let bdf = Bdf::second_order(0.1, 0.07);
        let plane = [Pose::planar(0.0, 0.0, 0.3), Pose::planar(0.1, 0.2, 0.5)];
        let space = plane.map(|pose| Pose::spatial(pose.center, pose.rotation()));
        let velocity =
            Twist { linear: Vector3::new(1.0, -2.0, 0.0), angular: Vector3::new(0.0, 0.0, 4.0) };
        let [flat, round] = [plane, space].map(|[before, now]| {
            let next = now.advanced(&bdf, &before, &velocity);
            let back = now.velocity_to(&bdf, &next, &before);
            assert!((back.to_vector() - velocity.to_vector()).norm() < 1e-13);
            next
        });
        assert!((flat.center - round.center).norm() < 1e-15);
        assert!(flat.rotation().angle_to(&round.rotation()) < 1e-15);
    }

    #[test]
    fn what_rests_stays_to_the_last_bit() {
        let pose = Pose::planar(0.3, -0.7, 1.234);
        let bdf = Bdf::second_order(0.1, 0.07);
        assert_eq!(pose.advanced(&bdf, &pose, &Twist::default()), pose);
        assert_eq!(pose.velocity_to(&bdf, &pose, &pose), Twist::default());
    }
}
