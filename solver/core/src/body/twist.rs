//! `Twist` and `Wrench`: linear and angular velocity, force and torque.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::modes::{Mode, RigidVector};

/// Rigid velocity of a body: u(x) = linear + angular x (x - centre).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// Velocity of the centre of mass, in the world (m/s).
    pub linear: Vector3<f64>,
    /// Angular velocity, in the world (rad/s).
    pub angular: Vector3<f64>,
}

/// The linear and the angular half of a vector.
fn halves(vector: &RigidVector) -> [Vector3<f64>; 2] {
    [0, 3].map(|first| vector.fixed_rows::<3>(first).into_owned())
}

fn joined(linear: &Vector3<f64>, angular: &Vector3<f64>) -> RigidVector {
    RigidVector::from_fn(|i, _| if i < 3 { linear[i] } else { angular[i - 3] })
}

impl Twist {
    /// From its components.
    #[must_use]
    pub fn from_vector(vector: &RigidVector) -> Self {
        let [linear, angular] = halves(vector);
        Self { linear, angular }
    }

    /// Its components.
    #[must_use]
    pub fn to_vector(&self) -> RigidVector {
        joined(&self.linear, &self.angular)
    }

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

    /// The component along a motion (m/s or rad/s).
    #[must_use]
    pub fn component(&self, mode: Mode) -> f64 {
        if mode.is_rotation() { self.angular[mode.axis()] } else { self.linear[mode.axis()] }
    }

    /// Velocity of the material point at `lever` = x - centre (m/s).
    #[must_use]
    pub fn velocity_at(&self, lever: &Vector3<f64>) -> Vector3<f64> {
        self.linear + self.angular.cross(lever)
    }
}

/// Force and torque about the centre of mass; per unit length in planar problems.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// Force, in the world (N).
    pub force: Vector3<f64>,
    /// Torque about the centre of mass, in the world (N m).
    pub torque: Vector3<f64>,
}

impl Wrench {
    /// From its components.
    #[must_use]
    pub fn from_vector(vector: &RigidVector) -> Self {
        let [force, torque] = halves(vector);
        Self { force, torque }
    }

    /// Its components.
    #[must_use]
    pub fn to_vector(&self) -> RigidVector {
        joined(&self.force, &self.torque)
    }

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

    /// The component along a motion (N or N m).
    #[must_use]
    pub fn component(&self, mode: Mode) -> f64 {
        if mode.is_rotation() { self.torque[mode.axis()] } else { self.force[mode.axis()] }
    }
}

impl std::ops::Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_go_back_and_forth() {
        let vector = RigidVector::from_fn(|i, _| 1.0 + i as f64);
        assert_eq!(Twist::from_vector(&vector).to_vector(), vector);
        assert_eq!(Wrench::from_vector(&vector).to_vector(), vector);
        for mode in Mode::ALL {
            assert_eq!(Twist::from_vector(&vector).component(mode), vector[mode]);
            assert_eq!(Wrench::from_vector(&vector).component(mode), vector[mode]);
        }
    }
}
