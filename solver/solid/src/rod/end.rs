//! `End`: an end of a rod, and where its coordinates are.

use super::elastic::Rod;
use super::kinematics::Kinematics;

/// An end of a rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Where distances along it start.
    Base,
    /// The other end.
    Tip,
}

impl<K: Kinematics<N, S>, const N: usize, const S: usize> Rod<K, N, S> {
    /// First of the coordinates of an end: its place, its tangent, and in space the vector across.
    #[must_use]
    pub fn first_coordinate(&self, end: End) -> usize {
        match end {
            End::Base => 0,
            End::Tip => Self::STRIDE * (self.knots().len() - 1),
        }
    }
}
