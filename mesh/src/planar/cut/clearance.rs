//! `Clearance`: how far a point is from the nearest body in a periodic domain.

use crate::box_tree::{Bounds, BoxTree};
use crate::{Outline, Point};

/// Part of its size by which the box around a body is larger, so that rounding leaves none out.
const MARGIN: f64 = 1e-9;

/// Whole periods along x and y, zero along an axis without one.
type Periods = [f64; 2];

/// Bodies, and the periods by which they repeat.
#[derive(Debug)]
pub struct Clearance<'a> {
    pub outlines: &'a [Outline],
    /// Periods (m).
    pub periods: [Option<f64>; 2],
    /// Middle of the box that is repeated (m).
    middle: Point<2>,
    /// The periods from the image of each body in the box to the body.
    away: Vec<Periods>,
    /// The boxes around the images in the box.
    tree: BoxTree<2>,
}

impl<'a> Clearance<'a> {
    /// Bodies that repeat by `periods` (m), the box around `middle` (m).
    pub fn new(outlines: &'a [Outline], periods: [Option<f64>; 2], middle: Point<2>) -> Self {
        let mut made =
            Self { outlines, periods, middle, away: Vec::new(), tree: BoxTree::new(&[]) };
        made.away = outlines.iter().map(|outline| made.periods_to(outline.center())).collect();
        let bounds = outlines.iter().zip(&made.away).map(|(outline, &away)| {
            let center = outline.center() - made.shift(away);
            let size = outline.reach() + made.periods.iter().flatten().sum::<f64>();
            let half = Point::repeat(outline.reach() + MARGIN * size);
            Bounds { min: center - half, max: center + half }
        });
        made.tree = BoxTree::new(&bounds.collect::<Vec<_>>());
        made
    }

    /// The periods from the box to a point.
    fn periods_to(&self, point: Point<2>) -> Periods {
        [0, 1].map(|axis| {
            self.periods[axis]
                .map_or(0.0, |length| ((point[axis] - self.middle[axis]) / length).round())
        })
    }

    fn shift(&self, periods: Periods) -> Point<2> {
        Point::from_fn(|axis, _| periods[axis] * self.periods[axis].unwrap_or(0.0))
    }

    /// Distance from a point to the nearest body or image of one (m), negative inside.
    pub fn at(&self, point: Point<2>) -> f64 {
        self.but(point, None)
    }

    /// The same with the body `but` left out, though not its images.
    pub fn but(&self, point: Point<2>, but: Option<usize>) -> f64 {
        let near = self.periods_to(point);
        let around = |axis: usize| match self.periods[axis] {
            None => [Some(0.0), None, None],
            Some(_) => [near[axis], near[axis] + 1.0, near[axis] - 1.0].map(Some),
        };
        let mut gap = f64::INFINITY;
        for y in around(1).into_iter().flatten() {
            for x in around(0).into_iter().flatten() {
                // A point may be inside a body, its gap negative
                let within = gap.max(0.0);
                self.tree.visit_near(point - self.shift([x, y]), within, |body, within| {
                    let away = self.away[body];
                    let steps = [x - away[0], y - away[1]];
                    let outline = &self.outlines[body];
                    let there = point - self.shift(steps);
                    let is_own = but == Some(body) && steps == [0.0, 0.0];
                    if !is_own && outline.least_gap(there) < gap {
                        gap = gap.min(outline.nearest(there).gap);
                        *within = gap.max(0.0);
                    }
                    false
                });
            }
        }
        gap
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PlacedShape, Shape};

    /// Discs and an ellipse in a box 4 x 3, one of them three periods away.
    fn outlines() -> Vec<Outline> {
        let disc = Shape::Disc { radius: 0.3 };
        let ellipse = Shape::Ellipse { semi_axes: [0.6, 0.2] };
        let placed = [(&disc, 1.0, 1.0), (&ellipse, 3.9, 2.4), (&disc, 14.2, -7.3)];
        let outline = |(shape, x, y): (&Shape, f64, f64)| {
            let (name, center) = (String::new(), Point::<2>::new(x, y));
            Outline::new(&PlacedShape {
                name,
                shape: shape.clone(),
                center,
                angle: 0.7,
                size: None,
            })
            .unwrap()
        };
        placed.map(outline).to_vec()
    }

    #[test]
    fn the_clearance_is_that_of_all_images_one_by_one() {
        let outlines = outlines();
        for periods in [[Some(4.0), Some(3.0)], [Some(4.0), None], [None, Some(3.0)]] {
            let clearance = Clearance::new(&outlines, periods, Point::<2>::new(2.0, 1.5));
            let steps = |axis: usize| if periods[axis].is_some() { -9..=9 } else { 0..=0 };
            let mut n_inside = 0;
            for i in 0..400 {
                let (a, b) = (f64::from(i) * 0.618_034, f64::from(i) * 0.754_878);
                let point = Point::<2>::new(12.0 * a.fract() - 4.0, 9.0 * b.fract() - 3.0);
                for but in [None, Some(0), Some(2)] {
                    let mut least = f64::INFINITY;
                    for (y, x) in steps(1).flat_map(|y| steps(0).map(move |x| (y, x))) {
                        let shift = Point::<2>::new(4.0 * f64::from(x), 3.0 * f64::from(y));
                        for (body, outline) in outlines.iter().enumerate() {
                            if but != Some(body) || (x, y) != (0, 0) {
                                least = least.min(outline.nearest(point - shift).gap);
                            }
                        }
                    }
                    assert_eq!(clearance.but(point, but), least);
                    n_inside += usize::from(least < 0.0);
                }
            }
            assert!(n_inside > 10);
        }
    }
}
