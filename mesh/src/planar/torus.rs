//! `Torus`: a periodic domain that closes on itself.

use super::domain::Domain;
use crate::Point;
use crate::periods::Periods;

/// Part of the shortest period that no cell is larger than: no edge is half a period long then, and no
/// two triangles meet twice.
const LARGEST: f64 = 0.2;

/// A domain each pair of whose periodic sides is one line; without any, the plane.
#[derive(Debug, Clone, Copy, Default)]
pub struct Torus {
    periods: Periods<2>,
    corners: [Point<2>; 2],
}

impl Torus {
    /// That of a domain.
    pub fn new(domain: &Domain) -> Self {
        let lengths = domain.periods().map(|length| length.unwrap_or(0.0));
        Self { periods: Periods::new(lengths.into()), corners: domain.corners() }
    }

    /// The same, closed along one axis at most.
    pub fn along(&self, axis: usize) -> Self {
        let mut lengths = Point::<2>::zeros();
        lengths[axis] = self.periods.along(axis);
        Self { periods: Periods::new(lengths), ..*self }
    }

    /// Whether it closes on itself at all.
    pub fn is_closed(&self) -> bool {
        self.periods.is_any()
    }

    /// Lower left and upper right corner of the domain (m).
    pub fn corners(&self) -> [Point<2>; 2] {
        self.corners
    }

    /// The periods.
    pub fn periods(&self) -> &Periods<2> {
        &self.periods
    }

    /// Whole periods from a point to its image in the domain.
    pub fn steps_inside(&self, point: Point<2>) -> [i32; 2] {
        self.periods.steps(point, self.middle())
    }

    /// The image of a point in the domain (m).
    #[inline]
    pub fn inside(&self, point: Point<2>) -> Point<2> {
        self.periods.beside(point, self.middle())
    }

    /// The image of a point that is next to another one (m).
    #[inline]
    pub fn beside(&self, point: Point<2>, other: Point<2>) -> Point<2> {
        self.periods.beside(point, other)
    }

    /// The largest size of cells that it can be made of (m).
    pub fn largest_size(&self) -> f64 {
        LARGEST * self.periods.shortest()
    }

    fn middle(&self) -> Point<2> {
        (self.corners[0] + self.corners[1]) * 0.5
    }
}
