//! The rigid motion that a body's gait leaves out: its angle, and how large it is.

mod angle;
mod motion;
mod open;

pub use angle::RecoilAngle;
pub(super) use motion::Recoil;
pub use motion::RecoilMotion;
pub use open::OpenAngle;
