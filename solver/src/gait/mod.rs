//! How a swimmer's surface moves by itself.

mod squirmer;

pub use squirmer::Squirmer;

use nalgebra::Vector3;

/// The motion of a surface in the frame of its body.
pub trait Gait: std::fmt::Debug + Send + Sync {
    /// Velocity of the surface at a material point, both in the body frame (m, m/s).
    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64>;
}
