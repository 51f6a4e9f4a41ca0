//! `Outline`: the closed curve around a placed body, in four quarters or in the sides of a polygon.
//!
//! Quarter k runs counter-clockwise from the extreme point in direction k of the body frame (+x,
//! +y, -x, -y) to the next one, with a parameter in [0, 1]. For an ellipse the parameter is the
//! eccentric angle over π/2. Those of a turned profile begin at its ends, and half way between them.

mod closed_spline;
mod ellipse;
mod foot;
mod polygon;

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use closed_spline::ClosedSpline;
use foot::Foot;
use polygon::Polygon;
pub(super) use polygon::{Corner, stokes_exponent};

use crate::planar::shape::meridian;
use crate::surface::{Surface, SurfacePoint};
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
    Spline(ClosedSpline),
    Polygon(Polygon),
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

impl Outline {
    /// Outline of a body in its place.
    ///
    /// # Errors
    /// [`MeshError::Body`] when a length is not positive or a spline, polygon or profile has no valid points,
    /// [`MeshError::SelfIntersection`] when one crosses itself.
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
                let form = ClosedSpline::new(Arc::new(spline), &body.name)?;
                return Ok(Self::with_form(body.center, body.angle, Form::Spline(form)));
            }
            Shape::Revolved { profile } => {
                let form = ClosedSpline::about_axis(meridian(&body.name, profile)?, &body.name)?;
                return Ok(Self::with_form(body.center, body.angle, Form::Spline(form)));
            }
            Shape::Polygon { points } => {
                let form = Polygon::new(points, &body.name)?;
                return Ok(Self::with_form(body.center, body.angle, Form::Polygon(form)));
            }
            Shape::Curve { spline } => {
                let form = ClosedSpline::new(Arc::clone(spline), &body.name)?;
                return Ok(Self::with_form(body.center, body.angle, Form::Spline(form)));
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
            Form::Spline(form) => form.reach(),
            Form::Polygon(form) => form.reach(),
        };
        Self { center, cos: angle.cos(), sin: angle.sin(), form: Arc::new(form), reach }
    }

    /// The same outline with its origin at `center` (m) and turned by `angle` (rad) from its own
    /// frame; nothing is computed again.
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
    /// chord length of its points (m) unless given; the length of all sides of a polygon (m).
    #[must_use]
    pub fn period(&self) -> f64 {
        match &*self.form {
            Form::Ellipse(_) => TAU,
            Form::Spline(form) => form.spline.period(),
            Form::Polygon(form) => form.perimeter(),
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
            Form::Spline(form) => form.spline.evaluate(parameter),
            Form::Polygon(form) => form.at(parameter),
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
                let foot = ellipse::nearest([*a, *b], local).point;
                (foot.y / b).atan2(foot.x / a)
            }
            Form::Spline(form) => form.parameter_of(local),
            Form::Polygon(form) => form.parameter_of(local),
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
            Form::Spline(form) => form.spline.knots().to_vec(),
            Form::Polygon(form) => form.breaks(),
        }
    }

    /// A lower bound of the gap to a point (m), at no cost.
    #[must_use]
    pub fn least_gap(&self, point: Point<2>) -> f64 {
        (point - self.center).norm() - self.reach
    }

    /// Number of the smooth pieces of [`Self::evaluate`]: four quarters, or the sides of a polygon.
    #[must_use]
    pub fn n_pieces(&self) -> usize {
        match &*self.form {
            Form::Ellipse(_) | Form::Spline(_) => 4,
            Form::Polygon(form) => form.n_sides(),
        }
    }

    /// Point (m), first and second derivative at a parameter in [0, 1] of one of the quarters, or of
    /// the sides of a polygon.
    #[must_use]
    pub fn evaluate(&self, quarter: usize, parameter: f64) -> [Point<2>; 3] {
        let [point, first, second] = match &*self.form {
            Form::Ellipse([a, b]) => {
                let [c, s] = ellipse::cosine_and_sine(quarter, parameter);
                let rate = FRAC_PI_2;
                [
                    Point::<2>::new(a * c, b * s),
                    Point::<2>::new(-a * s, b * c) * rate,
                    Point::<2>::new(-a * c, -b * s) * (rate * rate),
                ]
            }
            Form::Spline(form) => form.evaluate(quarter, parameter),
            Form::Polygon(form) => form.evaluate(quarter, parameter),
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

    /// Whether it has straight sides and corners.
    #[must_use]
    pub fn is_polygon(&self) -> bool {
        matches!(*self.form, Form::Polygon(_))
    }

    /// The corners of a polygon; none of other outlines.
    pub(crate) fn corners(&self) -> Vec<Corner> {
        let Form::Polygon(form) = &*self.form else { return Vec::new() };
        let placed = |corner: Corner| Corner {
            at: self.center + self.turn(corner.at),
            sides: corner.sides.map(|side| self.turn(side)),
            ..corner
        };
        form.corners().map(placed).collect()
    }

    /// The outline with corners that are blunt by a hair, its tangent continuous; `None` where it has no
    /// corners.
    pub(crate) fn blunted(&self) -> Option<Self> {
        let Form::Polygon(form) = &*self.form else { return None };
        Some(Self { form: Arc::new(Form::Polygon(form.blunted())), ..*self })
    }

    /// Distance across the body of a polygon where it is thinnest (m).
    pub(crate) fn thickness_of_polygon(&self) -> Option<f64> {
        let Form::Polygon(form) = &*self.form else { return None };
        Some(form.thickness())
    }

    /// Nearest place on the outline.
    #[must_use]
    pub fn nearest(&self, point: Point<2>) -> Nearest {
        let local = self.to_local(point);
        let Foot { point, normal, curvature } = match &*self.form {
            Form::Ellipse(semi_axes) => ellipse::nearest(*semi_axes, local),
            Form::Spline(form) => form.nearest(local),
            Form::Polygon(form) => form.nearest(local),
        };
        let gap = (local - point).dot(&normal);
        // The foot of the perpendicular makes the offset parallel to the normal
        let gap = gap.signum() * (local - point).norm();
        Nearest { point: self.center + self.turn(point), normal: self.turn(normal), curvature, gap }
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

impl Surface<2> for Outline {
    type Parameter = f64;

    fn center(&self) -> Point<2> {
        self.center
    }

    fn reach(&self) -> f64 {
        self.reach
    }

    fn nearest_point(&self, point: Point<2>) -> SurfacePoint<2> {
        let Nearest { point, normal, gap, .. } = self.nearest(point);
        SurfacePoint { point, normal, gap }
    }

    fn parameter_of(&self, point: Point<2>) -> f64 {
        Self::parameter_of(self, point)
    }

    fn point(&self, parameter: f64) -> SurfacePoint<2> {
        let [point, rate, _] = self.at(parameter);
        SurfacePoint { point, normal: Point::<2>::new(rate.y, -rate.x).normalize(), gap: 0.0 }
    }
}

#[cfg(test)]
mod tests;
