//! How a swimmer's surface moves by itself: slip along it, or an outline that deforms.

mod closed_curve;
mod deformed_outline;
mod error;
mod grid;
mod midline;
mod momentum;
mod number;
mod pulse;
mod recoil;
mod rule;
mod sheet;
mod slender_body;
mod squirmer;
#[cfg(test)]
mod tests;

pub use deformed_outline::{DeformedOutline, RecoilCorrection, ShapeMotion};
pub use error::GaitError;
pub use midline::{Anguilliform, Carangiform, Flagellum, Midline};
pub use pulse::{Pulse, PulseLaw};
pub use sheet::WavingSheet;
pub use slender_body::SlenderBody;
pub use squirmer::Squirmer;

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
