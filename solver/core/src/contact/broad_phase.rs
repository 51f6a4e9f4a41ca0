//! `BroadPhase`: which bodies may come near each other, by the circles around them.

use alewife_mesh::{Bounds, BoxTree, Point};

/// Part of the lengths at hand by which distances are taken smaller, so that rounding loses no
/// neighbour.
const ROUNDING: f64 = 1e-9;

/// A circle that holds a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    /// Centre (m).
    pub center: Point<2>,
    /// Radius (m).
    pub radius: f64,
}

/// The circles around all bodies, their images across periodic sides included.
#[derive(Debug)]
pub(super) struct BroadPhase {
    /// Circles with their centres within the first period.
    circles: Vec<Circle>,
    /// Vectors from a circle to its images in the neighbouring periods, and zero (m).
    shifts: Vec<Point<2>>,
    tree: BoxTree<2>,
    /// Distance that is taken for rounding (m).
    rounding: f64,
}

impl BroadPhase {
    /// Circles that repeat after periods along x and y, if there are any (m).
    pub fn new(mut circles: Vec<Circle>, periods: [Option<f64>; 2]) -> Self {
        let mut longest = periods.into_iter().flatten().fold(0.0, f64::max);
        for Circle { center, radius } in &mut circles {
            longest = longest.max(center.amax() + *radius);
            for (coordinate, period) in center.iter_mut().zip(periods) {
                if let Some(length) = period {
                    *coordinate -= length * (*coordinate / length).floor();
                }
            }
        }
        let steps =
            periods.map(|period| period.map_or(vec![0.0], |length| vec![-length, 0.0, length]));
        let column = |y: &f64| steps[0].iter().map(|x| Point::<2>::new(*x, *y)).collect::<Vec<_>>();
        let shifts = steps[1].iter().flat_map(column).collect();
        let bounds = |circle: &Circle| {
            let corner = Point::<2>::repeat(circle.radius);
            Bounds { min: circle.center - corner, max: circle.center + corner }
        };
        let boxes: Vec<Bounds<2>> = circles.iter().map(bounds).collect();
        Self { tree: BoxTree::new(&boxes), circles, shifts, rounding: ROUNDING * longest }
    }

    /// Bodies that may have a point, or an image of one, nearer than `distance` (m) to a point of a
    /// body: of those from that body on, which is always one of them, in ascending order.
    pub fn neighbours(&self, body: usize, distance: f64) -> Vec<usize> {
        if distance.is_infinite() {
            return (body..self.circles.len()).collect();
        }
        let Circle { center, radius } = self.circles[body];
        let reach = radius + distance + self.rounding;
        let mut found = vec![body];
        for shift in &self.shifts {
            let image = center + shift;
            self.tree.visit_near(image, reach, |other, _| {
                let Circle { center, radius } = self.circles[other];
                if other > body && (image - center).norm() <= reach + radius {
                    found.push(other);
                }
                false
            });
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [0, 1) without a pattern, by the golden ratio.
    fn scattered(nth: usize) -> f64 {
        (nth as f64 * 0.618_033_988_749).fract()
    }

    #[test]
    fn neighbours_are_those_found_among_all_pairs_of_circles() {
        let circles: Vec<Circle> = (0..300)
            .map(|nth| {
                let (x, y) = (scattered(nth), scattered(7 * nth + 3));
                let radius = if nth % 50 == 0 { 2.0 } else { 0.2 * scattered(3 * nth) };
                Circle { center: Point::<2>::new(30.0 * x - 10.0, 12.0 * y - 4.0), radius }
            })
            .collect();
        for periods in [[None, None], [Some(10.0), None], [Some(10.0), Some(4.0)]] {
            let phase = BroadPhase::new(circles.clone(), periods);
            let gap = |one: &Circle, other: &Circle| {
                let mut between = one.center - other.center;
                for (along, period) in between.iter_mut().zip(periods) {
                    *along -= period.map_or(0.0, |length| length * (*along / length).round());
                }
                between.norm() - one.radius - other.radius
            };
            let mut n_found = 0;
            for (body, circle) in circles.iter().enumerate() {
                let is_near = |other: &usize| *other == body || gap(circle, &circles[*other]) < 0.3;
                let near: Vec<usize> = (body..circles.len()).filter(is_near).collect();
                assert_eq!(phase.neighbours(body, 0.3), near, "{body}, {periods:?}");
                assert_eq!(phase.neighbours(body, f64::INFINITY).len(), circles.len() - body);
                n_found += near.len();
            }
            assert!(n_found > 600, "{n_found}");
        }
    }
}
