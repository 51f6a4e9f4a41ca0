//! `Clearance`: how far a point is from the nearest body in a periodic domain.

use crate::{Outline, Point};

/// All images of a body but the nearest are half a period away or more, to rounding.
const FAR: f64 = 0.499_999;

/// Bodies and the periods by which they repeat (m).
#[derive(Debug, Clone, Copy)]
pub struct Clearance<'a> {
    pub outlines: &'a [Outline],
    pub periods: [Option<f64>; 2],
}

impl Clearance<'_> {
    /// Distance from a point to the nearest body or image of one (m), negative inside.
    pub fn at(&self, point: Point<2>) -> f64 {
        self.but(point, None)
    }

    /// The same with the body `but` left out, though not its images: `but` is taken as it stands
    /// nearest to the point.
    pub fn but(&self, point: Point<2>, but: Option<usize>) -> f64 {
        let mut gap = f64::INFINITY;
        for (body, outline) in self.outlines.iter().enumerate() {
            let off = point - outline.center();
            let steps = |axis: usize| match self.periods[axis] {
                None => [Some(0.0), None, None],
                Some(length) => {
                    let near = (off[axis] / length).round();
                    [near, near + 1.0, near - 1.0].map(|k| Some(k * length))
                }
            };
            let is_far = |axis: usize, nth: usize, gap: f64| {
                let half = self.periods[axis].map_or(0.0, |length| FAR * length);
                nth > 0 && gap + outline.reach() < half
            };
            for (j, y) in steps(1).into_iter().flatten().enumerate() {
                for (i, x) in steps(0).into_iter().flatten().enumerate() {
                    if is_far(0, i, gap) || is_far(1, j, gap) {
                        continue;
                    }
                    let there = point - Point::<2>::new(x, y);
                    let is_own = but == Some(body) && x == 0.0 && y == 0.0;
                    if !is_own && outline.least_gap(there) < gap {
                        gap = gap.min(outline.nearest(there).gap);
                    }
                }
            }
        }
        gap
    }
}
