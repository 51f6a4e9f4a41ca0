//! `Shape`: disc, sphere, ellipse, spheroid, closed spline, polygon; boundary curve and mass moments.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::Matrix3;

use crate::planar::vector::cross;
use crate::quadrature::integrate;
use crate::{MeshError, Point, Spline};

/// The outline of a body in its own frame, centred on the origin before placement.
///
/// In an axisymmetric domain the shapes are `Sphere`, `Spheroid` and `Revolved`; their meridian
/// (y >= 0) is meshed. In a planar domain they are `Disc`, `Ellipse`, `Spline`, `Polygon` and `Curve`.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Disc of the given radius (planar).
    Disc {
        /// Radius (m).
        radius: f64,
    },
    /// Ellipse with semi-axes along the body's x and y (planar).
    Ellipse {
        /// Semi-axes (m).
        semi_axes: [f64; 2],
    },
    /// Closed smooth spline through points listed counter-clockwise (planar).
    Spline {
        /// Points in the body frame (m), not repeated at the end.
        points: Vec<[f64; 2]>,
    },
    /// Polygon with sharp corners listed counter-clockwise (planar).
    Polygon {
        /// Corners in the body frame (m), the first not repeated at the end.
        points: Vec<[f64; 2]>,
    },
    /// Closed smooth curve with a parameter of its own, counter-clockwise (planar): the outline of
    /// a body that deforms, whose parameter is a material point.
    Curve {
        /// Spline in the body frame (m).
        spline: Arc<Spline>,
    },
    /// Sphere of the given radius, centred on the axis (axisymmetric) or anywhere (3D).
    Sphere {
        /// Radius (m).
        radius: f64,
    },
    /// Ellipsoid of revolution: semi-axis along the axis of revolution, and across it.
    Spheroid {
        /// Semi-axes (m): along the axis of revolution, across it.
        semi_axes: [f64; 2],
    },
    /// A profile turned about the x axis, which it crosses at right angles: a smooth curve through points
    /// (axisymmetric).
    Revolved {
        /// Points (x, distance from the axis) in the body frame (m), the first and the last on the axis.
        profile: Vec<[f64; 2]>,
    },
}

/// A profile, (x, distance from the axis) (m), and back along its mirror image in the axis: points of a closed
/// curve.
///
/// # Errors
/// [`MeshError::Body`] where the profile does not run from axis to axis.
pub(crate) fn closed_profile(body: &str, profile: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, MeshError> {
    let refuse =
        |what, value, wanted| Err(MeshError::Body { body: body.to_owned(), what, value, wanted });
    let [first, between @ .., last] = profile else {
        return refuse("number of points", profile.len() as f64, "three or more");
    };
    if let Some([_, off]) = [first, last].into_iter().find(|end| end[1] != 0.0) {
        return refuse("distance of the ends of the profile from the axis", *off, "0");
    }
    if let Some([_, off]) = between.iter().find(|point| point[1].is_nan() || point[1] <= 0.0) {
        return refuse("distance of the profile from the axis", *off, "positive");
    }
    let mut points = profile.to_vec();
    points.extend(between.iter().rev().map(|[x, off]| [*x, -off]));
    Ok(points)
}

/// The curve through a profile and its mirror image: counter-clockwise, its parameter 0 at the right end.
///
/// # Errors
/// [`MeshError::Body`] where the profile does not run from axis to axis, or no curve goes through its points.
pub(super) fn meridian(body: &str, profile: &[[f64; 2]]) -> Result<Spline, MeshError> {
    let mut from_right = profile.to_vec();
    if profile.first().map(|end| end[0]) < profile.last().map(|end| end[0]) {
        from_right.reverse();
    }
    Spline::through(&closed_profile(body, &from_right)?).ok_or_else(|| MeshError::Body {
        body: body.to_owned(),
        what: "number of points",
        value: profile.len() as f64,
        wanted: "three or more, finite, no two neighbours equal",
    })
}

/// A shape put in its place in the domain.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedShape {
    /// Name of the body; the boundary it makes carries it.
    pub name: String,
    /// Outline.
    pub shape: Shape,
    /// Position of the shape's origin (m).
    pub center: Point<2>,
    /// Rotation of the body frame, counter-clockwise (rad).
    pub angle: f64,
    /// Wanted cell size on the surface (m); `None` takes [`crate::Sizing::surface`].
    pub size: Option<f64>,
}

/// What a body weighs and how it resists turning, per unit of density, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Area (m^2, planar) or volume (m^3, axisymmetric).
    pub measure: f64,
    /// Centre of area or volume in the body frame (m); splines and polygons may have it off their origin.
    pub centroid: Point<2>,
    /// Second moments about the centroid.
    pub second: SecondMoments,
}

/// Second moments about the centroid, per unit of density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SecondMoments {
    /// Of a planar body.
    Planar {
        /// ∫ |x - centroid|² dA (m^4).
        polar: f64,
    },
    /// Of a body of revolution.
    Revolved {
        /// ∫ (distance from the axis of revolution)² dV (m^5).
        along: f64,
        /// The same about any axis through the centroid across it (m^5).
        across: f64,
    },
    /// Of a body in space.
    Spatial {
        /// Tensor of inertia about the centroid (m^5).
        tensor: Matrix3<f64>,
    },
}

impl Shape {
    /// Area or volume, centroid and second moments; `None` for a spline, polygon or profile
    /// without valid points.
    #[must_use]
    pub fn moments(&self) -> Option<Moments> {
        match self {
            Self::Disc { radius } => Some(planar_ellipse([*radius; 2])),
            Self::Ellipse { semi_axes } => Some(planar_ellipse(*semi_axes)),
            Self::Spline { points } => Spline::through(points).map(|s| spline_moments(&s)),
            Self::Polygon { points } => polygon_moments(points),
            Self::Curve { spline } => Some(spline_moments(spline)),
            Self::Sphere { radius } => Some(ellipsoid([*radius; 2])),
            Self::Spheroid { semi_axes } => Some(ellipsoid(*semi_axes)),
            Self::Revolved { profile } => {
                let spline = meridian("", profile).ok()?;
                Some(revolved_moments(&spline))
            }
        }
    }
}

fn planar_ellipse([a, b]: [f64; 2]) -> Moments {
    let area = PI * a * b;
    let second = SecondMoments::Planar { polar: area * (a * a + b * b) / 4.0 };
    Moments { measure: area, centroid: Point::<2>::zeros(), second }
}

fn ellipsoid([a, b]: [f64; 2]) -> Moments {
    let volume = 4.0 / 3.0 * PI * a * b * b;
    let second = SecondMoments::Revolved {
        along: volume * 2.0 * b * b / 5.0,
        across: volume * (a * a + b * b) / 5.0,
    };
    Moments { measure: volume, centroid: Point::<2>::zeros(), second }
}

/// By Green's theorem: ∫ |x|^k dA = ∮ |x|^k (x dy - y dx) / (k + 2), exact for cubic pieces.
fn spline_moments(spline: &Spline) -> Moments {
    let around = |f: &dyn Fn(Point<2>) -> f64| -> f64 {
        let pieces = spline.knots().windows(2);
        pieces
            .map(|k| {
                integrate(k[0], k[1], |s| {
                    let [at, rate, _] = spline.evaluate(s.min(k[1].next_down()));
                    f(at) * cross(at, rate)
                })
            })
            .sum()
    };
    let area = around(&|_| 0.5);
    let centroid = Point::<2>::new(around(&|x| x.x / 3.0), around(&|x| x.y / 3.0)) / area;
    let about_origin = around(&|x| x.norm_squared() / 4.0);
    let polar = about_origin - area * centroid.norm_squared();
    Moments { measure: area, centroid, second: SecondMoments::Planar { polar } }
}

/// Of a closed profile turned about the x axis, by slices across it: half the sum over both halves of
/// the curve, of which the lower one runs the other way on the other side.
fn revolved_moments(spline: &Spline) -> Moments {
    let along_axis = |f: &dyn Fn(Point<2>) -> f64| -> f64 {
        let pieces = spline.knots().windows(2);
        let slices = pieces.map(|k| {
            integrate(k[0], k[1], |s| {
                let [at, rate, _] = spline.evaluate(s.min(k[1].next_down()));
                -PI * f(at) * at.y.abs() * at.y * rate.x
            })
        });
        0.5 * slices.sum::<f64>()
    };
    let volume = along_axis(&|_| 1.0);
    let centroid = along_axis(&|x| x.x) / volume;
    // A slice of radius r has r^4 pi/2 about the axis, and half of it about its diameters
    let along = along_axis(&|x| 0.5 * x.y * x.y);
    let about_origin = along_axis(&|x| 0.25 * x.y * x.y + x.x * x.x);
    let across = about_origin - volume * centroid * centroid;
    Moments {
        measure: volume,
        centroid: Point::<2>::new(centroid, 0.0),
        second: SecondMoments::Revolved { along, across },
    }
}

/// By Green's theorem, side by side: exact. About the first corner, for the sake of rounding.
fn polygon_moments(points: &[[f64; 2]]) -> Option<Moments> {
    let start = Point::from(*points.first()?);
    let (mut area, mut first, mut polar) = (0.0, Point::<2>::zeros(), 0.0);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|point| Point::from(point) - start);
        let twice = cross(a, b);
        area += twice / 2.0;
        first += (a + b) * (twice / 6.0);
        polar += twice / 12.0 * (a.norm_squared() + a.dot(&b) + b.norm_squared());
    }
    if area.is_nan() || area <= 0.0 {
        return None;
    }
    let centroid = first / area;
    let polar = polar - area * centroid.norm_squared();
    let second = SecondMoments::Planar { polar };
    Some(Moments { measure: area, centroid: start + centroid, second })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spline through 64 points of an ellipse is off by its fourth-order error only.
    #[test]
    fn a_spline_through_an_ellipse_has_the_moments_of_the_ellipse() {
        let shift = [0.4, -0.3];
        let points: Vec<[f64; 2]> = (0..64)
            .map(|i| 2.0 * PI * f64::from(i) / 64.0)
            .map(|t| [2.0 * t.cos() + shift[0], t.sin() + shift[1]])
            .collect();
        let spline = Shape::Spline { points }.moments().unwrap();
        let exact = Shape::Ellipse { semi_axes: [2.0, 1.0] }.moments().unwrap();
        assert!((spline.measure / exact.measure - 1.0).abs() < 1e-5);
        assert!((spline.centroid - Point::from(shift)).norm() < 1e-5);
        let polar = |m: Moments| match m.second {
            SecondMoments::Planar { polar } => polar,
            _ => panic!("is planar"),
        };
        assert!((polar(spline) / polar(exact) - 1.0).abs() < 1e-5);
    }

    /// As above, turned about the axis.
    #[test]
    fn a_revolved_ellipse_has_the_moments_of_the_spheroid() {
        let shift = 0.4;
        let between = (1..32).map(|i| PI * f64::from(i) / 32.0);
        let mut profile = vec![[shift - 2.0, 0.0]];
        profile.extend(between.map(|t| [shift - 2.0 * t.cos(), t.sin()]));
        profile.push([shift + 2.0, 0.0]);
        let revolved = Shape::Revolved { profile }.moments().unwrap();
        let exact = Shape::Spheroid { semi_axes: [2.0, 1.0] }.moments().unwrap();
        assert!((revolved.measure / exact.measure - 1.0).abs() < 1e-5, "{revolved:?}");
        assert!((revolved.centroid - Point::<2>::new(shift, 0.0)).norm() < 1e-5, "{revolved:?}");
        let second = |m: Moments| match m.second {
            SecondMoments::Revolved { along, across } => [along, across],
            _ => panic!("is turned"),
        };
        for (one, other) in second(revolved).into_iter().zip(second(exact)) {
            assert!((one / other - 1.0).abs() < 2e-5, "{one} {other}");
        }
    }

    #[test]
    fn a_rectangle_anywhere_and_a_hollow_polygon_have_the_moments_of_formulas() {
        let (a, b) = (3.0, 0.5);
        let at = |x: f64, y: f64| [7.0 + x * 0.8 - y * 0.6, -2.0 + x * 0.6 + y * 0.8];
        let points = vec![at(0.0, 0.0), at(a, 0.0), at(a, b), at(0.0, b)];
        let moments = Shape::Polygon { points }.moments().unwrap();
        assert!((moments.measure - a * b).abs() < 1e-13);
        assert!((moments.centroid - Point::from(at(a / 2.0, b / 2.0))).norm() < 1e-13);
        let SecondMoments::Planar { polar } = moments.second else { panic!("is planar") };
        assert!((polar / (a * b * (a * a + b * b) / 12.0) - 1.0).abs() < 1e-12);
        // A square of side 2 with a notch of 1 by 1 at its corner
        let notched = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let moments = Shape::Polygon { points: notched.to_vec() }.moments().unwrap();
        assert!((moments.measure - 3.0).abs() < 1e-14);
        let center = (4.0 * 1.0 - 1.5) / 3.0;
        assert!((moments.centroid - Point::<2>::repeat(center)).norm() < 1e-14);
        let clockwise: Vec<[f64; 2]> = notched.iter().rev().copied().collect();
        assert_eq!(Shape::Polygon { points: clockwise }.moments(), None);
    }

    #[test]
    fn a_sphere_has_two_fifths_of_m_r_squared_about_every_axis() {
        let moments = Shape::Sphere { radius: 2.0 }.moments().unwrap();
        let expected = 0.4 * moments.measure * 4.0;
        let SecondMoments::Revolved { along, across } = moments.second else { panic!("is 3D") };
        assert!((along - expected).abs() < 1e-12 && (across - expected).abs() < 1e-12);
    }
}
