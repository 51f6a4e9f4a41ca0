//! Exact solutions, error norms, refinement studies and stored figures, shared by all tests here.

pub mod cases;
pub mod exact;
mod figures;
pub mod given;
mod moved;
mod norms;
mod setup;
mod spheres;
mod stepping;
mod stop;
mod study;
mod swim;
mod tetrahedra;

pub use figures::record;
pub use moved::{Moved, mirror_image};
pub use norms::{Errors, errors};
pub use setup::{fluid_only, rest, sides};
pub use spheres::ChainOfSpheres;
pub use stepping::{Stepping, one_system_from_rest, steady, steady_with, workspace};
pub use stop::{Stopped, resumed, stopped, stopped_again, stopped_within_a_step};
pub use study::Study;
pub use swim::Swim;
pub use tetrahedra::{BoxOfTetrahedra, three_tetrahedra, two_tetrahedra};
