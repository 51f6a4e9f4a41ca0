//! `End`, `Axes` and `Support`: an end of a rod, where its coordinates are, what turns a load there, what is held.

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

/// The axes that the components of a load at an end are along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// Those that places are seen in: the load keeps its directions.
    Fixed,
    /// Those of the section there, with which the load turns: the tangent first.
    OfSection,
}

/// How an end is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// Not at all.
    Free,
    /// Its place is given.
    Hinged,
    /// Its place and its direction are given, of a rod that is [`Rod::clamped`] there.
    Clamped,
}

impl Support {
    /// Number of the coordinates of an end that are given, the first ones, by the dimension of space.
    #[must_use]
    pub const fn n_held(self, dimension: usize) -> usize {
        match (self, dimension) {
            (Self::Free, _) => 0,
            (Self::Hinged, _) => dimension,
            (Self::Clamped, 2) => 4,
            (Self::Clamped, _) => 9,
        }
    }
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

    /// The same rod, clamped at an end: of its tangent there the direction is held, and the length follows from the stretch of
    /// its element. A rod that is closed has no end.
    #[must_use]
    pub fn clamped(mut self, end: End) -> Self {
        self.clamped[end as usize] = !self.is_closed();
        self
    }
}
