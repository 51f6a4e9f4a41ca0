//! `BallTree`: which balls, of the plane discs, may meet, by the boxes around them.

use alewife_mesh::{Bounds, BoxTree, Point};

/// Part of a radius by which balls are taken larger, so that rounding loses none.
const ROUNDING: f64 = 1e-9;

/// Balls that may wait outside of the tree, and part of those in it that may.
const WAITING: [usize; 2] = [16, 8];

/// A disc of the plane, or a ball.
#[derive(Debug, Clone, Copy)]
pub struct Ball<const D: usize> {
    /// Centre (m).
    pub center: Point<D>,
    /// Radius (m).
    pub radius: f64,
}

impl<const D: usize> Ball<D> {
    /// The box around it.
    fn bounds(&self) -> Bounds<D> {
        let half = Point::repeat(self.radius * (1.0 + ROUNDING));
        Bounds { min: self.center - half, max: self.center + half }
    }
}

/// Numbered balls; the latest wait until the tree is made again.
pub struct BallTree<const D: usize> {
    boxes: Vec<Bounds<D>>,
    numbers: Vec<usize>,
    tree: BoxTree<D>,
    n_in_tree: usize,
}

impl<const D: usize> BallTree<D> {
    /// No balls.
    pub fn empty() -> Self {
        let tree = BoxTree::new(&[]);
        Self { boxes: Vec::new(), numbers: Vec::new(), tree, n_in_tree: 0 }
    }

    /// Adds a ball.
    pub fn insert(&mut self, number: usize, ball: &Ball<D>) {
        self.boxes.push(ball.bounds());
        self.numbers.push(number);
        let [least, part] = WAITING;
        if self.boxes.len() - self.n_in_tree > least + self.n_in_tree / part {
            self.tree = BoxTree::new(&self.boxes);
            self.n_in_tree = self.boxes.len();
        }
    }

    /// All balls that may meet a ball, and others near it.
    pub fn near(&self, ball: &Ball<D>) -> impl Iterator<Item = usize> + use<'_, D> {
        let reach = ball.radius * (1.0 + ROUNDING);
        let mut found = Vec::new();
        self.tree.visit_near(ball.center, reach, |index, _| {
            found.push(index);
            false
        });
        let waiting = self.n_in_tree..self.boxes.len();
        let is_near =
            |index: &usize| self.boxes[*index].squared_distance(&ball.center) <= reach * reach;
        found.extend(waiting.filter(is_near));
        found.into_iter().map(|index| self.numbers[index])
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
    fn no_disc_that_meets_another_is_missed() {
        let discs: Vec<Ball<2>> = (0..300)
            .map(|nth| {
                let (x, y) = (scattered(nth), scattered(7 * nth + 3));
                // Some outside most others, and a few that are large
                let radius = if nth % 50 == 0 { 3.0 } else { 0.2 * scattered(3 * nth) };
                Ball { center: Point::<2>::new(12.0 * x - 1.0, 6.0 * y - 1.0), radius }
            })
            .collect();
        let mut tree = BallTree::empty();
        for (nth, disc) in discs.iter().enumerate() {
            tree.insert(nth, disc);
        }
        let mut looked_at = 0;
        for one in &discs {
            let near: Vec<usize> = tree.near(one).collect();
            looked_at += near.len();
            for (nth, other) in discs.iter().enumerate() {
                let meet = (one.center - other.center).norm() <= one.radius + other.radius;
                assert!(!meet || near.contains(&nth), "{one:?} {other:?}");
            }
        }
        assert!(looked_at < discs.len() * discs.len() / 3, "{looked_at} of all pairs");
    }

    #[test]
    fn no_ball_of_space_that_meets_another_is_missed() {
        let ball = |nth: usize| {
            let at = |factor: usize| 4.0 * scattered(factor * nth + factor);
            Ball { center: Point::<3>::new(at(1), at(7), at(13)), radius: 0.5 * scattered(3 * nth) }
        };
        let balls: Vec<Ball<3>> = (0..200).map(ball).collect();
        let mut tree = BallTree::empty();
        for (nth, ball) in balls.iter().enumerate() {
            tree.insert(nth, ball);
        }
        for one in &balls {
            let near: Vec<usize> = tree.near(one).collect();
            for (nth, other) in balls.iter().enumerate() {
                let meet = (one.center - other.center).norm() <= one.radius + other.radius;
                assert!(!meet || near.contains(&nth), "{one:?} {other:?}");
            }
        }
    }
}
