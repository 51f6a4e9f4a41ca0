//! What is planar by nature in a run: outlines, the cut of periodic domains, meshes of triangles.

mod case;
mod periodic_cell;
mod resume;
mod scene;
mod shape_motion;
mod sides;
mod start;

pub use case::{build_mesh, mesh_quality, sizing};
pub use shape_motion::{BodyRecoil, recoils, shape_motion};
pub use sides::build_problem;
pub use start::simulation_on;
pub(super) use start::{Prepared, prepare};
