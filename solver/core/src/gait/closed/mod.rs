//! What encloses a body that deforms, a curve in the plane or a surface in space, with the exact rates of what is inside.

mod closed_curve;
mod closed_surface;

pub(super) use closed_curve::ClosedCurve;
pub(super) use closed_surface::{ClosedSurface, EnclosedVolume, on_outline};
