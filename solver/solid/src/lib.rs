//! Elastic and active bodies: their energies, forces and tangents; knows no load of a fluid and no flow.

pub mod dry;
pub mod rod;
pub mod structure;
