//! Rods that bend in their plane, their ends and the surface about them.

mod ends;
mod planar_rod;
mod surface;

pub use ends::{EndLoad, EndPose};
pub use planar_rod::PlanarRod;
pub use surface::{RoundedStrip, SectionPoint, SurfaceRows};
