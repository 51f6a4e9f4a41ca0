//! Curves in space, along which tubes lie.

mod centreline;
mod spline;

pub use centreline::Centreline;
pub use spline::SpaceSpline;
