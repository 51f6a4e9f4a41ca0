//! Elastic and active bodies: their energies, forces and tangents; knows no load of a fluid and no flow.

pub mod structure;
