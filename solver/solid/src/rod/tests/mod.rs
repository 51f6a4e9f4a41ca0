//! Rods against exact solutions, and their derivatives against differences.

mod active;
mod body;
mod clamped;
mod closed;
mod common;
mod derivatives;
mod ends;
mod follower;
mod motion;
mod properties;
mod resistive;
mod space;
mod statics;
mod surface;
