//! `Pose`: centre of mass and rotation; to and from the body frame.

use nalgebra::{UnitQuaternion, Vector3};

/// Where a body is and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Centre of mass, in the world (m).
    pub center: Vector3<f64>,
    /// Rotation from the body frame to the world.
    pub rotation: UnitQuaternion<f64>,
}

impl Pose {
    /// A pose in the plane: the centre's z is zero and the body is turned about z.
    #[must_use]
    pub fn planar(x: f64, y: f64, angle: f64) -> Self {
        Self {
            center: Vector3::new(x, y, 0.0),
            rotation: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle),
        }
    }

    /// Angle of the rotation about z (rad), within (-pi, pi].
    #[must_use]
    pub fn angle(&self) -> f64 {
        let ahead = self.rotation * Vector3::x();
        ahead.y.atan2(ahead.x)
    }
}
