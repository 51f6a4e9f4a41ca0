//! `ClosedSpline`: a spline as an outline, cut at its extreme points, with samples to search from.

use std::sync::Arc;

use super::foot::Foot;
use crate::planar::vector::cross;
use crate::{MeshError, Point, Spline};

/// Samples between two points of the spline, to start searches from.
const SAMPLES_PER_SPAN: usize = 12;

/// Samples that are passed over in one where all of them are too far away. A tail of some thousand samples has some
/// hundred runs of them, as many as are looked at one by one in the runs at hand.
const RUN: usize = 32;

/// More than the rounding of a sum of distances over the distances.
const ROUNDING: f64 = 1e-12;

/// Distance from the axis over that of samples, below which a point is an end on the axis.
const ON_AXIS: f64 = 1e-9;

/// A counter-clockwise spline that does not cross itself.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedSpline {
    /// The curve in the frame of the body.
    pub spline: Arc<Spline>,
    /// Parameters of its extreme points, and of the first one again.
    cuts: [f64; 5],
    /// Where searches start.
    samples: Vec<Sample>,
    /// Circles around each [`RUN`] of them.
    runs: Vec<Circle>,
    /// Largest distance between neighbouring samples (m).
    spacing: f64,
    /// Whether its lower half is the mirror image of the upper one in the x axis.
    is_about_axis: bool,
}

/// A point of the spline.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sample {
    parameter: f64,
    point: Point<2>,
}

impl ClosedSpline {
    /// Cuts a spline at its extreme points and refuses one that is clockwise or crosses itself.
    pub fn new(spline: Arc<Spline>, name: &str) -> Result<Self, MeshError> {
        let knots = spline.knots();
        let samples: Vec<f64> = knots
            .windows(2)
            .flat_map(|k| {
                let step = (k[1] - k[0]) / SAMPLES_PER_SPAN as f64;
                (0..SAMPLES_PER_SPAN).map(move |i| k[0] + step * i as f64)
            })
            .collect();
        let places: Vec<Point<2>> = samples.iter().map(|s| spline.evaluate(*s)[0]).collect();
        let n = places.len();
        let spacing = (0..n).map(|i| (places[(i + 1) % n] - places[i]).norm()).fold(0.0, f64::max);
        let area: f64 = (0..n).map(|i| 0.5 * cross(places[i], places[(i + 1) % n])).sum();
        if area <= 0.0 {
            return Err(MeshError::Body {
                body: name.to_string(),
                what: "enclosed area of the spline",
                value: area,
                wanted: "positive: list its points counter-clockwise",
            });
        }
        if let Some(at) = crossing(&places) {
            return Err(MeshError::SelfIntersection { body: name.to_string(), x: at.x, y: at.y });
        }
        let directions = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(Point::<2>::from);
        let mut cuts = [0.0; 5];
        for (k, direction) in directions.iter().enumerate() {
            let s = extreme(&spline, &samples, &places, *direction);
            // A simple counter-clockwise loop meets its extremes in this order
            cuts[k] = if k > 0 && s < cuts[0] { s + spline.period() } else { s };
        }
        cuts[4] = cuts[0] + spline.period();
        let sample = |(parameter, point)| Sample { parameter, point };
        let runs = places.chunks(RUN).map(Circle::around).collect();
        let samples = samples.into_iter().zip(places).map(sample).collect();
        Ok(Self { spline, cuts, samples, runs, spacing, is_about_axis: false })
    }

    /// One that is its own mirror image in the x axis, whose points begin with its right end: cut at its ends and half
    /// way between them, so that a half of it is two of the quarters whatever its extreme points are.
    pub fn about_axis(spline: Spline, name: &str) -> Result<Self, MeshError> {
        let whole = Self::new(Arc::new(spline), name).map_err(|error| match error {
            MeshError::Body { body, value, .. } => {
                let what = "area between the profile and the axis";
                let wanted = "positive: list its points from one end to the other";
                MeshError::Body { body, what, value, wanted }
            }
            error => error,
        })?;
        let knots = whole.spline.knots();
        let (left, period) = (knots[knots.len() / 2], whole.spline.period());
        // The sum of two halves is exact, so the second quarter ends at the knot on the axis to the last bit
        let cuts = [0.0, 0.5 * left, left, left + 0.5 * (period - left), period];
        Ok(Self { cuts, is_about_axis: true, ..whole })
    }

    /// No point of it is farther from the origin (m).
    pub fn reach(&self) -> f64 {
        let farthest = self.samples.iter().map(|sample| sample.point.norm());
        self.spacing + farthest.fold(0.0, f64::max)
    }

    /// Point (m), first and second derivative at a parameter in [0, 1] of one of the quarters.
    pub fn evaluate(&self, quarter: usize, parameter: f64) -> [Point<2>; 3] {
        let start = self.cuts[quarter];
        let rate = self.cuts[quarter + 1] - start;
        let [point, first, second] = self.spline.evaluate(start + rate * parameter);
        [point, first * rate, second * (rate * rate)]
    }

    /// Point of the spline nearest to a point.
    pub fn nearest(&self, point: Point<2>) -> Foot {
        let [mut at, first, second] = self.spline.evaluate(self.parameter_of(point));
        // The foot of a place on the axis has its rounding; a node there may not leave the axis
        if self.is_about_axis && point.y == 0.0 && at.y.abs() < ON_AXIS * self.spacing {
            at.y = 0.0;
        }
        let speed = first.norm();
        let normal = Point::<2>::new(first.y, -first.x) / speed;
        Foot { point: at, normal, curvature: cross(first, second) / speed.powi(3) }
    }

    /// Parameter of the point of the spline nearest to a point; of two about an axis that are as near, the one on
    /// the side of the point, the upper side for a point on the axis.
    pub fn parameter_of(&self, point: Point<2>) -> f64 {
        let found = self.search(point);
        let is_above = |place: Point<2>| place.y >= 0.0;
        if self.is_about_axis && is_above(self.spline.evaluate(found)[0]) != is_above(point) {
            return self.spline.period() - found;
        }
        found
    }

    fn search(&self, point: Point<2>) -> f64 {
        let Self { spline, samples, spacing, .. } = self;
        let n = samples.len();
        let gap = |i: usize| (samples[i].point - point).norm();
        let within = |run: usize| run * RUN..n.min((run + 1) * RUN);
        let bounds: Vec<f64> = self.runs.iter().map(|run| run.least_gap(point)).collect();
        let nearest = (0..bounds.len()).min_by(|a, b| bounds[*a].total_cmp(&bounds[*b]));
        let mut shortest = f64::INFINITY;
        for run in nearest.into_iter().chain(0..bounds.len()) {
            if bounds[run] <= shortest {
                shortest = within(run).map(gap).fold(shortest, f64::min);
            }
        }
        // Between samples the curve comes nearer than they by less than their spacing
        let hopeless = shortest + spacing;
        let mut best = (f64::INFINITY, 0.0);
        let runs = (0..bounds.len()).filter(|run| bounds[*run] <= hopeless);
        for i in runs.flat_map(within) {
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            let here = gap(i);
            if here > hopeless || here > gap(before) || here > gap(after) {
                continue;
            }
            let low = samples[before].parameter - if i == 0 { spline.period() } else { 0.0 };
            let high = samples[after].parameter + if after == 0 { spline.period() } else { 0.0 };
            let s = foot_on_spline(spline, low, high, samples[i].parameter, point);
            let gap = (spline.evaluate(s)[0] - point).norm();
            if gap < best.0 {
                best = (gap, s);
            }
        }
        best.1
    }
}

/// A circle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Circle {
    center: Point<2>,
    radius: f64,
}

impl Circle {
    /// One that holds some points.
    fn around(points: &[Point<2>]) -> Self {
        let corner = |pick: fn(&Point<2>, &Point<2>) -> Point<2>| {
            points.iter().fold(points[0], |corner, point| pick(&corner, point))
        };
        let center = 0.5 * (corner(Point::<2>::inf) + corner(Point::<2>::sup));
        let radius = points.iter().map(|point| (point - center).norm()).fold(0.0, f64::max);
        Self { center, radius }
    }

    /// A lower bound of the distance of what it holds from a point (m), with any rounding.
    fn least_gap(&self, point: Point<2>) -> f64 {
        let away = (point - self.center).norm();
        away - self.radius - ROUNDING * (away + self.radius)
    }
}

/// Root of (c(s) - x) . c'(s) between two parameters, by Newton kept inside the bracket.
fn foot_on_spline(spline: &Spline, mut low: f64, mut high: f64, start: f64, x: Point<2>) -> f64 {
    let mut s = start;
    for _ in 0..60 {
        let [at, first, second] = spline.evaluate(s);
        let value = (at - x).dot(&first);
        if value > 0.0 {
            high = s;
        } else {
            low = s;
        }
        let slope = first.norm_squared() + (at - x).dot(&second);
        let newton = s - value / slope;
        let next =
            if slope > 0.0 && newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - s).abs() <= 1e-15 * spline.period() {
            break;
        }
        s = next;
    }
    s
}

/// Parameter of the point of the spline farthest in a direction, near one of these parameters of points.
fn extreme(spline: &Spline, samples: &[f64], places: &[Point<2>], direction: Point<2>) -> f64 {
    let n = samples.len();
    let mut top = (0, f64::NEG_INFINITY);
    for (i, place) in places.iter().enumerate() {
        let height = place.dot(&direction);
        if height > top.1 {
            top = (i, height);
        }
    }
    let (top, _) = top;
    let before = samples[(top + n - 1) % n];
    let mut low = if before < samples[top] { before } else { before - spline.period() };
    let after = samples[(top + 1) % n];
    let mut high = if after > samples[top] { after } else { after + spline.period() };
    let mut s = samples[top];
    for _ in 0..100 {
        let [_, first, second] = spline.evaluate(s);
        let slope = first.dot(&direction);
        if slope > 0.0 {
            low = s;
        } else {
            high = s;
        }
        let newton = s - slope / second.dot(&direction);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - s).abs() <= 1e-16 * spline.period() {
            break;
        }
        s = next;
    }
    s.rem_euclid(spline.period())
}

/// Where two sides of a closed polygon cross, if any do: a sweep along x.
pub(super) fn crossing(polygon: &[Point<2>]) -> Option<Point<2>> {
    let n = polygon.len();
    let side = |i: usize| (polygon[i], polygon[(i + 1) % n]);
    let mut order: Vec<usize> = (0..n).collect();
    let start = |i: usize| side(i).0.x.min(side(i).1.x);
    order.sort_by(|i, j| start(*i).total_cmp(&start(*j)));
    let mut open: Vec<usize> = Vec::new();
    for &j in &order {
        let (c, d) = side(j);
        let (low, high) = (c.y.min(d.y), c.y.max(d.y));
        open.retain(|i| side(*i).0.x.max(side(*i).1.x) >= c.x.min(d.x));
        for &i in &open {
            let (a, b) = side(i);
            let are_neighbours = (i + 1) % n == j || (j + 1) % n == i;
            if are_neighbours || low > a.y.max(b.y) || high < a.y.min(b.y) {
                continue;
            }
            let (p, q) = (cross(b - a, c - a), cross(b - a, d - a));
            let (r, s) = (cross(d - c, a - c), cross(d - c, b - c));
            if p * q <= 0.0 && r * s <= 0.0 {
                return Some((a + b + c + d) / 4.0);
            }
        }
        open.push(j);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wave as thin as a tail, whose sides are near each other, in many samples.
    fn tail() -> ClosedSpline {
        let side = |i: i32, offset: f64| {
            let x = f64::from(i) / 20.0;
            [x, 0.4 * (2.0 * x).sin() + offset]
        };
        let there = (0..100).map(|i| side(i, -0.03));
        let back = (0..100).rev().map(|i| side(i, 0.03));
        let points: Vec<[f64; 2]> = there.chain(back).collect();
        ClosedSpline::new(Arc::new(Spline::through(&points).unwrap()), "tail").unwrap()
    }

    /// The search that passes over nothing.
    fn by_all_samples(curve: &ClosedSpline, point: Point<2>) -> f64 {
        let ClosedSpline { spline, samples, spacing, .. } = curve;
        let n = samples.len();
        let gaps: Vec<f64> = samples.iter().map(|sample| (sample.point - point).norm()).collect();
        let shortest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let mut best = (f64::INFINITY, 0.0);
        for i in 0..n {
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            let is_least = gaps[i] <= gaps[before] && gaps[i] <= gaps[after];
            if !is_least || gaps[i] > shortest + spacing {
                continue;
            }
            let low = samples[before].parameter - if i == 0 { spline.period() } else { 0.0 };
            let high = samples[after].parameter + if after == 0 { spline.period() } else { 0.0 };
            let s = foot_on_spline(spline, low, high, samples[i].parameter, point);
            let gap = (spline.evaluate(s)[0] - point).norm();
            if gap < best.0 {
                best = (gap, s);
            }
        }
        best.1
    }

    #[test]
    fn samples_that_are_passed_over_change_no_bit() {
        let curve = tail();
        assert_eq!(curve.runs.len(), 75);
        let places = |n: u32, low: f64, high: f64| {
            (0..=n).map(move |i| low + (high - low) * f64::from(i) / f64::from(n))
        };
        let around = places(40, -1.0, 6.0).flat_map(|x| places(24, -1.2, 1.2).map(move |y| [x, y]));
        // On the curve, and in the middle between its sides, where both are as near
        let on = curve.samples.iter().step_by(7).map(|sample| sample.point.into());
        let between = places(100, 0.0, 4.95).map(|x| [x, 0.4 * (2.0 * x).sin()]);
        for place in around.chain(on).chain(between).chain([[1e9, -1e9], [f64::NAN, 0.0]]) {
            let point = Point::<2>::from(place);
            let (found, wanted) = (curve.search(point), by_all_samples(&curve, point));
            assert_eq!(found.to_bits(), wanted.to_bits(), "{place:?}: {found} {wanted}");
        }
    }
}
