//! Solids of a scene as viewers draw them: ellipsoids, and cylinders for tubes and profiles.

use alewife_mesh::spatial::{Centreline, Part, Shape, SurfaceMoments, parts_of};
use nalgebra::{
    Isometry3, Matrix3, Rotation3, SymmetricEigen, Translation3, UnitQuaternion, Vector3,
};

use super::primitives::{Colour, Placement, Solid, Xyz, Xyzw};

/// Cylinders by which a turn of a helix is drawn.
const PIECES_OF_TURN: f64 = 24.0;

/// Primitives of a scene.
#[derive(Debug, Default)]
pub struct Solids {
    /// Ellipsoids.
    pub spheres: Vec<Solid>,
    /// Cylinders, or cones without tips.
    pub cylinders: Vec<Solid>,
}

impl Solids {
    /// Draws an ellipsoid of these semi-axes (m).
    pub fn ellipsoid(&mut self, pose: &Isometry3<f64>, semi_axes: [f64; 3]) {
        self.spheres.push(solid(pose, semi_axes, [1.0; 2]));
    }

    /// Draws a cylinder along x of a radius and half a length (m).
    pub fn cylinder_along_x(&mut self, pose: &Isometry3<f64>, radius: f64, half_length: f64) {
        let end = Vector3::new(half_length, 0.0, 0.0);
        self.cone(pose, [-end, end], [radius; 2]);
    }

    /// Draws a cylinder along z of these semi-axes (m) about the origin.
    pub fn cylinder(&mut self, semi_axes: [f64; 3]) {
        self.cylinders.push(solid(&Isometry3::identity(), semi_axes, [1.0; 2]));
    }

    /// Draws the parts of a body that is placed in a frame (m).
    pub fn parts(&mut self, place: &Isometry3<f64>, parts: &[Part]) {
        for part in parts {
            let pose = place * part.pose;
            match &part.shape {
                Shape::Sphere { radius } => self.ellipsoid(&pose, [*radius; 3]),
                Shape::Ellipsoid { semi_axes } => self.ellipsoid(&pose, *semi_axes),
                Shape::Capsule { radius, length } => {
                    let end = Vector3::new(0.5 * length, 0.0, 0.0);
                    self.tube(&pose, &[-end, end], *radius);
                }
                // Drawn by whoever knows how long it is
                Shape::Cylinder { .. } => {}
                Shape::Tube { centreline, radius } => {
                    self.tube(&pose, &points(centreline), *radius);
                }
                Shape::Slender(slender) => {
                    let sections = slender.sections();
                    let knots = sections.knots().windows(2);
                    for pair in knots.map(|pair| [pair[0], pair[1]]) {
                        let ends = pair.map(|along| parts_of(&sections.at(along)[0]));
                        let radii = ends.map(|[_, width, _]| width.norm());
                        self.cone(&pose, ends.map(|[middle, ..]| middle), radii);
                    }
                }
                Shape::Triangulated(triangles) => {
                    self.ellipsoid_of(&pose, &triangles.moments());
                }
                Shape::Revolved { profile } => {
                    let at = |[x, _]: [f64; 2]| Vector3::new(x, 0.0, 0.0);
                    for pair in profile.windows(2) {
                        let radii = [pair[0][1], pair[1][1]];
                        self.cone(&pose, [at(pair[0]), at(pair[1])], radii);
                    }
                }
            }
        }
    }

    /// Draws the ellipsoid with the second moments of a solid.
    fn ellipsoid_of(&mut self, pose: &Isometry3<f64>, moments: &SurfaceMoments) {
        let second = Matrix3::identity() * (0.5 * moments.inertia.trace()) - moments.inertia;
        let mut eigen = SymmetricEigen::new(second / moments.volume);
        if eigen.eigenvectors.determinant() < 0.0 {
            let turned = -eigen.eigenvectors.column(0);
            eigen.eigenvectors.set_column(0, &turned);
        }
        let turn = Rotation3::from_matrix_unchecked(eigen.eigenvectors);
        let turn = UnitQuaternion::from_rotation_matrix(&turn);
        let own = Isometry3::from_parts(Translation3::from(moments.centroid), turn);
        // a^2 / 5 of an ellipsoid
        let semi_axes = eigen.eigenvalues.map(|value| (5.0 * value.max(0.0)).sqrt());
        self.ellipsoid(&(pose * own), semi_axes.into());
    }

    /// A tube through points, with round ends.
    fn tube(&mut self, pose: &Isometry3<f64>, points: &[Vector3<f64>], radius: f64) {
        for pair in points.windows(2) {
            self.cone(pose, [pair[0], pair[1]], [radius; 2]);
        }
        for end in points.first().into_iter().chain(points.last()) {
            self.ellipsoid(&(pose * Translation3::from(*end)), [radius; 3]);
        }
    }

    /// A cone without its tip from one point to another, with the radii there (m).
    fn cone(&mut self, pose: &Isometry3<f64>, ends: [Vector3<f64>; 2], radii: [f64; 2]) {
        let way = ends[1] - ends[0];
        let widest = radii[0].max(radii[1]);
        if way.norm() == 0.0 || widest == 0.0 {
            return;
        }
        // Cylinders of viewers are along z
        let turn = UnitQuaternion::rotation_between(&Vector3::z(), &way);
        let half_turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        let middle = Translation3::from((ends[0] + ends[1]) * 0.5);
        let own = Isometry3::from_parts(middle, turn.unwrap_or(half_turn));
        let scales = radii.map(|radius| radius / widest);
        self.cylinders.push(solid(&(pose * own), [widest, widest, 0.5 * way.norm()], scales));
    }
}

/// Points of a curve through which its tube is drawn (m).
fn points(centreline: &Centreline) -> Vec<Vector3<f64>> {
    let pieces = match centreline {
        Centreline::Helix { turns, .. } => PIECES_OF_TURN * turns.abs(),
        Centreline::Spline(_) => centreline.pieces(),
    };
    let n = alewife_mesh::whole(pieces.ceil().clamp(1.0, 1e4));
    (0..=n).map(|i| centreline.at(i as f64 / n as f64)).collect()
}

/// A primitive in its frame, with the radii of a cylinder at its bottom and its top over its semi-axes.
fn solid(pose: &Isometry3<f64>, semi_axes: [f64; 3], [bottom, top]: [f64; 2]) -> Solid {
    Solid {
        pose: Placement {
            position: Xyz::of(&pose.translation.vector),
            orientation: Xyzw::of(&pose.rotation),
        },
        size: Xyz::of(&(2.0 * Vector3::from(semi_axes))),
        bottom_scale: bottom,
        top_scale: top,
        color: Colour::BODY,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    #[test]
    fn a_tube_is_drawn_from_end_to_end() {
        let centreline = Centreline::Helix { radius: 0.5, pitch: 1.0, turns: 2.0 };
        let shape = Shape::Tube { centreline: centreline.clone(), radius: 0.1 };
        let part = Part { shape, pose: Isometry3::identity() };
        let mut solids = Solids::default();
        solids.parts(&Isometry3::translation(1.0, 0.0, 0.0), &[part]);
        assert_eq!((solids.spheres.len(), solids.cylinders.len()), (2, 48));
        let end = serde_json::to_value(solids.spheres[1].pose.position).unwrap();
        assert_eq!(end["x"].as_f64(), Some(3.0));
        // Bottom and top of a cylinder are on the curve
        for (nth, cylinder) in solids.cylinders.iter().enumerate() {
            let cylinder = serde_json::to_value(cylinder).unwrap();
            let part = |of: &Value, key: &str| of[key].as_f64().unwrap();
            let [position, turn] = ["position", "orientation"].map(|key| &cylinder["pose"][key]);
            let turn = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(
                part(turn, "w"),
                part(turn, "x"),
                part(turn, "y"),
                part(turn, "z"),
            ));
            let middle = Vector3::from(["x", "y", "z"].map(|key| part(position, key)));
            let up = turn * Vector3::new(0.0, 0.0, 0.5 * part(&cylinder["size"], "z"));
            let top = centreline.at((nth + 1) as f64 / 48.0) + Vector3::x();
            assert!((middle + up - top).norm() < 1e-12);
        }
    }
}
