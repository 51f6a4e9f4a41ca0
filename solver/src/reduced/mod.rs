//! The reduced model of a case: its bodies and joints as a tree of links, its motion, its quantities.

mod build;
mod error;
mod inertia;
mod measure;
mod play;
mod simulate;
mod swimmer;

pub use error::ReducedError;
pub use play::{Player, Playing, Scratch};
pub use simulate::simulate;
