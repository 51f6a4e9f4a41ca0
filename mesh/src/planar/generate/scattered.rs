//! `Scattered`: points all over a part of the plane, between which what is known at them is linear.

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use crate::{Bounds, BoxTree, Point};

/// A point is in a triangle when no part of it is further outside than this, over the size of the triangle.
const ROUNDING: f64 = 1e-12;

/// Points and the triangles between them that Delaunay's rule makes.
#[derive(Debug, Clone)]
pub struct Scattered {
    points: Vec<Point<2>>,
    triangles: Vec<[usize; 3]>,
    /// Edges of the hull of all points.
    hull: Vec<[usize; 2]>,
    tree: BoxTree<2>,
    area: f64,
}

/// What a place has of the points around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Numbers of the points.
    pub points: [usize; 3],
    /// Share of each, together one.
    pub shares: [f64; 3],
    /// How far the place is outside of the hull of all points (m), in which case it has what the nearest point of the
    /// hull has.
    pub outside: f64,
}

struct Numbered {
    at: Point2<f64>,
    number: usize,
}

impl HasPosition for Numbered {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

impl Scattered {
    /// Triangles between points (m); `None` where they are on one line, fewer than three, or one is not finite.
    #[must_use]
    pub fn new(points: Vec<Point<2>>) -> Option<Self> {
        let all = points.iter().enumerate();
        let all = all.map(|(number, at)| Numbered { at: Point2::new(at.x, at.y), number });
        let made = DelaunayTriangulation::<Numbered>::bulk_load_stable(all.collect()).ok()?;
        let number = |face: [spade::handles::VertexHandle<'_, Numbered>; 3]| {
            face.map(|vertex| vertex.data().number)
        };
        let triangles: Vec<[usize; 3]> =
            made.inner_faces().map(|face| number(face.vertices())).collect();
        let hull = made.convex_hull();
        let hull = hull.map(|edge| [edge.from().data().number, edge.to().data().number]).collect();
        if triangles.is_empty() {
            return None;
        }
        let corners = |triangle: &[usize; 3]| triangle.map(|vertex| points[vertex]);
        let boxes: Vec<Bounds<2>> =
            triangles.iter().map(|one| Bounds::around(&corners(one))).collect();
        let area = triangles.iter().map(|one| 0.5 * doubled(&corners(one)).abs()).sum();
        Some(Self { tree: BoxTree::new(&boxes), points, triangles, hull, area })
    }

    /// About how far neighbours are from each other (m).
    #[must_use]
    pub fn spacing(&self) -> f64 {
        (2.0 * self.area / self.triangles.len() as f64).sqrt()
    }

    /// What a place has of the points around it, the same whatever was asked before.
    #[must_use]
    pub fn shares(&self, at: Point<2>) -> Shares {
        let mut found: Option<usize> = None;
        self.tree.visit_near(at, 0.0, |number, _| {
            let first = found.is_none_or(|known| number < known);
            if first && self.within(number, &at).iter().all(|share| *share >= -ROUNDING) {
                found = Some(number);
            }
            false
        });
        match found {
            Some(number) => Shares {
                points: self.triangles[number],
                shares: self.within(number, &at),
                outside: 0.0,
            },
            None => self.on_hull(&at),
        }
    }

    /// Barycentric coordinates of a place.
    fn within(&self, triangle: usize, at: &Point<2>) -> [f64; 3] {
        let [a, b, c] = self.triangles[triangle].map(|vertex| self.points[vertex]);
        let whole = doubled(&[a, b, c]);
        [
            doubled(&[*at, b, c]) / whole,
            doubled(&[a, *at, c]) / whole,
            doubled(&[a, b, *at]) / whole,
        ]
    }

    fn on_hull(&self, at: &Point<2>) -> Shares {
        let nearest = |&[from, to]: &[usize; 2]| {
            let (start, along) = (self.points[from], self.points[to] - self.points[from]);
            let part = ((at - start).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            let outside = (at - start - along * part).norm();
            Shares { points: [from, to, to], shares: [1.0 - part, part, 0.0], outside }
        };
        let all = self.hull.iter().map(nearest);
        let none = Shares { points: [0; 3], shares: [1.0, 0.0, 0.0], outside: f64::INFINITY };
        all.fold(none, |best, one| if one.outside < best.outside { one } else { best })
    }
}

/// Twice the area of a triangle, counter-clockwise positive (m2).
fn doubled([a, b, c]: &[Point<2>; 3]) -> f64 {
    (b - a).perp(&(c - a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> Vec<Point<2>> {
        let angle = |n: u32| 2.4 * f64::from(n);
        let radius = |n: u32| (f64::from(n) / 60.0).sqrt();
        (0..60).map(|n| radius(n) * Point::<2>::new(angle(n).cos(), angle(n).sin())).collect()
    }

    #[test]
    fn what_is_linear_stays_so_and_the_hull_goes_on_outside() {
        let all = points();
        let scattered = Scattered::new(all.clone()).expect("they are all over a disc");
        let linear = |at: &Point<2>| 1.0 + 2.0 * at.x - 3.0 * at.y;
        let value = |found: &Shares| {
            let parts = found.points.iter().zip(found.shares);
            parts.map(|(point, share)| share * linear(&all[*point])).sum::<f64>()
        };
        for at in [[0.0, 0.0], [0.3, -0.2], [-0.5, 0.5], [0.1, 0.7]].map(Point::<2>::from) {
            let found = scattered.shares(at);
            assert!(found.outside == 0.0 && (value(&found) - linear(&at)).abs() < 1e-12);
        }
        for (number, at) in all.iter().enumerate() {
            let found = scattered.shares(*at);
            let parts = found.points.iter().zip(found.shares);
            let own: f64 = parts.filter(|(point, _)| **point == number).map(|(_, s)| s).sum();
            assert!((own - 1.0).abs() < 1e-9 && found.outside < 1e-12, "{number}: {found:?}");
        }
        let outside = scattered.shares(Point::<2>::new(3.0, 0.0));
        assert!((outside.outside - 2.0).abs() < 0.1, "{outside:?}");
        assert!((scattered.spacing() - 0.23).abs() < 0.05, "{}", scattered.spacing());
    }

    #[test]
    fn points_on_a_line_have_no_triangles() {
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]].map(Point::<2>::from).to_vec();
        assert!(Scattered::new(line).is_none());
        assert!(Scattered::new(vec![Point::<2>::new(f64::NAN, 0.0); 3]).is_none());
        assert!(Scattered::new(Vec::new()).is_none());
    }
}
