//! `Patch`: a straight or quadratic triangle of a surface, and its point nearest to another one.

use nalgebra::Matrix3;

use crate::{Bounds, Point};

/// Steps of Newton's method.
const MOST_STEPS: usize = 30;
/// Step in reference coordinates at which it has ended.
const SAME: f64 = 1e-13;
/// Reference coordinates below this are on an edge.
const ON_EDGE: f64 = 1e-9;
/// How far Newton's method may leave the reference triangle and come back.
const BEYOND: f64 = 0.3;
/// A quadratic triangle is no farther from the straight one than this times the largest distance of a
/// node from the middle of its edge: the sum of 4 λi λj over the edges is at most 4/3.
const BULGE: f64 = 4.0 / 3.0;

/// A triangle with six nodes, of which those in edges may be off the middle; it has turned its back on the
/// fluid, so that the normal of its corners leaves it.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    corners: [Point<3>; 3],
    /// The nodes in the edges from each corner to the next.
    nodes: [Point<3>; 3],
    /// Coefficients of 1, u, v, u², uv, v².
    coefficients: [Point<3>; 6],
    bulge: f64,
    /// Whether each edge belongs to no other triangle of the surface.
    is_rim: [bool; 3],
    /// Whether each corner is where the surface ends, be its edges or not.
    is_rim_corner: [bool; 3],
}

/// The area of the reference coordinates at a place of a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Element {
    /// Where it is (m).
    pub at: Point<3>,
    /// Its area (m2) along the normal into the fluid.
    pub outward: Point<3>,
}

/// A point of a triangle.
#[derive(Debug, Clone, Copy)]
pub struct OnPatch {
    /// Reference coordinates.
    pub place: [f64; 2],
    /// Where it is (m).
    pub point: Point<3>,
}

impl Patch {
    /// The triangle of three corners and the nodes in the edges from each to the next.
    pub fn new(corners: [Point<3>; 3], nodes: [Point<3>; 3], is_rim: [bool; 3]) -> Self {
        let [a, b, c] = corners;
        let [k, l, m] = nodes;
        let coefficients = [
            a,
            k * 4.0 - a * 3.0 - b,
            m * 4.0 - a * 3.0 - c,
            (a + b) * 2.0 - k * 4.0,
            (a + l - k - m) * 4.0,
            (a + c) * 2.0 - m * 4.0,
        ];
        let off = |i: usize| (nodes[i] - (corners[i] + corners[(i + 1) % 3]) * 0.5).norm();
        let bent = |i: usize| is_bent(&corners[i], &corners[(i + 1) % 3], &nodes[i]);
        let bulge = if (0..3).any(bent) { (0..3).map(off).fold(0.0, f64::max) } else { 0.0 };
        Self {
            corners,
            nodes,
            coefficients,
            bulge: BULGE * bulge,
            is_rim,
            is_rim_corner: [false; 3],
        }
    }

    /// The same with edges and corners at which the surface ends.
    pub fn with_rim(self, is_rim: [bool; 3], is_rim_corner: [bool; 3]) -> Self {
        Self { is_rim, is_rim_corner, ..self }
    }

    /// Whether it is not flat with straight edges.
    pub fn is_curved(&self) -> bool {
        self.bulge > 0.0
    }

    /// Its corners and the nodes of a curved one (m).
    pub fn points(&self) -> impl Iterator<Item = Point<3>> + '_ {
        let nodes = if self.is_curved() { self.nodes.as_slice() } else { &[] };
        self.corners.iter().chain(nodes).copied()
    }

    /// The control points of its Bezier form (m), within whose hull it lies.
    pub fn control_points(&self) -> impl Iterator<Item = Point<3>> + '_ {
        let node =
            |i: usize| self.nodes[i] * 2.0 - (self.corners[i] + self.corners[(i + 1) % 3]) * 0.5;
        self.corners.iter().copied().chain((0..3).map(node))
    }

    /// A box around it: around the control points of its Bezier form.
    pub fn bounds(&self) -> Bounds<3> {
        let mut bounds = Bounds::around(&self.corners);
        for point in self.control_points().skip(3) {
            bounds.include(&point);
        }
        bounds
    }

    fn at(&self, [u, v]: [f64; 2]) -> Point<3> {
        let [one, x, y, xx, xy, yy] = &self.coefficients;
        one + (x + xx * u + xy * v) * u + (y + yy * v) * v
    }

    fn tangents(&self, [u, v]: [f64; 2]) -> [Point<3>; 2] {
        let [_, x, y, xx, xy, yy] = &self.coefficients;
        [x + xx * (2.0 * u) + xy * v, y + xy * u + yy * (2.0 * v)]
    }

    /// The unit normal into the fluid at a place.
    pub fn inward(&self, place: [f64; 2]) -> Point<3> {
        let [along, across] = self.tangents(place);
        -along.cross(&across).normalize()
    }

    /// The area of the reference coordinates at a place.
    pub fn element(&self, place: [f64; 2]) -> Element {
        let [along, across] = self.tangents(place);
        Element { at: self.at(place), outward: -along.cross(&across) }
    }

    /// The least cosine between its normal at its nodes and that of the straight triangle.
    pub fn least_cosine(&self) -> f64 {
        let [a, b, c] = &self.corners;
        let flat = -(b - a).cross(&(c - a)).normalize();
        let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
        places.iter().map(|place| self.inward(*place).dot(&flat)).fold(1.0, f64::min)
    }

    /// The derivative of the unit normal into the fluid along the triangle at a place (1/m).
    pub fn curvature(&self, place: [f64; 2]) -> Matrix3<f64> {
        let [one, two] = self.tangents(place);
        let normal = self.inward(place);
        let [_, _, _, xx, xy, yy] = &self.coefficients;
        let bends =
            [[2.0 * xx.dot(&normal), xy.dot(&normal)], [xy.dot(&normal), 2.0 * yy.dot(&normal)]];
        // The dual tangents, with which a vector along the triangle has its components
        let area = one.cross(&two);
        let square = area.norm_squared();
        let dual = [two.cross(&area) / square, area.cross(&one) / square];
        let mut derivative = Matrix3::zeros();
        for (i, row) in bends.iter().enumerate() {
            for (j, bend) in row.iter().enumerate() {
                derivative -= dual[i] * dual[j].transpose() * *bend;
            }
        }
        derivative
    }

    /// Whether a place is inside, on no edge.
    pub fn is_inner(&self, [u, v]: [f64; 2]) -> bool {
        u > ON_EDGE && v > ON_EDGE && 1.0 - u - v > ON_EDGE
    }

    /// Whether a place is on an edge that no other triangle has, or at a corner where the surface ends.
    pub fn is_on_rim(&self, [u, v]: [f64; 2]) -> bool {
        let off = [v, 1.0 - u - v, u];
        let at = [1.0 - u - v, u, v];
        off.iter().zip(self.is_rim).any(|(off, is_rim)| is_rim && *off <= ON_EDGE)
            || at.iter().zip(self.is_rim_corner).any(|(at, is_rim)| is_rim && *at >= 1.0 - ON_EDGE)
    }

    /// The nearest point to another one; `None` where that is known to be farther than a distance (m).
    pub fn nearest(&self, point: &Point<3>, within: f64) -> Option<OnPatch> {
        let flat = nearest_on_triangle(&self.corners, point);
        let distance = (point - self.corner_sum(flat)).norm();
        if distance - self.bulge > within {
            return None;
        }
        let found = |place: [f64; 2]| OnPatch { place, point: self.at(place) };
        if !self.is_curved() {
            return Some(found(flat));
        }
        if let Some(place) = self.inner_nearest(point, flat) {
            return Some(found(place));
        }
        let edges = (0..3).map(|edge| found(self.nearest_on_edge(point, edge)));
        let far = |on: &OnPatch| (point - on.point).norm_squared();
        edges.min_by(|one, other| far(one).total_cmp(&far(other)))
    }

    /// The point of the straight triangle at a place (m).
    fn corner_sum(&self, [u, v]: [f64; 2]) -> Point<3> {
        let [a, b, c] = &self.corners;
        a * (1.0 - u - v) + b * u + c * v
    }

    /// By Newton's method; `None` where it leaves the triangle.
    fn inner_nearest(&self, point: &Point<3>, start: [f64; 2]) -> Option<[f64; 2]> {
        let [_, _, _, xx, xy, yy] = &self.coefficients;
        let mut place = start;
        for _ in 0..MOST_STEPS {
            let off = self.at(place) - point;
            let [one, two] = self.tangents(place);
            let slope = [off.dot(&one), off.dot(&two)];
            let first = [one.dot(&one), one.dot(&two), two.dot(&two)];
            let full = [
                first[0] + 2.0 * off.dot(xx),
                first[1] + off.dot(xy),
                first[2] + 2.0 * off.dot(yy),
            ];
            // Without the curvature the matrix is positive definite always
            let is_convex = |m: &[f64; 3]| m[0] > 0.0 && m[0] * m[2] > m[1] * m[1];
            let [p, q, r] = if is_convex(&full) { full } else { first };
            let determinant = p * r - q * q;
            let step = [
                (q * slope[1] - r * slope[0]) / determinant,
                (q * slope[0] - p * slope[1]) / determinant,
            ];
            place = [place[0] + step[0], place[1] + step[1]];
            let least = place[0].min(place[1]).min(1.0 - place[0] - place[1]);
            // Also refuses what is not a number
            if least.is_nan() || least < -BEYOND {
                return None;
            }
            if step[0].abs().max(step[1].abs()) < SAME {
                break;
            }
        }
        (place[0] >= 0.0 && place[1] >= 0.0 && place[0] + place[1] <= 1.0).then_some(place)
    }

    /// The place on an edge that is nearest to a point (m), by Newton's method.
    fn nearest_on_edge(&self, point: &Point<3>, edge: usize) -> [f64; 2] {
        let (a, b, node) = (self.corners[edge], self.corners[(edge + 1) % 3], self.nodes[edge]);
        let (along, bend) = (node * 4.0 - a * 3.0 - b, (a + b) * 2.0 - node * 4.0);
        let chord = b - a;
        let mut t = ((point - a).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
        for _ in 0..MOST_STEPS {
            let off = a + (along + bend * t) * t - point;
            let tangent = along + bend * (2.0 * t);
            let second = tangent.norm_squared() + 2.0 * off.dot(&bend);
            let second = if second > 0.0 { second } else { tangent.norm_squared() };
            let next = (t - off.dot(&tangent) / second).clamp(0.0, 1.0);
            let step = next - t;
            t = next;
            if step.abs() < SAME {
                break;
            }
        }
        [[t, 0.0], [1.0 - t, t], [0.0, 1.0 - t]][edge]
    }
}

/// The place of a triangle nearest to a point: on its plane, where that is over it, else on the nearest
/// of its sides.
fn nearest_on_triangle([a, b, c]: &[Point<3>; 3], point: &Point<3>) -> [f64; 2] {
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    let over = |from: &Point<3>, to: &Point<3>| (to - from).cross(&(point - from)).dot(&normal);
    let weights = [over(b, c), over(c, a), over(a, b)];
    if square > 0.0 && weights.iter().all(|weight| *weight >= 0.0) {
        return [weights[1] / square, weights[2] / square];
    }
    let on_side = |from: &Point<3>, to: &Point<3>| {
        let along = to - from;
        ((point - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
    };
    let parts = [on_side(a, b), on_side(b, c), on_side(c, a)];
    let places = [[parts[0], 0.0], [1.0 - parts[1], parts[1]], [0.0, 1.0 - parts[2]]];
    let off = |[u, v]: &[f64; 2]| (a * (1.0 - u - v) + b * *u + c * *v - point).norm_squared();
    places.into_iter().min_by(|p, q| off(p).total_cmp(&off(q))).unwrap_or_default()
}

/// Distance of a node from the middle of its edge, in lengths of the edge, below which it is there.
const STRAIGHT: f64 = 1e-9;

/// Whether the edge between two points is bent to a node.
pub fn is_bent(a: &Point<3>, b: &Point<3>, node: &Point<3>) -> bool {
    (node - (a + b) * 0.5).norm() > STRAIGHT * (b - a).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle on a sphere of this radius about the origin, its middles on it, seen from outside.
    fn on_sphere(radius: f64) -> Patch {
        let on = |x: f64, y: f64| Point::<3>::new(x, y, 1.0).normalize() * radius;
        let [a, b, c] = [on(0.0, 0.0), on(0.5, 0.1), on(0.1, 0.6)];
        let middle = |a: Point<3>, b: Point<3>| (a + b).normalize() * radius;
        Patch::new([a, b, c], [middle(a, b), middle(b, c), middle(c, a)], [false, true, false])
    }

    #[test]
    fn nearest_points_are_no_farther_than_any_other_of_the_triangle() {
        let patch = on_sphere(2.0);
        for seed in 0..200_u16 {
            let part = |k: f64| (0.618_034 * k * f64::from(seed + 1)).fract() - 0.5;
            let point = Point::<3>::new(3.0 * part(1.0), 3.0 * part(5.0), 1.8 + part(13.0));
            let nearest = patch.nearest(&point, f64::INFINITY).unwrap();
            let distance = (nearest.point - point).norm();
            assert!((patch.at(nearest.place) - nearest.point).norm() < 1e-14);
            for i in 0..=40_u8 {
                for j in 0..=(40 - i) {
                    let at = patch.at([f64::from(i) / 40.0, f64::from(j) / 40.0]);
                    assert!((at - point).norm() > distance - 1e-12, "{seed} {i} {j}");
                }
            }
            if patch.is_inner(nearest.place) {
                let way = (point - nearest.point).normalize();
                assert!(way.dot(&patch.inward(nearest.place)).abs() > 1.0 - 1e-12, "{seed}");
            }
            assert!(patch.nearest(&point, 0.5 * distance - 0.2).is_none());
        }
    }

    #[test]
    fn the_curvature_is_that_of_the_sphere_it_is_on() {
        let patch = on_sphere(2.0);
        let curvature = patch.curvature([0.3, 0.3]);
        // The fluid is inside, so that the wall is concave; second derivatives of quadratic triangles are
        // of first order in their size, here 0.5 of 2
        assert!((curvature.trace() + 1.0).abs() < 0.05, "{curvature}");
        assert!((curvature * patch.inward([0.3, 0.3])).norm() < 1e-14);
        assert!(patch.is_on_rim([0.5, 0.5]) && !patch.is_on_rim([0.5, 0.0]));
        let bounds = patch.bounds();
        for place in [[0.5, 0.25], [0.5, 0.5], [0.25, 0.0]] {
            assert!(bounds.squared_distance(&patch.at(place)) == 0.0);
        }
    }
}
