//! `Lever`: a force that stays the same at a point that turns with its body: buoyancy.

use nalgebra::{Matrix3, Vector3};

use super::magnet::restoring_stiffness;
use crate::body::Pose;

/// A force that stays the same in the world, at a point of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lever {
    /// The point in the frame of the body, from its centre of mass (m).
    at: Vector3<f64>,
    /// The force (N; N/m planar).
    force: Vector3<f64>,
}

impl Lever {
    /// Of a force at a point.
    #[must_use]
    pub fn new(at: Vector3<f64>, force: Vector3<f64>) -> Self {
        Self { at, force }
    }

    /// Its torque about the centre of mass of the body at a pose (N m).
    #[must_use]
    pub fn torque(&self, pose: &Pose) -> Vector3<f64> {
        pose.to_world(&self.at).cross(&self.force)
    }

    /// The largest torque, however the body is turned (N m).
    #[must_use]
    pub fn largest_torque(&self) -> f64 {
        self.at.norm() * self.force.norm()
    }

    /// K of the torque T(pose) - K turn, as of a magnetic moment in a field (N m/rad).
    #[must_use]
    pub fn turning_stiffness(&self, pose: &Pose) -> Matrix3<f64> {
        restoring_stiffness(&pose.to_world(&self.at), &self.force)
    }
}
