//! Outlines and surfaces that follow the coordinates of a body.

mod carried;
mod flexible_shape;
mod flexible_surface;

pub(super) use self::carried::Carried;
pub use self::flexible_shape::FlexibleShape;
pub use self::flexible_surface::FlexibleSurface;
