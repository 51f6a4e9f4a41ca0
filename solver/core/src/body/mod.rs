//! What moves as one piece; always in 3D, a 2D run frees x, y and the turn about z.

mod pose;
mod twist;

pub use pose::Pose;
pub use twist::{Twist, Wrench};
