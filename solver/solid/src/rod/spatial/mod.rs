//! Rods in space, their ends and the surface about them.

mod body;
mod ends;
mod frame;
mod loaded_end;
mod spatial_rod;
mod surface;

pub use body::SpatialRodBody;
pub use ends::{SpatialEndLoad, SpatialEndPose};
pub use loaded_end::SpatialLoadedEnd;
pub use spatial_rod::SpatialRod;
pub use surface::{SpatialSectionPoint, SpatialSurfaceRows};
