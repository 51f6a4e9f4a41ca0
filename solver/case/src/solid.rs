//! Domain and bodies of a case in three dimensions, as they are meshed.

use std::f64::consts::PI;

use alewife_mesh::spatial::{Body as SolidBody, Domain, Shape};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, UnitVector3, Vector3};

use super::{Body, BoundaryCondition, Case, DomainSpec, Orientation, ShapeSpec};

impl Orientation {
    /// Rotation from the body frame to the world.
    #[must_use]
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        match self {
            Self::Turned { axis, angle } => {
                let axis = UnitVector3::new_normalize(Vector3::from(*axis));
                UnitQuaternion::from_axis_angle(&axis, *angle)
            }
            Self::Quaternion([w, x, y, z]) => {
                UnitQuaternion::from_quaternion(Quaternion::new(*w, *x, *y, *z))
            }
            Self::Along(direction) => {
                // Opposite directions leave the axis open: about z
                let half_turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), PI);
                UnitQuaternion::rotation_between(&Vector3::x(), &Vector3::from(*direction))
                    .unwrap_or(half_turn)
            }
        }
    }
}

impl Case {
    /// The domain to be meshed in three dimensions; `None` of planar ones.
    #[must_use]
    pub fn domain_in_space(&self) -> Option<Domain> {
        match &self.domain {
            DomainSpec::Box { .. } => {
                let extent = self.extent();
                let is_mirror = |side: &&str| {
                    matches!(self.boundary.get(*side), Some(BoundaryCondition::Symmetry))
                };
                let mut symmetric = [false; 6];
                for (nth, side) in self.sides().iter().enumerate() {
                    symmetric[nth] = is_mirror(side);
                }
                Some(Domain::Box {
                    min: extent.min.into(),
                    max: extent.max.into(),
                    periodic: self.periodic_axes(),
                    symmetric,
                })
            }
            DomainSpec::Cylinder { x, radius } => Some(Domain::Cylinder { x: *x, radius: *radius }),
            DomainSpec::Sphere { center, radius } => {
                Some(Domain::Ball { center: (*center).into(), radius: *radius })
            }
            DomainSpec::Channel { .. } | DomainSpec::Disc { .. } | DomainSpec::HalfDisc { .. } => {
                None
            }
        }
    }
}

impl Body {
    /// The body as a mesh in space sees it; `None` of a planar shape.
    #[must_use]
    pub fn solid(&self, scale: f64) -> Option<SolidBody> {
        let size = self.size.map(|size| scale * size);
        let shape = self.shape.in_space()?;
        Some(SolidBody { size, ..SolidBody::new(&self.name, shape, self.pose_in_space()) })
    }

    /// Place of the body frame in three dimensions (m).
    #[must_use]
    pub fn pose_in_space(&self) -> Isometry3<f64> {
        let center = Vector3::from_fn(|axis, _| self.center.get(axis).copied().unwrap_or(f64::NAN));
        let rotation = self
            .orientation
            .as_ref()
            .map_or(UnitQuaternion::identity(), |orientation| orientation.rotation());
        Isometry3::from_parts(Translation3::from(center), rotation)
    }
}

impl ShapeSpec {
    /// The solid to be meshed; `None` of a planar shape.
    fn in_space(&self) -> Option<Shape> {
        match self {
            Self::Sphere { radius } => Some(Shape::Sphere { radius: *radius }),
            Self::Capsule { length, radius } => {
                Some(Shape::Capsule { radius: *radius, length: length - 2.0 * radius })
            }
            other => Some(Shape::Ellipsoid { semi_axes: other.semi_axes()? }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientations_turn_the_axis_of_the_body() {
        let ahead = |orientation: Orientation| orientation.rotation() * Vector3::x();
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
