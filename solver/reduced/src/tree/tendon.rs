//! `Tendon`: an elastic line through sites on links, which pulls.

use nalgebra::Vector3;

use super::spatial::Number;

/// A point of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site<T: Number> {
    /// Number of the link.
    pub link: usize,
    /// Place in its frame (m).
    pub place: Vector3<T>,
}

/// A line through sites, straight between them: where it is longer than at rest it has the tension
/// stiffness (length - rest) + damping length', and where it is slack none unless it pushes.
#[derive(Debug, Clone, PartialEq)]
pub struct Tendon<T: Number> {
    /// Two sites at least, in order.
    pub sites: Vec<Site<T>>,
    /// Tension per length (N/m).
    pub stiffness: T,
    /// Tension per rate of length (N s/m).
    pub damping: T,
    /// Length at rest (m).
    pub rest: T,
    /// Whether it has that tension, below zero, where it is shorter than at rest.
    pub pushes: bool,
}
