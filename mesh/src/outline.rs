//! `Outline`: the closed curve around a placed body, in four quarters cut at its extreme points.
//!
//! Quarter k runs counter-clockwise from the extreme point in direction k of the body frame (+x,
//! +y, -x, -y) to the next one, with a parameter in [0, 1]. For an ellipse the parameter is the
//! eccentric angle over π/2.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use crate::{MeshError, PlacedShape, Point, Shape, Spline};

/// The closed curve around a body, in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    center: Point<2>,
    cos: f64,
    sin: f64,
    /// Shared by all places of the same body.
    form: Arc<Form>,
    /// No point of the outline is farther from the centre (m).
    reach: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Form {
    Ellipse([f64; 2]),
    Spline {
        spline: Arc<Spline>,
        cuts: [f64; 5],
        /// Parameters and places from which searches start.
        samples: Vec<(f64, Point<2>)>,
        /// Largest distance between neighbouring samples (m).
        spacing: f64,
    },
}

/// The place of an outline nearest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Where on the outline (m).
    pub point: Point<2>,
    /// Unit normal there, out of the body.
    pub normal: Point<2>,
    /// Curvature there (1/m), positive where the body is convex.
    pub curvature: f64,
    /// Signed distance (m), negative inside the body.
    pub gap: f64,
}

/// Pieces a quarter of an ellipse is cut into where searches start.
const ARCS_PER_QUARTER: usize = 4;

/// Samples of a spline between two of its points, to start searches from.
const SAMPLES_PER_SPAN: usize = 12;

impl Outline {
    /// Outline of a body in its place.
    ///
    /// # Errors
    /// [`MeshError::Body`] when a length is not positive or a spline has no valid points,
    /// [`MeshError::SelfIntersection`] when a spline crosses itself.
    pub fn new(body: &PlacedShape) -> Result<Self, MeshError> {
        let refuse =
            |what, value, wanted| MeshError::Body { body: body.name.clone(), what, value, wanted };
        for (what, value) in
            [("centre x", body.center.x), ("centre y", body.center.y), ("angle", body.angle)]
        {
            if !value.is_finite() {
                return Err(refuse(what, value, "finite"));
            }
        }
        let (what, semi_axes) = match &body.shape {
            Shape::Disc { radius } | Shape::Sphere { radius } => ("radius", [*radius; 2]),
            Shape::Ellipse { semi_axes } | Shape::Spheroid { semi_axes } => {
                ("semi_axes", *semi_axes)
            }
            Shape::Spline { points } => {
                let spline = Spline::through(points).ok_or_else(|| {
                    let wanted = "three or more, finite, no two neighbours equal";
                    refuse("number of points", points.len() as f64, wanted)
                })?;
                let form = Form::spline(Arc::new(spline), &body.name)?;
                return Ok(Self::with_form(body.center, body.angle, form));
            }
            Shape::Curve { spline } => {
                let form = Form::spline(Arc::clone(spline), &body.name)?;
                return Ok(Self::with_form(body.center, body.angle, form));
            }
        };
        if let Some(value) = semi_axes.into_iter().find(|a| !(*a > 0.0 && a.is_finite())) {
            return Err(refuse(what, value, "positive and finite"));
        }
        Ok(Self::with_form(body.center, body.angle, Form::Ellipse(semi_axes)))
    }

    /// Circle around a point.
    #[must_use]
    pub fn circle(center: Point<2>, radius: f64) -> Self {
        Self::with_form(center, 0.0, Form::Ellipse([radius; 2]))
    }

    fn with_form(center: Point<2>, angle: f64, form: Form) -> Self {
        let reach = match &form {
            Form::Ellipse([a, b]) => a.max(*b),
            Form::Spline { samples, spacing, .. } => {
                let farthest = samples.iter().map(|(_, place)| place.norm());
                spacing + farthest.fold(0.0, f64::max)
            }
        };
        Self { center, cos: angle.cos(), sin: angle.sin(), form: Arc::new(form), reach }
    }

    /// The same outline with its origin at `center` (m) and turned by `angle` (rad) from its own
    /// frame; nothing is computed anew.
    #[must_use]
    pub fn placed_at(&self, center: Point<2>, angle: f64) -> Self {
        let form = Arc::clone(&self.form);
        Self { center, cos: angle.cos(), sin: angle.sin(), form, reach: self.reach }
    }

    /// Place of the origin of the body's own frame (m).
    #[must_use]
    pub fn center(&self) -> Point<2> {
        self.center
    }

    /// Radius of a circle about [`Self::center`] which holds the outline (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Length of the parameter of [`Self::at`]: 2 pi for an ellipse, the last knot of a spline: the
    /// chord length of its points (m) unless given.
    #[must_use]
    pub fn period(&self) -> f64 {
        match &*self.form {
            Form::Ellipse(_) => TAU,
            Form::Spline { spline, .. } => spline.period(),
        }
    }

    /// Point (m), first and second derivative at a parameter modulo [`Self::period`],
    /// counter-clockwise: the eccentric angle of an ellipse (rad), the parameter of a spline.
    #[must_use]
    pub fn at(&self, parameter: f64) -> [Point<2>; 3] {
        let [point, first, second] = match &*self.form {
            Form::Ellipse([a, b]) => {
                let (s, c) = parameter.sin_cos();
                let point = Point::<2>::new(a * c, b * s);
                [point, Point::<2>::new(-a * s, b * c), -point]
            }
            Form::Spline { spline, .. } => spline.evaluate(parameter),
        };
        [self.center + self.turn(point), self.turn(first), self.turn(second)]
    }

    /// Parameter of [`Self::at`] of the nearest place on the outline, from zero to the period: on
    /// the outline the inverse of `at`.
    #[must_use]
    pub fn parameter_of(&self, point: Point<2>) -> f64 {
        let local = self.to_local(point);
        let parameter = match &*self.form {
            Form::Ellipse([a, b]) => {
                let foot = nearest_on_ellipse([*a, *b], local).0;
                (foot.y / b).atan2(foot.x / a)
            }
            Form::Spline { spline, samples, spacing, .. } => {
                parameter_on_spline(spline, samples, *spacing, local)
            }
        };
        let within = parameter.rem_euclid(self.period());
        // Rounding may give the period itself
        if within < self.period() { within } else { 0.0 }
    }

    /// Parameter of [`Self::at`] of the point of a circle in a direction of the world.
    pub(crate) fn parameter_towards(&self, direction: Point<2>) -> f64 {
        let (x, y) = (direction.x, direction.y);
        let angle = (self.cos * y - self.sin * x).atan2(self.cos * x + self.sin * y);
        if angle < 0.0 { angle + TAU } else { angle }
    }

    /// Parameters of [`Self::at`], from zero to the period, between which the outline has three
    /// continuous derivatives and |second derivative| is largest at an end.
    pub(crate) fn breaks(&self) -> Vec<f64> {
        match &*self.form {
            Form::Ellipse(_) => {
                let n = 4 * ARCS_PER_QUARTER;
                (0..=n).map(|i| TAU * i as f64 / n as f64).collect()
            }
            Form::Spline { spline, .. } => spline.knots().to_vec(),
        }
    }

    /// A lower bound of the gap to a point (m), at no cost.
    #[must_use]
    pub fn least_gap(&self, point: Point<2>) -> f64 {
        (point - self.center).norm() - self.reach
    }

    /// Whether [`Self::least_gap`] surely exceeds a bound (m), at less cost still.
    pub(crate) fn is_beyond(&self, point: Point<2>, bound: f64) -> bool {
        let off = (point - self.center).abs();
        off.x.max(off.y) > (bound + self.reach) * (1.0 + 1e-9)
    }

    /// Point (m), first and second derivative at a parameter in [0, 1] of one of the quarters.
    #[must_use]
    pub fn evaluate(&self, quarter: usize, parameter: f64) -> [Point<2>; 3] {
        let [point, first, second] = match &*self.form {
            Form::Ellipse([a, b]) => {
                let (c, s) = quarter_circle(quarter, parameter);
                let rate = FRAC_PI_2;
                [
                    Point::<2>::new(a * c, b * s),
                    Point::<2>::new(-a * s, b * c) * rate,
                    Point::<2>::new(-a * c, -b * s) * (rate * rate),
                ]
            }
            Form::Spline { spline, cuts, .. } => {
                let rate = cuts[quarter + 1] - cuts[quarter];
                let [point, first, second] = spline.evaluate(cuts[quarter] + rate * parameter);
                [point, first * rate, second * (rate * rate)]
            }
        };
        [self.center + self.turn(point), self.turn(first), self.turn(second)]
    }

    /// Radius when the outline is a circle.
    #[must_use]
    pub fn circle_radius(&self) -> Option<f64> {
        match &*self.form {
            Form::Ellipse([a, b]) if a == b => Some(*a),
            _ => None,
        }
    }

    /// Whether the body is convex by construction (no two parts of it face each other).
    #[must_use]
    pub fn is_ellipse(&self) -> bool {
        matches!(*self.form, Form::Ellipse(_))
    }

    /// Nearest place on the outline.
    #[must_use]
    pub fn nearest(&self, point: Point<2>) -> Nearest {
        let local = self.to_local(point);
        let (at, normal, curvature) = match &*self.form {
            Form::Ellipse(semi_axes) => nearest_on_ellipse(*semi_axes, local),
            Form::Spline { spline, samples, spacing, .. } => {
                nearest_on_spline(spline, samples, *spacing, local)
            }
        };
        let gap = (local - at).dot(&normal);
        // The foot of the perpendicular makes the offset parallel to the normal
        let gap = gap.signum() * (local - at).norm();
        Nearest { point: self.center + self.turn(at), normal: self.turn(normal), curvature, gap }
    }

    /// A place of the world in the frame of the body.
    fn to_local(&self, point: Point<2>) -> Point<2> {
        let offset = point - self.center;
        Point::<2>::new(
            self.cos * offset.x + self.sin * offset.y,
            -self.sin * offset.x + self.cos * offset.y,
        )
    }

    fn turn(&self, v: Point<2>) -> Point<2> {
        Point::<2>::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }
}

/// Cosine and sine of (quarter + parameter) π/2, exact at the ends of the quarter.
fn quarter_circle(quarter: usize, parameter: f64) -> (f64, f64) {
    let (c, s) = if parameter >= 1.0 {
        (0.0, 1.0)
    } else {
        ((parameter * FRAC_PI_2).cos(), (parameter * FRAC_PI_2).sin())
    };
    match quarter % 4 {
        0 => (c, s),
        1 => (-s, c),
        2 => (-c, -s),
        _ => (s, -c),
    }
}

/// Nearest point of an axis-parallel ellipse, normal and curvature there.
///
/// With x, y >= 0 the foot is (a² x / (t + a²), b² y / (t + b²)) for the largest root t of
/// (a x / (t + a²))² + (b y / (t + b²))² = 1, which is bracketed and found by bisected Newton.
///
/// # Source
/// @eberly2013, distance from a point to an ellipse.
fn nearest_on_ellipse([a, b]: [f64; 2], point: Point<2>) -> (Point<2>, Point<2>, f64) {
    let (x, y) = (point.x.abs(), point.y.abs());
    let foot = if a == b {
        let r = x.hypot(y);
        if r > 0.0 { Point::<2>::new(a * x / r, a * y / r) } else { Point::<2>::new(a, 0.0) }
    } else if a > b {
        foot_on_ellipse(a, b, x, y)
    } else {
        let foot = foot_on_ellipse(b, a, y, x);
        Point::<2>::new(foot.y, foot.x)
    };
    let foot = Point::<2>::new(foot.x.copysign(point.x), foot.y.copysign(point.y));
    let gradient = Point::<2>::new(foot.x / (a * a), foot.y / (b * b));
    let steepness = gradient.norm();
    (foot, gradient / steepness, 1.0 / (a * a * b * b * steepness.powi(3)))
}

/// Foot of the perpendicular on an ellipse with a > b, in the first quadrant.
fn foot_on_ellipse(a: f64, b: f64, x: f64, y: f64) -> Point<2> {
    if y <= 0.0 {
        let reach = (a * a - b * b) / a;
        return if x < reach {
            let cos = a * x / (a * a - b * b);
            Point::<2>::new(a * cos, b * (1.0 - cos * cos).max(0.0).sqrt())
        } else {
            Point::<2>::new(a, 0.0)
        };
    }
    // With s = t + b^2, which keeps its digits where the point is next to the long axis
    let c = a * a - b * b;
    let excess = |s: f64| {
        let (p, q) = (a * x / (s + c), b * y / s);
        let slope = -2.0 * (p * p / (s + c) + q * q / s);
        (p * p + q * q - 1.0, slope)
    };
    // Each term alone is at most one, both together at least
    let (mut low, mut high) = ((b * y).max(a * x - c), (a * x).hypot(b * y));
    let mut s = low;
    for _ in 0..200 {
        let (value, slope) = excess(s);
        if value > 0.0 {
            low = low.max(s);
        } else {
            high = high.min(s);
        }
        let newton = s - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let has_settled = (next - s).abs() <= 1e-16 * s;
        s = next;
        if has_settled {
            break;
        }
    }
    let foot = Point::<2>::new(a * a * x / (s + c), b * b * y / s);
    // Rounding leaves the foot a little off the curve: push it back along its ray
    foot / (foot.x / a).hypot(foot.y / b)
}

fn nearest_on_spline(
    spline: &Spline,
    samples: &[(f64, Point<2>)],
    spacing: f64,
    point: Point<2>,
) -> (Point<2>, Point<2>, f64) {
    let [at, first, second] = spline.evaluate(parameter_on_spline(spline, samples, spacing, point));
    let speed = first.norm();
    (at, Point::<2>::new(first.y, -first.x) / speed, cross(first, second) / speed.powi(3))
}

/// Parameter of the place of a spline nearest to a point.
fn parameter_on_spline(
    spline: &Spline,
    samples: &[(f64, Point<2>)],
    spacing: f64,
    point: Point<2>,
) -> f64 {
    let n = samples.len();
    let gaps: Vec<f64> = samples.iter().map(|(_, place)| (place - point).norm()).collect();
    let shortest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let mut best = (f64::INFINITY, 0.0);
    for i in 0..n {
        let (before, after) = ((i + n - 1) % n, (i + 1) % n);
        // Between samples the curve comes nearer than they by less than their spacing
        let is_hopeless = gaps[i] > shortest + spacing;
        if is_hopeless || gaps[i] > gaps[before] || gaps[i] > gaps[after] {
            continue;
        }
        let low = samples[before].0 - if i == 0 { spline.period() } else { 0.0 };
        let high = samples[after].0 + if after == 0 { spline.period() } else { 0.0 };
        let s = foot_on_spline(spline, low, high, samples[i].0, point);
        let gap = (spline.evaluate(s)[0] - point).norm();
        if gap < best.0 {
            best = (gap, s);
        }
    }
    best.1
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

impl Form {
    /// Cuts a spline at its extreme points and refuses one that is clockwise or crosses itself.
    fn spline(spline: Arc<Spline>, name: &str) -> Result<Self, MeshError> {
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
            let s = extreme(&spline, &samples, *direction);
            // A simple counter-clockwise loop meets its extremes in this order
            cuts[k] = if k > 0 && s < cuts[0] { s + spline.period() } else { s };
        }
        cuts[4] = cuts[0] + spline.period();
        let samples = samples.into_iter().zip(places).collect();
        Ok(Self::Spline { spline, cuts, samples, spacing })
    }
}

/// Parameter of the point of the spline farthest in a direction.
fn extreme(spline: &Spline, samples: &[f64], direction: Point<2>) -> f64 {
    let n = samples.len();
    let height = |s: f64| spline.evaluate(s)[0].dot(&direction);
    let mut top = 0;
    for i in 1..n {
        if height(samples[i]) > height(samples[top]) {
            top = i;
        }
    }
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
fn crossing(polygon: &[Point<2>]) -> Option<Point<2>> {
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

/// Third component of the cross product.
pub(crate) fn cross(a: Point<2>, b: Point<2>) -> f64 {
    a.x * b.y - a.y * b.x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ellipse(a: f64, b: f64) -> PlacedShape {
        PlacedShape {
            name: "body".into(),
            shape: Shape::Ellipse { semi_axes: [a, b] },
            center: Point::<2>::new(0.3, -0.2),
            angle: 0.7,
            size: None,
        }
    }

    #[test]
    fn the_nearest_point_of_an_ellipse_is_the_foot_of_its_normal() {
        for (a, b) in [(2.0, 1.0), (0.5, 1.5), (1.0, 1.0), (10.0, 0.1)] {
            let outline = Outline::new(&ellipse(a, b)).unwrap();
            for quarter in 0..4 {
                for i in 0..20 {
                    let [on, first, second] = outline.evaluate(quarter, f64::from(i) / 20.0);
                    let normal = Point::<2>::new(first.y, -first.x).normalize();
                    let nearest = outline.nearest(on + normal * 0.37);
                    assert!((nearest.point - on).norm() < 1e-7 * a.max(b), "{a} {b}");
                    assert!((nearest.gap - 0.37).abs() < 1e-12, "{a} {b} {}", nearest.gap);
                    assert!((nearest.normal - normal).norm() < 1e-6);
                    let curvature = cross(first, second) / first.norm().powi(3);
                    assert!((nearest.curvature / curvature - 1.0).abs() < 1e-4);
                }
            }
            assert!(outline.nearest(outline.center).gap < 0.0);
        }
    }

    /// Also next to the axes, where one coordinate is nothing but rounding.
    #[test]
    fn points_of_an_ellipse_have_no_gap_and_those_on_its_axes_the_right_one() {
        for (a, b) in [(2.0, 1.0), (0.3, 0.789), (10.0, 0.1)] {
            let outline = Outline::new(&ellipse(a, b)).unwrap();
            for i in 0..192 {
                let on = outline.evaluate(i / 48, (i % 48) as f64 / 48.0)[0];
                let gap = outline.nearest(on).gap;
                assert!(gap.abs() < 1e-14 * a.max(b), "{a} {b} {i}: {gap:e}");
            }
        }
        for y in [0.0, 1e-300, 1e-20, 1e-17, 1e-12] {
            let foot = foot_on_ellipse(2.0, 1.0, 0.75, y);
            // On the axis inside the centre of curvature the feet are those of a^2 x / (a^2 - b^2)
            assert!((foot - Point::<2>::new(1.0, 0.75_f64.sqrt())).norm() < 1e-11, "{y}: {foot}");
        }
    }

    #[test]
    fn a_spline_is_cut_at_its_extreme_points() {
        let points = (0..12)
            .map(|i| std::f64::consts::TAU * f64::from(i) / 12.0 + 0.1)
            .map(|t| [2.0 * t.cos() + 0.2 * (2.0 * t).cos(), t.sin()])
            .collect();
        let body = PlacedShape { shape: Shape::Spline { points }, angle: 0.0, ..ellipse(1.0, 1.0) };
        let outline = Outline::new(&body).unwrap();
        for (quarter, axis) in [(0, 0), (1, 1), (2, 0), (3, 1)] {
            assert!(outline.evaluate(quarter, 0.0)[1][axis].abs() < 1e-12);
        }
        let nearest = outline.nearest(Point::<2>::new(5.0, 1.0));
        let around = (0..4000).map(|i| outline.evaluate(i / 1000, (i % 1000) as f64 / 1000.0)[0]);
        let closest = around.map(|p| (p - Point::<2>::new(5.0, 1.0)).norm()).reduce(f64::min);
        assert!((nearest.gap - closest.unwrap()).abs() < 1e-5);
    }

    #[test]
    fn a_figure_of_eight_is_refused() {
        let points = vec![[2.0, -1.0], [2.0, 1.0], [-2.0, -1.5], [-2.0, 1.5]];
        let body = PlacedShape { shape: Shape::Spline { points }, ..ellipse(1.0, 1.0) };
        let error = Outline::new(&body).unwrap_err();
        let clockwise_or_crossing =
            matches!(error, MeshError::SelfIntersection { .. } | MeshError::Body { .. });
        assert!(clockwise_or_crossing, "{error}");
    }

    #[test]
    fn the_parameter_of_a_place_on_the_outline_gives_it_back() {
        let fish = crate::FishForm {
            length: 1.0,
            head_width: 0.04,
            tail_width: 0.01,
            head_end: 0.04,
            tail_start: 0.95,
            tip_radius: 1e-3,
            corner_radius: 0.01,
        };
        let spline = Arc::new(crate::Profile::fish(&fish).unwrap().spline().unwrap());
        let fish = PlacedShape { shape: Shape::Curve { spline }, ..ellipse(1.0, 1.0) };
        for body in [ellipse(2.0, 0.5), ellipse(0.3, 1.2), ellipse(0.7, 0.7), fish] {
            let outline = Outline::new(&body).unwrap();
            let period = outline.period();
            for i in 0..1000 {
                let wanted = period * f64::from(i) / 1000.0;
                let found = outline.parameter_of(outline.at(wanted)[0]);
                let off = (found - wanted).abs();
                let off = off.min(period - off);
                assert!(off < 1e-13 * period, "{i}: {found} for {wanted}");
            }
        }
    }
}
