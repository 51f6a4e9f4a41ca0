//! Volume, inertia and pose of a body of a case at rest.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Quaternion, Rotation2, UnitQuaternion, UnitVector3, Vector3};

use crate::body::{Inertia, Pose};
use crate::case::{Body, Geometry, Orientation, ShapeSpec};
use crate::coupling::second_moments;
use crate::simulation::RunError;

/// A body of unit density, and where it is.
pub(super) struct Solid {
    /// Volume and second moments about the centroid (m3, m5; m2, m4 planar).
    pub volume: Inertia,
    /// Centroid in the world, and orientation.
    pub pose: Pose,
}

impl Solid {
    /// That of a body at time zero.
    pub fn of(body: &Body, geometry: Geometry) -> Result<Self, RunError> {
        match geometry {
            Geometry::Planar | Geometry::Axisymmetric => Self::in_plane(body),
            Geometry::Spatial => Self::in_space(body),
        }
    }

    fn in_plane(body: &Body) -> Result<Self, RunError> {
        let moments = body.shape.outline().moments().ok_or_else(|| {
            RunError::Unsupported(format!("body `{}`: its spline has no valid outline", body.name))
        })?;
        let volume = Inertia { mass: moments.measure, tensor: second_moments(&moments) };
        // The centre of mass of a spline is not the origin of its points
        let offset = Rotation2::new(body.angle) * moments.centroid;
        let pose = Pose::planar(body.center[0] + offset[0], body.center[1] + offset[1], body.angle);
        // Angles count turns from within (-pi, pi]
        Ok(Self { volume, pose: Pose::planar(pose.center.x, pose.center.y, pose.heading()) })
    }

    fn in_space(body: &Body) -> Result<Self, RunError> {
        let volume = match (&body.shape, body.shape.semi_axes()) {
            (_, Some(semi_axes)) => ellipsoid(semi_axes),
            (ShapeSpec::Capsule { length, radius }, None) => capsule(*length, *radius),
            (ShapeSpec::Cylinder { radius, axis, length }, None) => {
                cylinder(*length, *radius, axis.index())
            }
            (_, None) => return Err(no_solid(body)),
        };
        let center = Vector3::from_fn(|axis, _| body.center.get(axis).copied().unwrap_or(0.0));
        Ok(Self { volume, pose: Pose::spatial(center, rotation(body.orientation.as_ref())) })
    }
}

/// A body with a planar shape, where one in space is wanted.
pub(in crate::simulation) fn no_solid(body: &Body) -> RunError {
    let (name, shape) = (&body.name, body.shape.name());
    RunError::Unsupported(format!("body `{name}`: a {shape} is planar"))
}

/// Rotation from the body frame to the world.
pub(in crate::simulation) fn rotation(orientation: Option<&Orientation>) -> UnitQuaternion<f64> {
    match orientation {
        None => UnitQuaternion::identity(),
        Some(Orientation::Turned { axis, angle }) => {
            let axis = UnitVector3::new_normalize(Vector3::from(*axis));
            UnitQuaternion::from_axis_angle(&axis, *angle)
        }
        Some(Orientation::Quaternion([w, x, y, z])) => {
            UnitQuaternion::from_quaternion(Quaternion::new(*w, *x, *y, *z))
        }
        Some(Orientation::Along(direction)) => {
            // Opposite directions leave the axis open: about z
            let half_turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), PI);
            UnitQuaternion::rotation_between(&Vector3::x(), &Vector3::from(*direction))
                .unwrap_or(half_turn)
        }
    }
}

/// An ellipsoid of unit density: m (b^2 + c^2) / 5 about its first axis.
fn ellipsoid([a, b, c]: [f64; 3]) -> Inertia {
    let mass = 4.0 / 3.0 * PI * a * b * c;
    let [a, b, c] = [a * a, b * b, c * c];
    let diagonal = Vector3::new(b + c, c + a, a + b) * (mass / 5.0);
    Inertia { mass, tensor: Matrix3::from_diagonal(&diagonal) }
}

/// A cylinder about a coordinate, of unit density.
fn cylinder(length: f64, radius: f64, axis: usize) -> Inertia {
    let mass = PI * radius * radius * length;
    let across = mass * (radius * radius / 4.0 + length * length / 12.0);
    let mut diagonal = Vector3::repeat(across);
    diagonal[axis] = mass * radius * radius / 2.0;
    Inertia { mass, tensor: Matrix3::from_diagonal(&diagonal) }
}

/// A cylinder about x with half spheres at its ends, of unit density.
fn capsule(length: f64, radius: f64) -> Inertia {
    let straight = length - 2.0 * radius;
    let square = radius * radius;
    let (cylinder, ends) = (PI * square * straight, 4.0 / 3.0 * PI * square * radius);
    let along = cylinder * square / 2.0 + ends * square * 2.0 / 5.0;
    // Each half sphere has its centroid 3/8 of the radius beyond the end of the cylinder
    let lever = straight / 2.0 + 3.0 / 8.0 * radius;
    let of_ends = ends * (square * (2.0 / 5.0 - 9.0 / 64.0) + lever * lever);
    let across = cylinder * (square / 4.0 + straight * straight / 12.0) + of_ends;
    let diagonal = Vector3::new(along, across, across);
    Inertia { mass: cylinder + ends, tensor: Matrix3::from_diagonal(&diagonal) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume and second moments about x and y of a body of revolution about x, by summing slices.
    fn by_slices(radius_at: impl Fn(f64) -> f64, reach: f64) -> [f64; 3] {
        let n = 200_000;
        let width = 2.0 * reach / f64::from(n);
        let (mut volume, mut along, mut across) = (0.0, 0.0, 0.0);
        for slice in 0..n {
            let x = -reach + (f64::from(slice) + 0.5) * width;
            let square = radius_at(x).powi(2);
            let part = PI * square * width;
            volume += part;
            along += part * square / 2.0;
            across += part * (square / 4.0 + x * x);
        }
        [volume, along, across]
    }

    #[test]
    fn volumes_and_inertia_are_those_of_slices() {
        let (length, radius) = (5.0, 0.7);
        let cap = |x: f64| {
            let beyond = (x.abs() - (length / 2.0 - radius)).max(0.0);
            (radius * radius - beyond * beyond).max(0.0).sqrt()
        };
        let spheroid = |x: f64| 0.4 * (1.0 - (x / 1.3).powi(2)).max(0.0).sqrt();
        for (solid, slices) in [
            (capsule(length, radius), by_slices(cap, length / 2.0)),
            (ellipsoid([1.3, 0.4, 0.4]), by_slices(spheroid, 1.3)),
            (cylinder(3.0, 0.4, 0), by_slices(|_| 0.4, 1.5)),
        ] {
            let own = [solid.mass, solid.tensor[(0, 0)], solid.tensor[(1, 1)]];
            for (own, sum) in own.iter().zip(slices) {
                assert!((own / sum - 1.0).abs() < 1e-8, "{own} {sum}");
            }
        }
    }

    #[test]
    fn orientations_turn_the_axis_of_the_body() {
        let ahead = |orientation| rotation(Some(&orientation)) * Vector3::x();
        let turned = Orientation::Turned { axis: [0.0, 0.0, 2.0], angle: PI / 2.0 };
        assert!((ahead(turned) - Vector3::y()).norm() < 1e-15);
        let quarter = (PI / 4.0).sin_cos();
        let quaternion = Orientation::Quaternion([quarter.1, 0.0, quarter.0, 0.0]);
        assert!((ahead(quaternion) + Vector3::z()).norm() < 1e-15);
        for along in [[1.0, 2.0, -2.0], [-3.0, 0.0, 0.0]] {
            let direction = Vector3::from(along).normalize();
            assert!((ahead(Orientation::Along(along)) - direction).norm() < 1e-15);
        }
    }
}
