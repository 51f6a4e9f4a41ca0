//! The scene viewers are shown: all bodies, each in its own frame.

use nalgebra::{Isometry3, Vector3};

use super::drawing::surface;
use super::primitives::{Colour, Line, Primitives, SceneUpdate};
use super::solids::Solids;
use crate::case::{Body, Geometry, ShapeSpec};
use crate::run::{BodyReport, Snapshot};

/// Which bodies are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// All.
    All,
    /// Those whose outlines change in time.
    Deforming,
}

/// Bodies, which stay with their frames: with where those are.
pub fn scene<const D: usize>(
    bodies: &[Body],
    snapshot: &Snapshot<'_, D>,
    shown: Shown,
) -> SceneUpdate {
    let geometry: Geometry = snapshot.case.geometry;
    let all = bodies.iter().zip(snapshot.bodies).enumerate();
    let entities = all
        .filter(|(_, (body, _))| shown == Shown::All || body.deforms())
        .map(|(index, (body, report))| {
            let drawn = if body.deforms() {
                surface(snapshot.mesh, index, &report.pose, geometry, Colour::BODY)
            } else {
                rigid(body, report)
            };
            drawn.entity(&body.name, &body.name, snapshot.time, ["geometry", geometry.name()])
        })
        .collect();
    SceneUpdate::of(entities)
}

/// A body that keeps its shape, in its own frame.
fn rigid(body: &Body, report: &BodyReport) -> Primitives {
    let (mut solids, mut lines) = (Solids::default(), vec![]);
    let centered = Isometry3::identity();
    match &body.shape {
        // A flat cylinder
        ShapeSpec::Disc { radius } => solids.cylinder([*radius, *radius, *radius / 50.0]),
        ShapeSpec::Ellipse { semi_axes: [a, b] } => solids.cylinder([*a, *b, *b / 50.0]),
        ShapeSpec::Sphere { .. } | ShapeSpec::Spheroid { .. } | ShapeSpec::Ellipsoid { .. } => {
            body.shape.semi_axes().into_iter().for_each(|own| solids.ellipsoid(&centered, own));
        }
        ShapeSpec::Capsule { .. }
        | ShapeSpec::Helix(_)
        | ShapeSpec::Curve(_)
        | ShapeSpec::Revolved { .. }
        | ShapeSpec::Union(_) => {
            // The frame is at the centre of mass, the origin of the shape is not
            let from = report.pose.rotation().inverse();
            let origin = from * (body.pose_in_space().translation.vector - report.pose.center);
            let place = Isometry3::translation(origin.x, origin.y, origin.z);
            solids.parts(&place, &body.shape.parts().unwrap_or_default());
        }
        ShapeSpec::Cylinder { radius, length, .. } => {
            for part in body.shape.parts().unwrap_or_default() {
                solids.cylinder_along_x(&part.pose, *radius, 0.5 * length);
            }
        }
        ShapeSpec::Spline { .. }
        | ShapeSpec::Fish(_)
        | ShapeSpec::Flagellate(_)
        | ShapeSpec::Tube(_) => {
            let points = body.shape.points();
            let points: Vec<_> = points.iter().map(|p| Vector3::new(p[0], p[1], 0.0)).collect();
            lines.push(Line::closed(&points, Colour::BODY));
        }
    }
    let Solids { spheres, cylinders } = solids;
    Primitives { lines, spheres, cylinders, ..Primitives::default() }
}
