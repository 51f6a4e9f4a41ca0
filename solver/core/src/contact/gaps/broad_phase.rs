//! `BroadPhase`: which bodies may come near each other, by the balls around them.

use alewife_mesh::{Bounds, BoxTree, Point};

/// Part of the lengths at hand by which distances are taken smaller, so that rounding loses no
/// neighbour.
const ROUNDING: f64 = 1e-9;

/// A ball that holds a body, in the plane a circle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball<const D: usize> {
    /// Centre (m).
    pub center: Point<D>,
    /// Radius (m).
    pub radius: f64,
}

/// The balls around all bodies, their images across periodic sides included.
#[derive(Debug)]
pub(super) struct BroadPhase<const D: usize> {
    /// Balls with their centres within the first period.
    balls: Vec<Ball<D>>,
    /// Vectors from a ball to its images in the neighbouring periods, and zero (m).
    shifts: Vec<Point<D>>,
    tree: BoxTree<D>,
    /// Distance that is taken for rounding (m).
    rounding: f64,
}

impl<const D: usize> BroadPhase<D> {
    /// Balls that repeat after periods along the coordinates, if there are any (m).
    pub fn new(mut balls: Vec<Ball<D>>, periods: [Option<f64>; D]) -> Self {
        let mut longest = periods.into_iter().flatten().fold(0.0, f64::max);
        for Ball { center, radius } in &mut balls {
            longest = longest.max(center.amax() + *radius);
            for (coordinate, period) in center.iter_mut().zip(periods) {
                if let Some(length) = period {
                    *coordinate -= length * (*coordinate / length).floor();
                }
            }
        }
        let steps =
            periods.map(|period| period.map_or(vec![0.0], |length| vec![-length, 0.0, length]));
        let shifts = combinations(&steps);
        let bounds = |ball: &Ball<D>| {
            let corner = Point::<D>::repeat(ball.radius);
            Bounds { min: ball.center - corner, max: ball.center + corner }
        };
        let boxes: Vec<Bounds<D>> = balls.iter().map(bounds).collect();
        Self { tree: BoxTree::new(&boxes), balls, shifts, rounding: ROUNDING * longest }
    }

    /// Bodies that may have a point, or an image of one, nearer than `distance` (m) to a point of a
    /// body: of those from that body on, which is always one of them, in ascending order.
    pub fn neighbours(&self, body: usize, distance: f64) -> Vec<usize> {
        if distance.is_infinite() {
            return (body..self.balls.len()).collect();
        }
        let Ball { center, radius } = self.balls[body];
        let reach = radius + distance + self.rounding;
        let mut found = vec![body];
        for shift in &self.shifts {
            let image = center + shift;
            self.tree.visit_near(image, reach, |other, _| {
                let Ball { center, radius } = self.balls[other];
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

/// The vectors with one of these coordinates along each axis, the first axis running fastest.
pub(super) fn combinations<const D: usize>(coordinates: &[Vec<f64>; D]) -> Vec<Point<D>> {
    let mut all = vec![Point::<D>::zeros()];
    for (axis, along) in coordinates.iter().enumerate() {
        let step = |x: &f64| {
            let x = *x;
            let moved = all.iter().map(move |known| {
                let mut vector = *known;
                vector[axis] = x;
                vector
            });
            moved.collect::<Vec<_>>()
        };
        all = along.iter().flat_map(step).collect();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [0, 1) without a pattern, by the golden ratio.
    fn scattered(nth: usize) -> f64 {
        (nth as f64 * 0.618_033_988_749).fract()
    }

    #[test]
    fn neighbours_are_those_found_among_all_pairs_of_balls() {
        let balls: Vec<Ball<2>> = (0..300)
            .map(|nth| {
                let (x, y) = (scattered(nth), scattered(7 * nth + 3));
                let radius = if nth % 50 == 0 { 2.0 } else { 0.2 * scattered(3 * nth) };
                Ball { center: Point::<2>::new(30.0 * x - 10.0, 12.0 * y - 4.0), radius }
            })
            .collect();
        for periods in [[None, None], [Some(10.0), None], [Some(10.0), Some(4.0)]] {
            let phase = BroadPhase::new(balls.clone(), periods);
            let gap = |one: &Ball<2>, other: &Ball<2>| {
                let mut between = one.center - other.center;
                for (along, period) in between.iter_mut().zip(periods) {
                    *along -= period.map_or(0.0, |length| length * (*along / length).round());
                }
                between.norm() - one.radius - other.radius
            };
            let mut n_found = 0;
            for (body, ball) in balls.iter().enumerate() {
                let is_near = |other: &usize| *other == body || gap(ball, &balls[*other]) < 0.3;
                let near: Vec<usize> = (body..balls.len()).filter(is_near).collect();
                assert_eq!(phase.neighbours(body, 0.3), near, "{body}, {periods:?}");
                assert_eq!(phase.neighbours(body, f64::INFINITY).len(), balls.len() - body);
                n_found += near.len();
            }
            assert!(n_found > 600, "{n_found}");
        }
    }
}
