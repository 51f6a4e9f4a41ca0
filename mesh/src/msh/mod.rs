//! Meshes in files of Gmsh: MSH 2.2, 4.0 and 4.1 read with their named sides, 4.1 written.
//!
//! Text and binary, triangles and tetrahedra of order 1 to 3. Physical names of curves (in the
//! plane) or of surfaces (in space) are the sides of the domain.

mod assemble;
mod divide;
mod domain;
mod error;
mod facets;
mod file;
mod input;
mod kind;
mod older;
mod options;
mod parts;
mod pieces;
mod plane;
mod write;

pub use assemble::{read_msh, read_msh_with, read_undivided_msh};
pub use domain::DomainMesh;
pub use error::{MshError, Place};
pub use options::{MshOptions, ReadMsh};
pub use write::{Encoding, write_msh};
