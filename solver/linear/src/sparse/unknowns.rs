//! `Unknowns`: what each unknown of a saddle-point system is.

/// What each unknown of a matrix is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Unknowns {
    /// Mesh node of each unknown; those of one node are ordered together.
    pub node: Vec<u32>,
    /// Whether it is a pressure: its diagonal entry is zero.
    pub is_pressure: Vec<bool>,
    /// Unknowns with dense rows or columns, the rigid velocities of bodies: eliminated last. Their
    /// nodes are not read.
    pub dense: Vec<usize>,
}
