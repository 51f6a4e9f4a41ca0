//! `Workspace`: linear system, mesh of the present pass, and timing.

use alewife_mesh::Mesh;

use super::Timing;
use crate::coupling::FluidSystem;

/// What a step works with; nothing in it is read before it is written.
pub struct Workspace<const D: usize> {
    /// The linear system on the mesh.
    pub system: FluidSystem<D>,
    /// The mesh of the present pass, in the laboratory.
    pub mesh: Mesh<D>,
    /// Time spent in each stage.
    pub timing: Timing,
}
