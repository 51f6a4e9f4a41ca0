//! `Revolved`: the surface a planar profile makes when it is turned about the x axis.

use super::Foot;
use crate::planar::closed_profile;
use crate::{MeshError, Outline, PlacedShape, Point, Shape, thickness};

/// Distance from the axis over the size of the profile, below which a point counts as on the axis.
const ON_AXIS: f64 = 1e-9;

/// A surface of revolution about the x axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Revolved {
    /// The profile and its mirror image in the axis, one closed curve.
    outline: Outline,
}

impl Revolved {
    /// The surface through points (x, distance from the axis) of a profile (m), the first and the last
    /// on the axis, where the surface crosses it at a right angle.
    ///
    /// # Errors
    /// [`MeshError::Body`] where the profile does not run from axis to axis, and what
    /// [`Outline::new`] refuses.
    pub fn new(body: &str, profile: &[[f64; 2]]) -> Result<Self, MeshError> {
        let mut points = closed_profile(body, profile)?;
        if profile.first().map(|end| end[0]) < profile.last().map(|end| end[0]) {
            // Counter-clockwise
            points.reverse();
        }
        let outline = Outline::new(&PlacedShape {
            name: body.to_owned(),
            shape: Shape::Spline { points },
            center: Point::<2>::zeros(),
            angle: 0.0,
            size: None,
        })?;
        Ok(Self { outline })
    }

    /// Radius of a ball about the origin that holds the surface (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.outline.reach()
    }

    /// Radius (m) of a ball within it: half the width of its profile where that is thinnest.
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        0.5 * thickness(&self.outline)
    }

    /// The nearest point to a point (m) of its frame, the normal outward.
    #[must_use]
    pub fn foot(&self, of: Point<3>) -> Foot {
        let off = of.y.hypot(of.z);
        let is_on_axis = off <= ON_AXIS * self.reach();
        let outward =
            if is_on_axis { Point::<3>::y() } else { Point::<3>::new(0.0, of.y / off, of.z / off) };
        let near = self.outline.nearest(Point::<2>::new(of.x, off));
        // The image of a point is as near
        let side = if near.point.y < 0.0 { -1.0 } else { 1.0 };
        let revolve = |x: Point<2>| Point::<3>::x() * x.x + outward * (side * x.y);
        Foot { point: revolve(near.point), normal: revolve(near.normal), gap: near.gap }
    }

    /// Smallest radius of curvature (m) at one of its points: along the profile or around the axis.
    #[must_use]
    pub fn radius_of_curvature(&self, on: Point<3>) -> f64 {
        let off = on.y.hypot(on.z);
        let near = self.outline.nearest(Point::<2>::new(on.x, off));
        let along = 1.0 / near.curvature.abs();
        let across = off / near.normal.y.abs();
        // On the axis both are the same
        if off <= ON_AXIS * self.reach() { along } else { along.min(across) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::surface::Ellipsoid;

    /// A profile through points of a spheroid, off by the error of the spline.
    #[test]
    fn a_revolved_ellipse_is_a_spheroid() {
        let profile: Vec<[f64; 2]> = (0..=60)
            .map(|i| std::f64::consts::PI * f64::from(i) / 60.0)
            .map(|t| [-t.cos(), 0.5 * t.sin()])
            .collect();
        let profile = [&[[-1.0, 0.0]], &profile[1..60], &[[1.0, 0.0]]].concat();
        let revolved = Revolved::new("a", &profile).unwrap();
        let spheroid = Ellipsoid::new([1.0, 0.5, 0.5]);
        for of in [[1.5, 0.2, 0.3], [-0.3, 0.1, -0.9], [2.0, 0.0, 0.0], [0.5, 0.3, 0.1]] {
            let of = Point::from(of);
            let (one, other) = (revolved.foot(of), spheroid.foot(of));
            assert!((one.point - other.point).norm() < 1e-4, "{one:?} {other:?}");
            assert!((one.normal - other.normal).norm() < 1e-3);
            let radii = [
                revolved.radius_of_curvature(one.point),
                spheroid.radius_of_curvature(other.point),
            ];
            assert!((radii[0] / radii[1] - 1.0).abs() < 1e-2, "{radii:?}");
        }
    }

    #[test]
    fn profiles_off_the_axis_are_refused() {
        for profile in [
            vec![],
            vec![[0.0; 2]],
            vec![[0.0; 2], [1.0, 0.0]],
            vec![[0.0, 0.1], [1.0, 0.5], [2.0, 0.0]],
            vec![[0.0; 2], [1.0, -0.5], [2.0, 0.0]],
        ] {
            assert!(matches!(Revolved::new("a", &profile), Err(MeshError::Body { .. })));
        }
    }
}
