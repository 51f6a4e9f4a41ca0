//! Shapes given corner by corner or triangle by triangle, also by files.

pub(crate) mod midline;
pub(crate) mod polygon;
pub(crate) mod surface;
