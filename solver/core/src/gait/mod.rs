//! How a swimmer's surface moves by itself: slip along it, or an outline that deforms.

mod closed;
mod deformed_outline;
mod error;
mod flexible;
mod following;
mod grid;
mod hull;
mod midline;
mod momentum;
mod number;
mod pulse;
mod recoil;
mod sheet;
mod slender_body;
mod slip;
mod squirmer;
mod surface_motion;
#[cfg(test)]
mod tests;

pub use deformed_outline::{DeformedOutline, MaterialPoint, RecoilCorrection, ShapeMotion};
pub use error::GaitError;
pub use flexible::{FlexibleShape, FlexibleSurface};
pub use midline::{
    AngleInTime, Anguilliform, Carangiform, Flagellum, Joint, Joints, Midline, Open, Own,
};
pub use pulse::{Pulse, PulseLaw};
pub use recoil::RecoilMotion;
pub use sheet::WavingSheet;
pub use slender_body::SlenderBody;
pub use slip::{Slip, SlipSurface};
pub use squirmer::Squirmer;
pub use surface_motion::{Gait, GaitAbout, InTime};
