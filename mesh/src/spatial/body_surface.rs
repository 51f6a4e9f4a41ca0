//! `BodySurface`: the surface of a body in its place, the union of its parts.

use nalgebra::Isometry3;

use super::geometry::surfaces_of;
use super::shape::Body;
use super::surface::{Foot, SmoothSurface};
use crate::{MeshError, Point, Surface, SurfacePoint};

/// The surface of a body.
#[derive(Debug, Clone)]
pub struct BodySurface {
    parts: Vec<SmoothSurface>,
    pose: Isometry3<f64>,
    reach: f64,
}

/// Coordinates on the surface of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialPoint {
    /// The part it is on.
    pub part: usize,
    /// Its place in the frame of the body (m).
    pub place: Point<3>,
}

/// A part of a body and a point on it.
struct Nearest {
    part: usize,
    foot: Foot,
}

impl BodySurface {
    /// The surface of a body whose lengths are positive.
    ///
    /// # Errors
    /// [`MeshError::Body`] where it has no parts, or a profile is not one.
    pub fn new(body: &Body) -> Result<Self, MeshError> {
        let parts = surfaces_of(body)?;
        if parts.is_empty() {
            let (what, wanted) = ("number of parts", "at least 1");
            return Err(MeshError::Body { body: body.name.clone(), what, value: 0.0, wanted });
        }
        let center = body.pose.translation.vector;
        let reach = parts.iter().map(|part| (part.origin() - center).norm() + part.reach());
        Ok(Self { reach: reach.fold(0.0, f64::max), parts, pose: body.pose })
    }

    /// The surface with the body in another place (m).
    #[must_use]
    pub fn placed_at(&self, pose: &Isometry3<f64>) -> Self {
        let by = pose * self.pose.inverse();
        let parts = self.parts.iter().map(|part| part.moved(&by)).collect();
        Self { parts, pose: *pose, reach: self.reach }
    }

    /// The smooth surfaces whose union it is.
    #[must_use]
    pub(super) fn parts(&self) -> &[SmoothSurface] {
        &self.parts
    }

    /// About so many places on each of its parts (m), as seen from far away; of a slender body and of triangles all over it.
    #[must_use]
    pub fn places(&self, n: usize) -> Vec<Point<3>> {
        self.parts.iter().flat_map(|part| part.places(n)).collect()
    }

    /// Whether it is a sphere about the origin of the body.
    #[must_use]
    pub fn is_sphere(&self) -> bool {
        let [part] = self.parts.as_slice() else { return false };
        part.is_sphere() && part.origin() == self.pose.translation.vector
    }

    /// Smallest radius of curvature of the surface at its point nearest to another one (m).
    #[must_use]
    pub fn radius_of_curvature(&self, near: Point<3>) -> f64 {
        let Nearest { part, foot } = self.nearest(near);
        self.parts[part].radius_of_curvature(foot.point)
    }

    /// The nearest part and the nearest point on it; outside a union this is the nearest of all.
    fn nearest(&self, point: Point<3>) -> Nearest {
        let mut nearest = Nearest { part: 0, foot: self.parts[0].foot(point) };
        for (index, part) in self.parts.iter().enumerate().skip(1) {
            let foot = part.foot(point);
            if foot.gap < nearest.foot.gap {
                nearest = Nearest { part: index, foot };
            }
        }
        nearest
    }
}

impl Surface<3> for BodySurface {
    type Parameter = MaterialPoint;

    fn center(&self) -> Point<3> {
        self.pose.translation.vector
    }

    fn reach(&self) -> f64 {
        self.reach
    }

    fn nearest_point(&self, point: Point<3>) -> SurfacePoint<3> {
        let Foot { point, normal, gap } = self.nearest(point).foot;
        SurfacePoint { point, normal, gap }
    }

    fn parameter_of(&self, point: Point<3>) -> MaterialPoint {
        let Nearest { part, foot } = self.nearest(point);
        let place = self.pose.rotation.inverse() * (foot.point - self.center());
        MaterialPoint { part, place }
    }

    fn point(&self, parameter: MaterialPoint) -> SurfacePoint<3> {
        let point = self.pose.rotation * parameter.place + self.center();
        let Foot { point, normal, .. } = self.parts[parameter.part].foot(point);
        SurfacePoint { point, normal, gap: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Part, Shape};
    use nalgebra::{Translation3, UnitQuaternion};

    #[test]
    fn coordinates_and_points_are_inverse_to_each_other() {
        let turn = UnitQuaternion::from_euler_angles(0.4, 0.7, -0.3);
        let pose = Isometry3::from_parts(Translation3::new(0.3, 0.1, -0.2), turn);
        let mut body = Body::new("a", Shape::Ellipsoid { semi_axes: [0.8, 0.5, 0.3] }, pose);
        let tail = Shape::Capsule { radius: 0.1, length: 1.0 };
        body.parts.push(Part { shape: tail, pose: Isometry3::translation(1.0, 0.0, 0.0) });
        let surface = BodySurface::new(&body).unwrap();
        for from in [[3.0, 1.0, 0.5], [-2.0, 0.4, 1.0], [0.3, 2.0, -1.0]].map(Point::<3>::from) {
            let near = surface.nearest_point(from);
            let on = surface.point(surface.parameter_of(from));
            assert!((on.point - near.point).norm() < 1e-12 && on.gap == 0.0);
            assert!((on.normal - near.normal).norm() < 1e-12);
            assert!((near.point + near.normal * near.gap - from).norm() < 1e-12);
            assert!(surface.least_gap(from) <= near.gap);
        }
    }
}
