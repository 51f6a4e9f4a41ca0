//! Rods in space.

pub mod common;
mod derivatives;
mod helix;
mod moments;
mod motion;
mod statics;
mod surface;
