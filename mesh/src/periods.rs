//! `Periods`: the lengths by which space repeats.

use crate::Point;

/// Lengths by which space repeats along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Periods<const D: usize> {
    /// The lengths (m), zero along axes without.
    lengths: Point<D>,
    /// One over each, zero along axes without (1/m).
    inverse: Point<D>,
    is_any: bool,
}

impl<const D: usize> Default for Periods<D> {
    fn default() -> Self {
        Self::new(Point::<D>::zeros())
    }
}

impl<const D: usize> Periods<D> {
    /// Space that repeats by lengths (m), zero along axes without.
    #[must_use]
    pub fn new(lengths: Point<D>) -> Self {
        let inverse = lengths.map(|length| if length > 0.0 { 1.0 / length } else { 0.0 });
        Self { lengths, inverse, is_any: lengths.amax() > 0.0 }
    }

    /// Whether space repeats at all.
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.is_any
    }

    /// The length by which space repeats along an axis (m), zero where it does not.
    #[must_use]
    pub fn along(&self, axis: usize) -> f64 {
        self.lengths[axis]
    }

    /// The shortest of them (m), infinite where there is none.
    #[must_use]
    pub fn shortest(&self) -> f64 {
        let lengths = self.lengths.iter().copied().filter(|length| *length > 0.0);
        lengths.fold(f64::INFINITY, f64::min)
    }

    /// Whole periods from a point to the image of another one that is next to it.
    #[inline]
    #[must_use]
    pub fn steps(&self, point: Point<D>, beside: Point<D>) -> [i32; D] {
        #[expect(clippy::cast_possible_truncation, reason = "a few periods at most")]
        std::array::from_fn(|axis| {
            let periods = (beside[axis] - point[axis]) * self.inverse[axis];
            // A call of a function is saved where it is next to it already, as most are
            if periods.abs() < 0.5 { 0 } else { periods.round() as i32 }
        })
    }

    /// A number of whole periods along each axis (m).
    #[inline]
    #[must_use]
    pub fn shift(&self, steps: [i32; D]) -> Point<D> {
        Point::<D>::from_fn(|axis, _| f64::from(steps[axis]) * self.lengths[axis])
    }

    /// The image of a point that is next to another one (m).
    #[inline]
    #[must_use]
    pub fn beside(&self, point: Point<D>, beside: Point<D>) -> Point<D> {
        if !self.is_any {
            return point;
        }
        let steps = self.steps(point, beside);
        if steps == [0; D] { point } else { point + self.shift(steps) }
    }

    /// The shifts by whole periods to a point itself and to its images around it (m), itself first.
    #[must_use]
    pub fn shifts(&self) -> Vec<Point<D>> {
        let mut all = vec![Point::<D>::zeros()];
        for axis in (0..D).filter(|axis| self.lengths[*axis] > 0.0) {
            for at in 0..all.len() {
                for sign in [-1.0, 1.0] {
                    let mut shift = all[at];
                    shift[axis] += sign * self.lengths[axis];
                    all.push(shift);
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_has_neighbours_along_its_periods() {
        assert_eq!(Periods::<3>::default().shifts().len(), 1);
        let periods = Periods::new(Point::<3>::new(2.0, 0.0, 3.0));
        let all = periods.shifts();
        assert_eq!((all.len(), all[0]), (9, Point::<3>::zeros()));
        assert!(all.contains(&Point::<3>::new(-2.0, 0.0, 3.0)));
    }

    #[test]
    fn an_image_is_beside_a_point() {
        let periods = Periods::new(Point::<3>::new(2.0, 0.0, 3.0));
        let (point, beside) = (Point::<3>::new(0.1, 5.0, 2.9), Point::<3>::new(7.8, -4.0, 0.2));
        let image = periods.beside(point, beside);
        assert!((image - Point::<3>::new(8.1, 5.0, -0.1)).norm() < 1e-14);
        assert_eq!(periods.steps(point, beside), [4, 0, -1]);
        assert_eq!(Periods::default().beside(point, beside), point);
    }
}
