//! `Gait`: the velocity of a surface in the frame of its body.

use std::fmt;

use nalgebra::Vector3;

/// A number in time (s), such as a factor (1) or an angle (rad).
pub struct InTime(pub Box<dyn Fn(f64) -> f64 + Send + Sync>);

impl fmt::Debug for InTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("InTime")
    }
}

/// The motion of a surface in the frame of its body.
pub trait Gait: std::fmt::Debug + Send + Sync {
    /// Velocity of the surface at a material point, both in the body frame (m, m/s).
    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64>;
}

/// A gait about a point of the body frame that is not the centre of mass.
#[derive(Debug)]
pub struct GaitAbout<G> {
    /// The gait.
    pub gait: G,
    /// The point (m).
    pub center: Vector3<f64>,
}

impl<G: Gait> Gait for GaitAbout<G> {
    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        self.gait.velocity(&(point - self.center), time)
    }
}
