//! What is planar by nature in a run: outlines, the cut of periodic domains, meshes of triangles.

mod case;
mod periodic_cell;
mod scene;
mod shape_motion;

pub(super) use case::{InitialMesh, PlanarCase, initial_mesh};
pub use case::{build_mesh, sizing};
pub(super) use scene::PlanarScene;
pub use shape_motion::shape_motion;
