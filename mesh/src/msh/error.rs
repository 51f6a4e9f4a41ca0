//! `MshError`: why a file is no mesh that can be used, and where in it.

use std::fmt;

/// Where in a file something is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A line of a text file, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
    Byte(usize),
    /// Nowhere in particular: it is about the mesh as a whole.
    Mesh,
}

/// Why a file is no mesh that can be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MshError {
    /// Where it was found.
    pub place: Place,
    /// What was found.
    pub found: String,
    /// What would be accepted, or how to make it so.
    pub accepted: String,
}

impl MshError {
    /// About the mesh as a whole.
    pub(super) fn of_mesh(found: String, accepted: &str) -> Self {
        Self { place: Place::Mesh, found, accepted: accepted.to_owned() }
    }
}

impl fmt::Display for MshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Place::Line(line) => write!(f, "line {line}: ")?,
            Place::Byte(byte) => write!(f, "byte {byte}: ")?,
            Place::Mesh => {}
        }
        write!(f, "{}; {}", self.found, self.accepted)
    }
}

impl std::error::Error for MshError {}
