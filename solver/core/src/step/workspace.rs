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

impl<const D: usize> Workspace<D> {
    /// With nothing booked yet.
    #[must_use]
    pub fn new(system: FluidSystem<D>, mesh: Mesh<D>) -> Self {
        Self { system, mesh, timing: Timing::default() }
    }
}
