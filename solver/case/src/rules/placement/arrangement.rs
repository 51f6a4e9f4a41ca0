//! `Arrangement`: where bodies are in a domain, in the plane or in space.

use alewife_mesh::MeshError;

/// Distance out of the fluid, over the size of the domain or a body, that is taken for rounding.
pub const ROUNDING: f64 = 1e-6;

/// A body that is where it cannot be.
#[derive(Debug, PartialEq)]
pub struct Misplaced {
    /// The body to move.
    pub body: usize,
    /// Why it cannot be there.
    pub error: MeshError,
}

/// Where bodies are in a domain.
pub trait Arrangement {
    /// Everything that is wrong with where bodies are.
    fn misplaced(&self) -> Vec<Misplaced>;

    /// Whether a point (m) is outside the domain by more than rounding.
    fn is_outside(&self, point: &[f64]) -> bool;

    /// Names of the bodies that a point (m) lies in, by more than rounding.
    fn around(&self, point: &[f64]) -> Vec<&str>;
}
