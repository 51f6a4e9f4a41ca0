//! How a smooth surface bends, and how thick what it encloses is.

use nalgebra::Matrix3;

use super::{Form, SmoothSurface};
use crate::Point;

/// Step of finite differences over the radius of curvature.
const CURVATURE_STEP: f64 = 1e-4;

impl SmoothSurface {
    /// Smallest radius of curvature of the surface at one of its points (m).
    #[must_use]
    pub fn radius_of_curvature(&self, on: Point<3>) -> f64 {
        match &self.form {
            Form::Plane | Form::Facets(_) => f64::INFINITY,
            Form::Sheet(sheet) => sheet.nearest(on).radius,
            Form::Sphere(radius) | Form::Cylinder(radius) | Form::Capsule { radius, .. } => *radius,
            Form::Tube(tube) => tube.radius(),
            Form::Ellipsoid(ellipsoid) => ellipsoid.radius_of_curvature(self.to_local(on)),
            Form::Revolved(revolved) => revolved.radius_of_curvature(self.to_local(on)),
            Form::Slender(slender) => slender.radius_of_curvature(self.to_local(on)),
            Form::Triangulated(triangles) => triangles.bent_foot(self.to_local(on)).bend.radius,
        }
    }

    /// Radius (m) of the largest ball inside that touches the surface at one of its points, where that
    /// can be less than the radius of curvature.
    pub(super) fn radius_inside(&self, on: Point<3>) -> f64 {
        match &self.form {
            Form::Ellipsoid(ellipsoid) => ellipsoid.radius_inside(self.to_local(on)),
            Form::Slender(slender) => slender.radius_inside(self.to_local(on)),
            Form::Triangulated(triangles) => triangles.bent_foot(self.to_local(on)).bend.inside,
            _ => f64::INFINITY,
        }
    }

    /// Radius (m) of a ball within the solid: of the largest one, but for surfaces of revolution.
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        match &self.form {
            Form::Plane | Form::Facets(_) | Form::Sheet(_) => f64::INFINITY,
            Form::Sphere(radius) | Form::Cylinder(radius) | Form::Capsule { radius, .. } => *radius,
            Form::Tube(tube) => tube.radius(),
            Form::Ellipsoid(ellipsoid) => ellipsoid.inner_radius(),
            Form::Revolved(revolved) => revolved.inner_radius(),
            Form::Slender(slender) => slender.inner_radius(),
            Form::Triangulated(triangles) => triangles.inner_radius(),
        }
    }

    /// Whether what is enclosed is convex.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        match &self.form {
            Form::Plane
            | Form::Sphere(_)
            | Form::Cylinder(_)
            | Form::Capsule { .. }
            | Form::Ellipsoid(_) => true,
            Form::Tube(_)
            | Form::Revolved(_)
            | Form::Slender(_)
            | Form::Triangulated(_)
            | Form::Facets(_)
            | Form::Sheet(_) => false,
        }
    }

    /// The derivative of the unit normal along the surface at one of its points (1/m): symmetric, zero along
    /// the normal, positive where the solid is convex.
    #[must_use]
    pub fn curvature(&self, on: Point<3>) -> Matrix3<f64> {
        if let Form::Facets(facets) = &self.form {
            return facets.curvature(on);
        }
        let normal = self.foot(on).normal;
        let along = Matrix3::identity() - normal * normal.transpose();
        if self.is_flat() {
            return Matrix3::zeros();
        }
        if let Form::Sphere(radius) = self.form {
            return along * (if self.is_hollow { -1.0 } else { 1.0 } / radius);
        }
        let mut step = CURVATURE_STEP * self.radius_of_curvature(on).min(self.scale());
        if let Form::Triangulated(triangles) = &self.form {
            // From one triangle to the next, whose normals differ a little where they meet
            step = triangles.bent_foot(self.to_local(on)).bend.edge;
        }
        let mut derivative = Matrix3::zeros();
        for axis in 0..3 {
            let way: Point<3> = along.column(axis) * step;
            let change = self.foot(on + way).normal - self.foot(on - way).normal;
            derivative.set_column(axis, &(change / (2.0 * step)));
        }
        let projected = along * derivative * along;
        (projected + projected.transpose()) * 0.5
    }
}
