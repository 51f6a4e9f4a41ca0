//! Exact solutions, error norms and refinement studies shared by the tests of the whole project.

pub mod cases;
pub mod exact;
mod norms;
mod setup;
mod study;

pub use norms::{Errors, errors};
pub use setup::{fluid_only, rest, sides};
pub use study::Study;
