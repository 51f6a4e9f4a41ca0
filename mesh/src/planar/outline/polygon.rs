//! `Polygon`: an outline of straight sides with sharp corners, or corners that are blunt by a hair.

use super::closed_spline::crossing;
use super::foot::Foot;
use crate::planar::vector::cross;
use crate::{MeshError, Point};

/// Part of the shorter of two sides that the bend of a blunt corner takes.
const BLUNT: f64 = 1e-3;

/// Sine of the angle between neighbouring sides below which one runs back along the other.
const FOLDED: f64 = 1e-9;

/// A corner of a polygon in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Where it is (m).
    pub at: Point<2>,
    /// Directions of travel before and behind it.
    pub sides: [Point<2>; 2],
    /// Parameter of [`crate::Outline::at`]: the length along the sides up to it (m).
    pub parameter: f64,
    /// Length of the shorter of both sides (m).
    pub shorter: f64,
}

/// A place on a polygon.
#[derive(Debug, Clone, Copy)]
struct Place {
    side: usize,
    /// How far along the side, from 0 to 1.
    part: f64,
}

impl Corner {
    /// Angle by which the outline turns to the left there (rad); negative where the body is hollow.
    pub fn turn(&self) -> f64 {
        let [before, behind] = self.sides;
        cross(before, behind).atan2(before.dot(&behind))
    }
}

/// A counter-clockwise polygon that does not cross itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// Corners in the frame of the body (m).
    corners: Vec<Point<2>>,
    /// Lengths along the sides up to each corner, and of all sides (m).
    knots: Vec<f64>,
    /// Length of the sides that the bend of each corner takes on either side of it (m); none where sharp.
    bends: Vec<f64>,
}

impl Polygon {
    /// The polygon with these corners.
    ///
    /// # Errors
    /// [`MeshError::Body`] where they are too few, not finite, repeated or clockwise,
    /// [`MeshError::SelfIntersection`] where sides cross or run back along each other.
    pub fn new(points: &[[f64; 2]], name: &str) -> Result<Self, MeshError> {
        let refuse =
            |what, value, wanted| MeshError::Body { body: name.to_owned(), what, value, wanted };
        let n = points.len();
        if n < 3 || points.iter().flatten().any(|x| !x.is_finite()) {
            return Err(refuse("number of points", n as f64, "three or more, all finite"));
        }
        let corners: Vec<Point<2>> = points.iter().map(|point| Point::from(*point)).collect();
        let mut knots = vec![0.0];
        for i in 0..n {
            let length = (corners[(i + 1) % n] - corners[i]).norm();
            if length <= 0.0 {
                let wanted = "different from the point before it";
                return Err(refuse("point", (i + 1) as f64, wanted));
            }
            knots.push(knots[i] + length);
        }
        let area: f64 = (0..n).map(|i| 0.5 * cross(corners[i], corners[(i + 1) % n])).sum();
        let polygon = Self { corners, knots, bends: vec![0.0; n] };
        let folded = polygon.corners().find(|corner| {
            let [before, behind] = corner.sides;
            before.dot(&behind) < 0.0 && cross(before, behind).abs() < FOLDED
        });
        if let Some(at) = folded.map(|corner| corner.at).or_else(|| crossing(&polygon.corners)) {
            return Err(MeshError::SelfIntersection { body: name.to_owned(), x: at.x, y: at.y });
        }
        if area <= 0.0 {
            let wanted = "positive: list its points counter-clockwise";
            return Err(refuse("enclosed area of the polygon", area, wanted));
        }
        Ok(polygon)
    }

    /// The same with a bend in the place of each corner, within the polygon, so that its tangent turns
    /// continuously.
    pub fn blunted(&self) -> Self {
        let bends = self.corners().map(|corner| BLUNT * corner.shorter).collect();
        Self { bends, ..self.clone() }
    }

    /// Number of its sides.
    pub fn n_sides(&self) -> usize {
        self.corners.len()
    }

    /// Length of all sides (m).
    pub fn perimeter(&self) -> f64 {
        self.knots[self.corners.len()]
    }

    /// No point of it is farther from the origin (m).
    pub fn reach(&self) -> f64 {
        self.corners.iter().map(Point::<2>::norm).fold(0.0, f64::max)
    }

    /// Its corners, in the frame of the body.
    pub fn corners(&self) -> impl Iterator<Item = Corner> + '_ {
        let n = self.corners.len();
        (0..n).map(move |i| Corner {
            at: self.corners[i],
            sides: [self.along((i + n - 1) % n), self.along(i)],
            parameter: self.knots[i],
            shorter: self.length(i).min(self.length((i + n - 1) % n)),
        })
    }

    /// Length of a side (m).
    fn length(&self, side: usize) -> f64 {
        self.knots[side + 1] - self.knots[side]
    }

    /// Direction of a side.
    fn along(&self, side: usize) -> Point<2> {
        let [from, to] = self.ends(side);
        (to - from).normalize()
    }

    fn ends(&self, side: usize) -> [Point<2>; 2] {
        [self.corners[side], self.corners[(side + 1) % self.corners.len()]]
    }

    /// Point (m), first and second derivative at a parameter in [0, 1] of a side.
    pub fn evaluate(&self, side: usize, parameter: f64) -> [Point<2>; 3] {
        let [from, to] = self.ends(side);
        let point = if parameter >= 1.0 { to } else { from + (to - from) * parameter };
        [point, to - from, Point::<2>::zeros()]
    }

    /// Point (m), first and second derivative at a length along the sides (m), modulo the perimeter.
    pub fn at(&self, parameter: f64) -> [Point<2>; 3] {
        let n = self.corners.len();
        let s = parameter.rem_euclid(self.perimeter());
        let side = self.knots.partition_point(|knot| *knot <= s).clamp(1, n) - 1;
        let next = (side + 1) % n;
        let before_next = s - self.knots[side + 1];
        if s - self.knots[side] < self.bends[side] {
            self.on_bend(side, s - self.knots[side])
        } else if -before_next < self.bends[next] {
            self.on_bend(next, before_next)
        } else {
            let along = self.along(side);
            [self.corners[side] + along * (s - self.knots[side]), along, Point::<2>::zeros()]
        }
    }

    /// The bend at a corner at a length from it: the parabola that touches both sides.
    fn on_bend(&self, corner: usize, from: f64) -> [Point<2>; 3] {
        let n = self.corners.len();
        let (before, behind) = (self.along((corner + n - 1) % n), self.along(corner));
        let (turn, bend) = (behind - before, self.bends[corner]);
        let part = (from + bend) / (2.0 * bend);
        let point = self.corners[corner] + before * from + turn * (part * part * bend);
        [point, before + turn * part, turn / (2.0 * bend)]
    }

    /// Parameters between which it has three continuous derivatives, from zero to the perimeter.
    pub fn breaks(&self) -> Vec<f64> {
        let n = self.corners.len();
        let mut breaks = Vec::with_capacity(3 * n);
        for (i, knot) in self.knots.iter().enumerate() {
            let bend = self.bends[i % n];
            if i > 0 && bend > 0.0 {
                breaks.push(knot - bend);
            }
            if i == 0 || i == n || bend == 0.0 {
                breaks.push(*knot);
            }
            if i < n && bend > 0.0 {
                breaks.push(knot + bend);
            }
        }
        breaks
    }

    /// The place of the sharp polygon that is nearest to a point.
    fn nearest_place(&self, point: Point<2>) -> Place {
        let (mut least, mut nearest) = (f64::INFINITY, Place { side: 0, part: 0.0 });
        for side in 0..self.corners.len() {
            let [from, to] = self.ends(side);
            let along = to - from;
            let part = ((point - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            let distance = (from + along * part - point).norm_squared();
            if distance < least {
                (least, nearest) = (distance, Place { side, part });
            }
        }
        nearest
    }

    /// Length along the sides to the place nearest to a point (m).
    pub fn parameter_of(&self, point: Point<2>) -> f64 {
        let Place { side, part } = self.nearest_place(point);
        self.knots[side] + part * self.length(side)
    }

    /// The place of the sharp polygon that is nearest to a point.
    pub fn nearest(&self, point: Point<2>) -> Foot {
        let n = self.corners.len();
        let Place { side, part } = self.nearest_place(point);
        let [at, along, _] = self.evaluate(side, part);
        let outward = |along: Point<2>| Point::<2>::new(along.y, -along.x).normalize();
        let mut normal = outward(along);
        if part <= 0.0 || part >= 1.0 {
            // At a corner both sides say on which side of the outline the point is
            let other = if part <= 0.0 { (side + n - 1) % n } else { (side + 1) % n };
            let mean = normal + outward(self.along(other));
            let way = point - at;
            let side = if way.dot(&mean) < 0.0 { -1.0 } else { 1.0 };
            let towards = way.try_normalize(0.0).map(|way| way * side);
            normal = towards.unwrap_or_else(|| mean.normalize());
        }
        Foot { point: at, normal, curvature: 0.0 }
    }

    /// Distance between sides that face each other across the body, or four areas over the perimeter
    /// where that is less (m).
    pub fn thickness(&self) -> f64 {
        let n = self.corners.len();
        let area: f64 =
            (0..n).map(|i| 0.5 * cross(self.corners[i], self.corners[(i + 1) % n])).sum();
        let mut thinnest = 4.0 * area / self.perimeter();
        for one in 0..n {
            for other in one + 2..n {
                let are_neighbours = one == 0 && other == n - 1;
                if are_neighbours || self.along(one).dot(&self.along(other)) > -0.5 {
                    continue;
                }
                for (corner, side) in
                    [(one, other), (one + 1, other), (other, one), (other + 1, one)]
                {
                    let [from, to] = self.ends(side);
                    let off = self.corners[corner % n] - from;
                    let inward = Point::<2>::new(from.y - to.y, to.x - from.x).normalize();
                    let part = off.dot(&(to - from)) / (to - from).norm_squared();
                    let depth = off.dot(&inward);
                    if (0.0..=1.0).contains(&part) && depth > 0.0 {
                        thinnest = thinnest.min(depth);
                    }
                }
            }
        }
        thinnest
    }
}

/// The least exponent of the distance from a corner with which Stokes flow at rest on both of its sides
/// grows, where the outline turns by an angle (rad): that of the fluid is pi more (@moffatt1964). One where the
/// corner is hollow or straight.
pub fn stokes_exponent(turn: f64) -> f64 {
    let angle = std::f64::consts::PI + turn;
    if turn <= 0.0 {
        return 1.0;
    }
    // sin(l a) = -l sin(a) has one root there
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (middle * angle).sin() + middle * angle.sin() > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARROW: [[f64; 2]; 4] = [[2.0, 0.0], [-1.0, 1.0], [0.0, 0.0], [-1.0, -1.0]];

    #[test]
    fn the_nearest_place_is_no_farther_than_any_other_and_knows_its_side() {
        let polygon = Polygon::new(&ARROW, "arrow").unwrap();
        for seed in 0..400_u16 {
            let part = |k: f64| (0.618_034 * k * f64::from(seed + 1)).fract() - 0.5;
            let point = Point::<2>::new(6.0 * part(1.0), 4.0 * part(7.0));
            let foot = polygon.nearest(point);
            let gap = (point - foot.point).dot(&foot.normal);
            assert!((point - foot.point - foot.normal * gap).norm() < 1e-12, "{point}");
            // Upper half: above the lower and below the upper of two lines
            let (x, y) = (point.x, point.y.abs());
            let is_inside = y < (2.0 - x) / 3.0 && y > -x && x < 2.0;
            assert_eq!(gap < 0.0, is_inside, "{point} {gap}");
            for i in 0..200_u8 {
                let other = polygon.at(polygon.perimeter() * f64::from(i) / 200.0)[0];
                assert!((point - other).norm() > gap.abs() - 1e-12);
            }
            let parameter = polygon.parameter_of(foot.point);
            assert!((polygon.at(parameter)[0] - foot.point).norm() < 1e-12);
        }
    }

    #[test]
    fn blunt_corners_have_continuous_tangents_within_the_polygon() {
        let polygon = Polygon::new(&ARROW, "arrow").unwrap();
        let blunt = polygon.blunted();
        let breaks = blunt.breaks();
        assert_eq!(breaks.len(), 10);
        assert!(breaks.windows(2).all(|pair| pair[0] < pair[1]));
        for s in &breaks {
            let ([one, before, _], [other, behind, _]) = (blunt.at(s - 1e-9), blunt.at(s + 1e-9));
            assert!((one - other).norm() < 1e-8 && (before - behind).norm() < 1e-5, "{s}");
        }
        for corner in polygon.corners() {
            let off = (blunt.at(corner.parameter)[0] - corner.at).norm();
            assert!(off > 0.0 && off < 1e-3 * 2.0, "{off}");
        }
    }

    #[test]
    fn what_is_no_polygon_is_refused() {
        let error = |points: &[[f64; 2]]| Polygon::new(points, "p").unwrap_err().to_string();
        assert!(error(&ARROW[..2]).contains("three or more"));
        assert!(error(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).contains("point = 2"));
        assert!(error(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).contains("crosses"));
        assert!(error(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]]).contains("crosses"));
        assert!(error(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]).contains("counter-clockwise"));
        assert!(error(&[[0.0, 0.0], [f64::NAN, 1.0], [1.0, 0.0]]).contains("finite"));
    }

    #[test]
    fn sides_across_the_body_and_exponents_are_those_that_are_known() {
        let box_of = |a: f64, b: f64| [[a, b], [-a, b], [-a, -b], [a, -b]];
        let thickness = |points: &[[f64; 2]]| Polygon::new(points, "p").unwrap().thickness();
        assert!((thickness(&box_of(0.5, 0.5)) - 1.0).abs() < 1e-12);
        assert!((thickness(&box_of(5.0, 0.1)) - 0.2).abs() < 1e-12);
        assert!((stokes_exponent(std::f64::consts::FRAC_PI_2) - 0.544_483_74).abs() < 1e-6);
        assert!((stokes_exponent(std::f64::consts::PI) - 0.5).abs() < 1e-6);
        assert_eq!(stokes_exponent(-0.3), 1.0);
    }
}
