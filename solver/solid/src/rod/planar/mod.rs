//! Rods that bend in their plane, their ends and the surface about them.

mod body;
mod ends;
mod loaded_end;
mod planar_rod;
mod surface;

pub use body::PlanarRodBody;
pub use ends::{EndLoad, EndPose};
pub use loaded_end::LoadedEnd;
pub use planar_rod::PlanarRod;
pub use surface::{RoundedStrip, SectionPoint, SectionRows, SurfaceRows};
