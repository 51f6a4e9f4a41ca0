//! How a swimmer's surface moves by itself: slip along it, or an outline that deforms.

mod closed_curve;
mod deformed;
mod error;
mod grid;
mod midline;
mod momentum;
mod number;
mod pulse;
mod rule;
mod squirmer;
mod swimmer;
#[cfg(test)]
mod tests;
mod turning;

pub use deformed::{Deformed, Removed, ShapeMotion};
pub use error::GaitError;
pub use midline::{Anguilliform, Carangiform, Flagellum, Midline};
pub use pulse::{Pulse, PulseLaw};
pub use squirmer::Squirmer;
pub use swimmer::Swimmer;

use nalgebra::Vector3;

/// The motion of a surface in the frame of its body.
pub trait Gait: std::fmt::Debug + Send + Sync {
    /// Velocity of the surface at a material point, both in the body frame (m, m/s).
    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64>;
}
