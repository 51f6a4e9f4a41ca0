//! How a swimmer's surface moves by itself: slip along it, or an outline that deforms.

mod closed_curve;
mod closed_surface;
mod deformed_outline;
mod error;
mod grid;
mod hull;
mod midline;
mod momentum;
#[cfg(test)]
mod momentum_tests;
mod number;
mod pulse;
mod recoil;
mod recoil_motion;
mod sheet;
mod slender_body;
#[cfg(test)]
mod space_tests;
mod squirmer;
mod surface_motion;
#[cfg(test)]
mod tests;

pub use deformed_outline::{DeformedOutline, MaterialPoint, RecoilCorrection, ShapeMotion};
pub use error::GaitError;
pub use midline::{AngleInTime, Anguilliform, Carangiform, Flagellum, Joint, Joints, Midline};
pub use pulse::{Pulse, PulseLaw};
pub use recoil_motion::RecoilMotion;
pub use sheet::WavingSheet;
pub use slender_body::SlenderBody;
pub use squirmer::Squirmer;
pub use surface_motion::{Gait, InTime};
