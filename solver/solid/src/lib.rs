//! Elastic and active bodies: their energies, forces and tangents; knows no load of a fluid and no flow.

pub mod dry;
pub mod material;
pub mod rod;
pub mod solid;
pub mod structure;
