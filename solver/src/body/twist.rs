//! `Twist` and `Wrench`: linear and angular velocity, force and torque.

use nalgebra::Vector3;

/// Rigid velocity of a body: u(x) = linear + angular x (x - centre).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Twist {
    /// Velocity of the centre of mass, in the world (m/s).
    pub linear: Vector3<f64>,
    /// Angular velocity, in the world (rad/s).
    pub angular: Vector3<f64>,
}

impl Twist {
    /// Velocity of the material point at `lever` = x - centre (m/s).
    #[must_use]
    pub fn velocity_at(&self, lever: &Vector3<f64>) -> Vector3<f64> {
        self.linear + self.angular.cross(lever)
    }
}

/// Force and torque about the centre of mass; per unit length in planar problems.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Wrench {
    /// Force, in the world (N).
    pub force: Vector3<f64>,
    /// Torque about the centre of mass, in the world (N m).
    pub torque: Vector3<f64>,
}

impl std::ops::Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}
