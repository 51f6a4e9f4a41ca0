//! Outlines that follow the coordinates of a body.

mod carried_outline;
mod flexible_shape;

pub(super) use self::carried_outline::CarriedOutline;
pub use self::flexible_shape::FlexibleShape;
