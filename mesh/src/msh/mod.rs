//! Meshes in files of Gmsh, MSH 4.1: read with their named sides, and written.
//!
//! Text and binary, triangles and tetrahedra of order 1 and 2. Physical names of curves (in the
//! plane) or of surfaces (in space) are the sides of the domain.

mod assemble;
mod divide;
mod error;
mod facets;
mod file;
mod input;
mod kind;
mod parts;
mod write;

use crate::Mesh;

pub use assemble::{read_msh, read_undivided_msh};
pub use error::{MshError, Place};
pub use write::{Encoding, write_msh};

/// Reads a mesh of triangles, as [`read_msh`].
///
/// # Errors
/// [`MshError`] with the place and what would be accepted.
pub fn read_planar_msh(bytes: &[u8], scale: f64) -> Result<Mesh<2>, MshError> {
    read_msh(bytes, scale)
}

/// Reads a mesh of tetrahedra, as [`read_msh`].
///
/// # Errors
/// [`MshError`] with the place and what would be accepted.
pub fn read_spatial_msh(bytes: &[u8], scale: f64) -> Result<Mesh<3>, MshError> {
    read_msh(bytes, scale)
}
