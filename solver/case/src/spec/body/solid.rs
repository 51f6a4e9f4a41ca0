//! Domain and bodies of a case in three dimensions, as they are meshed.

use std::f64::consts::PI;
use std::sync::Arc;

use alewife_mesh::spatial::{Body as SolidBody, Centreline, Domain, Part, Shape, Slender};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, UnitVector3, Vector3};

use crate::{Body, BoundaryCondition, Case, DomainSpec, HelixShape, Orientation, ShapeSpec};

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
            DomainSpec::Mesh(_) | DomainSpec::Surface(_) => {
                self.given_mesh()?.around_bodies().cloned().map(Domain::Imported)
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
        Some(SolidBody {
            name: self.name.clone(),
            parts: self.shape.parts()?,
            pose: self.pose_in_space(),
            size: self.size.map(|size| scale * size),
        })
    }

    /// Place of the body frame in three dimensions (m).
    #[must_use]
    pub fn pose_in_space(&self) -> Isometry3<f64> {
        let center = Vector3::from_fn(|axis, _| self.center.get(axis).copied().unwrap_or(f64::NAN));
        place(center, self.orientation.as_ref())
    }
}

/// A place (m) with an orientation, if there is one.
fn place(center: Vector3<f64>, orientation: Option<&Orientation>) -> Isometry3<f64> {
    let rotation = orientation.map_or_else(UnitQuaternion::identity, Orientation::rotation);
    Isometry3::from_parts(Translation3::from(center), rotation)
}

impl ShapeSpec {
    /// The solids it is made of, in the frame of the body (m); `None` of a planar shape.
    #[must_use]
    pub fn parts(&self) -> Option<Vec<Part>> {
        let one = |shape| Some(vec![Part { shape, pose: Isometry3::identity() }]);
        match self {
            Self::Sphere { radius } => one(Shape::Sphere { radius: *radius }),
            Self::Capsule { length, radius } => {
                one(Shape::Capsule { radius: *radius, length: length - 2.0 * radius })
            }
            Self::Cylinder { radius, axis, .. } => {
                let mut along = [0.0; 3];
                along[axis.index()] = 1.0;
                let pose = place(Vector3::zeros(), Some(&Orientation::Along(along)));
                Some(vec![Part { shape: Shape::Cylinder { radius: *radius }, pose }])
            }
            Self::Helix(HelixShape { radius, pitch, turns, tube_radius }) => {
                let centreline =
                    Centreline::Helix { radius: *radius, pitch: *pitch, turns: *turns };
                one(Shape::Tube { centreline, radius: *tube_radius })
            }
            Self::Curve(curve) => {
                let centreline = Centreline::Spline(curve.spline()?);
                one(Shape::Tube { centreline, radius: curve.tube_radius })
            }
            Self::Side(hole) => one(Shape::Triangulated(Arc::clone(hole.solid()?))),
            Self::Revolved { profile } => one(Shape::Revolved { profile: profile.clone() }),
            Self::Fish(_) | Self::Flagellate(_) => {
                one(Shape::Slender(Arc::new(Slender::new(self.sections()?))))
            }
            Self::Surface(surface) => one(Shape::Triangulated(Arc::clone(surface.solid()?))),
            Self::Union(parts) => {
                let mut all = Vec::new();
                for part in parts {
                    let pose = place(part.center.into(), part.orientation.as_ref());
                    let own = part.shape.parts()?.into_iter();
                    all.extend(
                        own.map(|Part { shape, pose: own }| Part { shape, pose: pose * own }),
                    );
                }
                Some(all)
            }
            other => one(Shape::Ellipsoid { semi_axes: other.semi_axes()? }),
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
