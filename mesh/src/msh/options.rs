//! `MshOptions`: how a file is read; `ReadMsh`: what it holds, and what was made of it on the way.

use crate::Mesh;

/// How a file is read.
#[derive(Debug, Clone, PartialEq)]
pub struct MshOptions {
    /// Factor of its lengths.
    pub scale: f64,
    /// Names of the physical groups that are sides; all of them if empty.
    pub sides: Vec<String>,
}

impl MshOptions {
    /// All groups, with a factor of lengths.
    #[must_use]
    pub fn scaled(scale: f64) -> Self {
        Self { scale, sides: Vec::new() }
    }
}

/// A mesh from a file.
#[derive(Debug, Clone)]
pub struct ReadMsh<const D: usize> {
    /// The mesh.
    pub mesh: Mesh<D>,
    /// What was made of the file that its author may not expect, a sentence each.
    pub notes: Vec<String>,
}
