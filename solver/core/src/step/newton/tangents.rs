//! `Tangents`: for how long derivatives of the equations of coordinates are kept.

/// For how long derivatives of the equations of coordinates are kept, with the factors they are in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tangents {
    /// For one linear system: the fluid changes its own part of the next one.
    OfSystem,
    /// From the first linear system on, which takes new ones.
    OfPass,
    /// From an earlier pass of the same step.
    OfStep,
}

impl Tangents {
    /// Linear systems after which new ones are taken for each.
    const KEPT: usize = 2;

    /// Whether new ones are taken after so many linear systems.
    pub fn are_renewed(self, systems: usize) -> bool {
        match self {
            Self::OfSystem => true,
            Self::OfPass => systems == 0 || systems >= Self::KEPT,
            Self::OfStep => systems >= Self::KEPT,
        }
    }
}
