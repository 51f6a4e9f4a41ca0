//! Shapes given corner by corner, triangle by triangle or by a mesh, also by files.

pub(crate) mod hole;
pub(crate) mod midline;
pub(crate) mod polygon;
pub(crate) mod surface;
