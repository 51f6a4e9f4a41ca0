//! Exact solutions, error norms and refinement studies shared by the tests of the whole project.

pub mod cases;
pub mod exact;
mod moved;
mod norms;
mod setup;
mod spheres;
mod stepping;
mod stop;
mod study;
mod swim;
mod tetrahedra;

pub use moved::{Moved, mirror_image};
pub use norms::{Errors, errors};
pub use setup::{fluid_only, rest, sides};
pub use spheres::ChainOfSpheres;
pub use stepping::{Stepping, one_system_from_rest, steady, steady_with, workspace};
pub use stop::{Stopped, resumed, stopped, stopped_again, stopped_within_a_step};
pub use study::Study;
pub use swim::Swim;
pub use tetrahedra::{BoxOfTetrahedra, three_tetrahedra, two_tetrahedra};
