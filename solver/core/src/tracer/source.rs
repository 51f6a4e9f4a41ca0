//! `Source`: where and when particles are released, and where they are counted.

use alewife_mesh::Point;

/// Part of a step by which a release may be later than its end and still belong to it.
const NEAR: f64 = 1e-9;

/// A box in which particles are counted (m), in the laboratory.
#[derive(Debug, Clone, PartialEq)]
pub struct Region<const D: usize> {
    /// Corner with the least coordinates.
    pub min: Point<D>,
    /// Corner with the largest coordinates.
    pub max: Point<D>,
}

impl<const D: usize> Region<D> {
    /// Whether a point (m) is in it.
    #[must_use]
    pub fn holds(&self, point: &Point<D>) -> bool {
        (0..D).all(|axis| (self.min[axis]..=self.max[axis]).contains(&point[axis]))
    }
}

/// Where and when particles are released.
#[derive(Debug, Clone, PartialEq)]
pub struct Source<const D: usize> {
    /// Name in the case.
    pub name: String,
    /// Where they begin (m), in the laboratory.
    pub seeds: Vec<Point<D>>,
    /// When first (s).
    pub start: f64,
    /// Time after which they are released again (s), if ever.
    pub every: Option<f64>,
    /// Where they are counted.
    pub region: Option<Region<D>>,
}

impl<const D: usize> Source<D> {
    /// The time (s) of the next release after a number of them, if it comes until a time (s) at the end of a step (s).
    #[must_use]
    pub fn next_release(&self, releases: u64, until: f64, step: f64) -> Option<f64> {
        let time = match (releases, self.every) {
            (0, _) => self.start,
            (n, Some(every)) => self.start + n as f64 * every,
            (_, None) => return None,
        };
        (time <= until + NEAR * step).then_some(time)
    }
}
