//! `Workspace`: linear system, mesh of the present configuration, and timing.

use alewife_mesh::Mesh;

use crate::coupling::FluidSystem;
use crate::timing::Timing;

/// What a step works with; nothing in it is read before it is written.
pub struct Workspace<const D: usize> {
    /// The linear system on the mesh.
    pub system: FluidSystem<D>,
    /// The mesh of the present configuration, in the laboratory.
    pub mesh: Mesh<D>,
    /// Time spent in each stage.
    pub timing: Timing,
}
