//! The scene viewers are shown: all bodies, each in its own frame.

use alewife_mesh::{Shape, Spline};
use nalgebra::{Isometry3, Vector3};

use super::drawing::surface;
use super::primitives::{Colour, Line, Primitives, SceneUpdate};
use super::solids::Solids;
use crate::case::{Body, Geometry, ShapeSpec};
use crate::run::{BodyReport, Snapshot};

/// Points of a curved outline: more than a line on a screen shows.
const POINTS: usize = 128;

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
    let (mut solids, mut lines, mut is_placed) = (Solids::default(), vec![], false);
    let centered = Isometry3::identity();
    let is_solid = matches!(&body.shape, ShapeSpec::Side(hole) if hole.solid().is_some());
    match &body.shape {
        // A flat cylinder
        ShapeSpec::Disc { radius } => solids.cylinder([*radius, *radius, *radius / 50.0]),
        ShapeSpec::Ellipse { semi_axes: [a, b] } => solids.cylinder([*a, *b, *b / 50.0]),
        ShapeSpec::Sphere { .. } | ShapeSpec::Spheroid { .. } | ShapeSpec::Ellipsoid { .. } => {
            body.shape.semi_axes().into_iter().for_each(|own| solids.ellipsoid(&centered, own));
        }
        ShapeSpec::Side(_) if is_solid => {
            solids.parts(&Isometry3::identity(), &body.shape.parts().unwrap_or_default());
        }
        ShapeSpec::Capsule { .. }
        | ShapeSpec::Helix(_)
        | ShapeSpec::Curve(_)
        | ShapeSpec::Revolved { .. }
        | ShapeSpec::Surface(_)
        | ShapeSpec::Union(_) => {
            // The frame is at the centre of mass, the origin of the shape is not
            let from = report.pose.rotation().inverse();
            let origin = from * (body.pose_in_space().translation.vector - report.pose.center);
            let place = Isometry3::translation(origin.x, origin.y, origin.z);
            solids.parts(&place, &body.shape.parts().unwrap_or_default());
            is_placed = true;
        }
        ShapeSpec::Cylinder { radius, length, .. } => {
            for part in body.shape.parts().unwrap_or_default() {
                solids.cylinder_along_x(&part.pose, *radius, 0.5 * length);
            }
        }
        ShapeSpec::Spline { .. }
        | ShapeSpec::Polygon(_)
        | ShapeSpec::Box { .. }
        | ShapeSpec::Side(_)
        | ShapeSpec::Fish(_)
        | ShapeSpec::Flagellate(_)
        | ShapeSpec::Tube(_) => {
            lines.push(Line::closed(&outline(&body.shape), Colour::BODY));
        }
    }
    let Solids { mut spheres, mut cylinders } = solids;
    if !body.center_of_mass.is_empty() && !is_placed {
        let part = |axis: usize| body.center_of_mass.get(axis).copied().unwrap_or(0.0);
        let shift = centroid(&body.shape) - Vector3::from_fn(|axis, _| part(axis));
        lines = lines.into_iter().map(|line| line.shifted(&shift)).collect();
        for solid in spheres.iter_mut().chain(&mut cylinders) {
            solid.pose.position = solid.pose.position.plus(&shift);
        }
    }
    Primitives { lines, spheres, cylinders, ..Primitives::default() }
}

/// Centroid of a curved outline in the frame of its body (m); the origin of other shapes.
fn centroid(shape: &ShapeSpec) -> Vector3<f64> {
    let moments = match shape {
        ShapeSpec::Spline { .. } => shape.outline().moments(),
        _ => None,
    };
    moments.map_or_else(Vector3::zeros, |moments| {
        Vector3::new(moments.centroid.x, moments.centroid.y, 0.0)
    })
}

/// Points on the curved outline of a body, about its centre of mass (m).
fn outline(shape: &ShapeSpec) -> Vec<Vector3<f64>> {
    let shape = shape.outline();
    if let (Shape::Polygon { points }, Some(moments)) = (&shape, shape.moments()) {
        let about =
            |[x, y]: &[f64; 2]| Vector3::new(x - moments.centroid.x, y - moments.centroid.y, 0.0);
        return points.iter().map(about).collect();
    }
    let spline = match &shape {
        Shape::Spline { points } => Spline::through(points),
        Shape::Curve { spline } => Some(Spline::clone(spline)),
        _ => None,
    };
    let Some((spline, moments)) = spline.zip(shape.moments()) else { return Vec::new() };
    let step = spline.period() / POINTS as f64;
    let point = |nth: usize| spline.evaluate(nth as f64 * step)[0] - moments.centroid;
    (0..POINTS).map(point).map(|point| Vector3::new(point.x, point.y, 0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_is_drawn_about_its_centre_of_mass() {
        let points =
            vec![[0.5, 0.0], [0.2, 0.1], [-0.2, 0.1], [-0.3, 0.0], [-0.2, -0.1], [0.2, -0.1]];
        let drawn = outline(&ShapeSpec::Spline { points });
        let after = drawn.iter().cycle().skip(1);
        let parts = drawn.iter().zip(after).map(|(a, b)| (a.x * b.y - b.x * a.y, a + b));
        let (twice_area, moment) = parts
            .fold((0.0, Vector3::zeros()), |(area, moment), (own, sum)| {
                (area + own, moment + sum * own / 3.0)
            });
        assert!(twice_area > 0.25);
        assert!((moment / twice_area).norm() < 1e-4, "{moment}");
        let ends = drawn
            .iter()
            .fold([f64::MAX, f64::MIN], |[low, high], point| [low.min(point.x), high.max(point.x)]);
        assert!((ends[1] - ends[0] - 0.8).abs() < 1e-3, "{ends:?}");
    }
}
