//! Volume, inertia and pose of a body of a case at rest.

use std::f64::consts::PI;

use alewife_mesh::spatial::SectionMoments;
use alewife_mesh::{BoundaryId, Mesh, Point, SideOfBody};
use nalgebra::{Matrix3, Rotation2, Vector3};

use crate::body::{Inertia, Pose};
use crate::case::{Body, Geometry, Model, ShapeSpec};
use crate::coupling::second_moments;
use crate::run::RunError;
use crate::space::{FacetRule, Metric};

/// A body of unit density, and where it is.
pub(super) struct Solid {
    /// Volume and second moments about the centroid (m3, m5; m2, m4 planar).
    pub volume: Inertia,
    /// Centroid in the world, and orientation.
    pub pose: Pose,
}

impl Solid {
    /// That of a body at time zero.
    pub fn of<const D: usize>(
        body: &Body,
        geometry: Geometry,
        mesh: &Mesh<D>,
        boundary: BoundaryId,
    ) -> Result<Self, RunError> {
        match geometry {
            Geometry::Planar | Geometry::Axisymmetric => Self::in_plane(body),
            Geometry::Spatial => Self::in_space(body, || enclosed(mesh, boundary)),
        }
    }

    fn in_plane(body: &Body) -> Result<Self, RunError> {
        let moments = match &body.shape {
            ShapeSpec::Side(hole) => hole.moments(),
            shape => shape.outline().moments(),
        };
        let moments = moments.ok_or_else(|| {
            RunError::Unsupported(format!("body `{}`: its points make no outline", body.name))
        })?;
        let volume = Inertia { mass: moments.measure, tensor: second_moments(&moments) };
        // The centre of mass of a spline is not the origin of its points
        let offset = Rotation2::new(body.angle) * moments.centroid;
        let pose = Pose::planar(body.center[0] + offset[0], body.center[1] + offset[1], body.angle);
        // Angles count turns from within (-pi, pi]
        Ok(Self { volume, pose: Pose::planar(pose.center.x, pose.center.y, pose.heading()) })
    }

    /// Of shapes without a closed form by what their surface in the mesh encloses.
    fn in_space(body: &Body, enclosed: impl FnOnce() -> Enclosed) -> Result<Self, RunError> {
        let place = body.pose_in_space();
        let triangulated = match &body.shape {
            ShapeSpec::Surface(surface) => Some(surface.solid()),
            ShapeSpec::Side(hole) => Some(hole.solid()),
            _ => None,
        };
        if let Some(solid) = triangulated {
            let moments = solid.ok_or_else(|| no_solid(body))?.moments();
            let centroid = place.transform_point(&moments.centroid.into()).coords;
            let volume = Inertia { mass: moments.volume, tensor: moments.inertia };
            return Ok(Self { volume, pose: Pose::spatial(centroid, place.rotation) });
        }
        let has_closed_form = !matches!(
            body.shape,
            ShapeSpec::Helix(_)
                | ShapeSpec::Curve(_)
                | ShapeSpec::Revolved { .. }
                | ShapeSpec::Union(_)
        );
        if !has_closed_form {
            let Enclosed { mass, centroid, tensor } = enclosed();
            let turn = place.rotation.to_rotation_matrix();
            let tensor = turn.transpose() * tensor * turn;
            let pose = Pose::spatial(centroid, place.rotation);
            return Ok(Self { volume: Inertia { mass, tensor }, pose });
        }
        let volume = match (&body.shape, body.shape.semi_axes()) {
            (ShapeSpec::Fish(_) | ShapeSpec::Flagellate(_), None) => {
                sections(body.shape.sections().ok_or_else(|| no_solid(body))?.moments())
            }
            (_, Some(semi_axes)) => ellipsoid(semi_axes),
            (ShapeSpec::Capsule { length, radius }, None) => capsule(*length, *radius),
            (ShapeSpec::Cylinder { radius, axis, length }, None) => {
                cylinder(*length, *radius, axis.index())
            }
            (_, None) => return Err(no_solid(body)),
        };
        Ok(Self { volume, pose: Pose::spatial(place.translation.vector, place.rotation) })
    }
}

/// A body with a planar shape, where one in space is wanted.
pub(in crate::run) fn no_solid(body: &Body) -> RunError {
    let (name, shape) = (&body.name, body.shape.name());
    RunError::Unsupported(format!("body `{name}`: a {shape} is planar"))
}

/// What a closed surface in a mesh encloses, at unit density.
struct Enclosed {
    mass: f64,
    centroid: Vector3<f64>,
    /// Inertia about the centroid, in the axes of the laboratory (m5).
    tensor: Matrix3<f64>,
}

/// Volume and moments of a body by the divergence theorem on its boundary; the normal of the mesh is into
/// the body.
fn enclosed<const D: usize>(mesh: &Mesh<D>, boundary: BoundaryId) -> Enclosed {
    let rule = FacetRule::new(Metric::Cartesian);
    let in_space =
        |vector: &Point<D>| Vector3::from_fn(|axis, _| if axis < D { vector[axis] } else { 0.0 });
    let facets = || mesh.facets.iter().filter(|facet| facet.boundary == boundary);
    // About a point near it, for the sake of rounding
    let near = facets()
        .next()
        .map_or_else(Vector3::zeros, |facet| in_space(&mesh.nodes[mesh.cell(facet.cell)[0]]));
    let (mut mass, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for facet in facets() {
        rule.for_each_point(mesh, facet, |at| {
            let x = in_space(&at.position) - near;
            let outward = -in_space(&at.normal_ds);
            let flux = x.dot(&outward);
            // div(x) = 3, div(x_i x) = 4 x_i, div(x_i x_j x) = 5 x_i x_j
            mass += flux / 3.0;
            first += x * (flux / 4.0);
            second += x * x.transpose() * (flux / 5.0);
        });
    }
    let centroid = first / mass;
    let central = second - centroid * centroid.transpose() * mass;
    let tensor = Matrix3::identity() * central.trace() - central;
    Enclosed { mass, centroid: near + centroid, tensor }
}

/// A body of sections about its centre, at rest, of unit density.
fn sections(moments: SectionMoments<f64>) -> Inertia {
    let [xx, _, yy, zz] = moments.second;
    let diagonal = Vector3::new(yy + zz, xx + zz, xx + yy);
    Inertia { mass: moments.volume, tensor: Matrix3::from_diagonal(&diagonal) }
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

/// The sides of a given mesh that are surfaces of the bodies of a model, one for each where bodies are what a mesh leaves out; else none.
pub(in crate::run) fn sides_of_bodies(model: &Model) -> Vec<SideOfBody<'_>> {
    let sides = model.bodies.iter().filter_map(|body| match &body.shape {
        ShapeSpec::Side(hole) => Some(SideOfBody { side: &hole.side, body: &body.name }),
        _ => None,
    });
    sides.collect()
}

#[cfg(test)]
mod tests {
    use alewife_mesh::Sizing;
    use alewife_mesh::spatial::{Body as SolidBody, Domain, Shape, generate};
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};

    use super::*;

    #[test]
    fn the_surface_of_an_ellipsoid_encloses_its_volume_and_inertia() {
        let semi_axes = [0.9, 0.6, 0.4];
        let turn = UnitQuaternion::from_euler_angles(0.4, 0.7, -0.3);
        let center = Vector3::new(0.3, -0.2, 0.1);
        let pose = Isometry3::from_parts(Translation3::from(center), turn);
        let domain = Domain::walls(Point::<3>::repeat(-2.0), Point::<3>::repeat(2.0));
        let body = SolidBody::new("a", Shape::Ellipsoid { semi_axes }, pose);
        let mesh = generate(&domain, &[body], &Sizing::graded(0.12, 0.4, 0.8)).unwrap();
        let Enclosed { mass, centroid, tensor } = enclosed(&mesh, BoundaryId::new(6));
        let exact = ellipsoid(semi_axes);
        assert!((mass / exact.mass - 1.0).abs() < 1e-3, "{mass} {}", exact.mass);
        assert!((centroid - center).norm() < 1e-4, "{centroid}");
        let turn = turn.to_rotation_matrix();
        let own = turn.transpose() * tensor * turn;
        assert!((own - exact.tensor).amax() < 2e-3 * exact.tensor.amax(), "{own} {}", exact.tensor);
    }

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
}
