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
    /// A velocity in the plane with a turn about z: x, y (m/s) and rad/s.
    #[must_use]
    pub fn planar([x, y, spin]: [f64; 3]) -> Self {
        Self { linear: Vector3::new(x, y, 0.0), angular: Vector3::new(0.0, 0.0, spin) }
    }

    /// Its parts in the plane: x, y (m/s) and about z (rad/s).
    #[must_use]
    pub fn in_plane(&self) -> [f64; 3] {
        [self.linear.x, self.linear.y, self.angular.z]
    }

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

impl Wrench {
    /// A force in the plane with a torque about z: x, y (N) and N m.
    #[must_use]
    pub fn planar([x, y, torque]: [f64; 3]) -> Self {
        Self { force: Vector3::new(x, y, 0.0), torque: Vector3::new(0.0, 0.0, torque) }
    }

    /// Its parts in the plane: x, y (N) and about z (N m).
    #[must_use]
    pub fn in_plane(&self) -> [f64; 3] {
        [self.force.x, self.force.y, self.torque.z]
    }
}

impl std::ops::Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}
