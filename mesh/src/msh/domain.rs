//! `DomainMesh`: a given mesh as the domain of a flow, and what is known of its sides.

use super::assemble::read_msh_with;
use super::error::MshError;
use super::options::{MshOptions, ReadMsh};
use crate::{BoundaryId, Mesh, SideShape};

/// A given mesh and what is known of it.
///
/// Its functions have no number of dimensions that is left to who calls them: they are compiled here, and not
/// where cases are read, without optimisation.
#[derive(Debug, Clone)]
pub struct DomainMesh<const D: usize> {
    /// The mesh (m).
    pub mesh: Mesh<D>,
    /// What each of its boundaries looks like.
    pub sides: Vec<SideShape>,
    /// Its area, in space its volume (m2, m3).
    pub measure: f64,
    /// What was made of a file that its author may not expect, a sentence each.
    pub notes: Vec<String>,
}

impl<const D: usize> DomainMesh<D> {
    fn new(read: ReadMsh<D>) -> Self {
        let ReadMsh { mesh, notes } = read;
        let sides = (0..mesh.boundaries.len()).map(|side| mesh.side_shape(BoundaryId::new(side)));
        Self { sides: sides.collect(), measure: mesh.measure(), mesh, notes }
    }
}

impl DomainMesh<2> {
    /// Reads a file of triangles.
    ///
    /// # Errors
    /// As [`read_msh_with`].
    pub fn read(bytes: &[u8], options: &MshOptions) -> Result<Self, MshError> {
        read_msh_with(bytes, options).map(Self::new)
    }
}

impl DomainMesh<3> {
    /// Reads a file of tetrahedra.
    ///
    /// # Errors
    /// As [`read_msh_with`].
    pub fn read(bytes: &[u8], options: &MshOptions) -> Result<Self, MshError> {
        read_msh_with(bytes, options).map(Self::new)
    }

    /// A mesh that was made.
    #[must_use]
    pub fn of(mesh: Mesh<3>) -> Self {
        Self::new(ReadMsh { mesh, notes: Vec::new() })
    }
}
