//! Cells that keep their volume: quadratic places with linear pressures, and Newton's method for both.

pub(super) mod pressures;
pub(super) mod saddle;
