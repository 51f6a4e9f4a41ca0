//! Rods in space.

mod common;
mod derivatives;
mod helix;
mod motion;
mod statics;
mod surface;
