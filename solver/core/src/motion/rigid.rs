//! `RigidMove`: how a rigid body carries the nodes on it from one pose to another.

use alewife_mesh::{PlacedShape, Point};
use nalgebra::{Matrix3, Vector3};

use crate::body::{Pose, in_space, on_mesh};

/// The rigid motion that takes one pose to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMove {
    pivot: Vector3<f64>,
    shift: Vector3<f64>,
    /// R - I with R the rotation: exactly zero when nothing turns.
    turn: Matrix3<f64>,
    /// Angle of the rotation about z of a planar motion (rad), within (-pi, pi].
    angle: f64,
}

impl RigidMove {
    /// The motion from one pose to another.
    #[must_use]
    pub fn between(from: &Pose, to: &Pose) -> Self {
        let rotation = to.rotation() * from.rotation().inverse();
        // With the quaternion (w, v), R - I = 2 w [v] + 2 [v] [v], [v] the matrix of v x: no digits are
        // lost where the body hardly turns
        let (w, v) = (rotation.w, rotation.imag());
        let turn = Matrix3::from_fn(|i, j| {
            if i == j {
                -2.0 * (v[(i + 1) % 3] * v[(i + 1) % 3] + v[(i + 2) % 3] * v[(i + 2) % 3])
            } else {
                let k = 3 - i - j;
                let sign = if (i + 1) % 3 == j { -1.0 } else { 1.0 };
                sign * (2.0 * v[k] * w) + 2.0 * v[i] * v[j]
            }
        });
        Self {
            pivot: from.center,
            shift: to.center - from.center,
            turn,
            angle: 2.0 * (rotation.k * w.signum()).atan2(w.abs()),
        }
    }

    /// Displacement (m) of a point of the body that was at `point` (m) in the first pose.
    #[must_use]
    pub fn displacement<const D: usize>(&self, point: &Point<D>) -> Point<D> {
        on_mesh(&(self.shift + self.turn * (in_space(point) - self.pivot)))
    }

    /// The body's shape in the second pose, given where it was in the first.
    #[must_use]
    pub fn carry(&self, body: &PlacedShape) -> PlacedShape {
        let center = body.center + self.displacement(&body.center);
        PlacedShape { center, angle: body.angle + self.angle, ..body.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alewife_mesh::Shape;

    #[test]
    fn no_motion_moves_nothing_by_a_single_bit() {
        let pose = Pose::planar(0.3, -0.7, 1.234);
        let still = RigidMove::between(&pose, &pose);
        assert_eq!(still.displacement(&Point::<2>::new(12.3, 4.56)), Point::<2>::zeros());
    }

    #[test]
    fn points_go_with_a_body_through_any_rotation_of_space() {
        let rotation = |x, y, z| nalgebra::UnitQuaternion::from_euler_angles(x, y, z);
        let from = Pose::spatial(Vector3::new(0.3, -0.7, 0.2), rotation(0.4, -1.0, 2.0));
        for turned in [rotation(0.4, -1.0, 2.0 + 1e-9), rotation(-2.0, 0.3, 1.0)] {
            let to = Pose::spatial(Vector3::new(-1.0, 2.0, 0.5), turned);
            let point = Vector3::new(1.5, 0.2, -0.3);
            let material = from.rotation().inverse() * (point - from.center);
            let exact = to.center + to.rotation() * material;
            let moved = point + RigidMove::between(&from, &to).displacement(&point);
            assert!((moved - exact).norm() < 1e-14);
        }
    }

    #[test]
    fn points_and_shapes_go_with_the_body_through_any_turn() {
        let from = Pose::planar(0.3, -0.7, 0.4);
        for angle in [0.5, -0.5, 3.1, -3.1, 10.0] {
            let to = Pose::planar(-1.0, 2.0, 0.4 + angle);
            let moved = RigidMove::between(&from, &to);
            let point = Point::<2>::new(1.5, 0.2);
            let lever = nalgebra::Rotation2::new(angle) * (point - Point::<2>::new(0.3, -0.7));
            let exact = Point::<2>::new(-1.0, 2.0) + lever;
            assert!((point + moved.displacement(&point) - exact).norm() < 1e-14);
            let shape = Shape::Ellipse { semi_axes: [2.0, 1.0] };
            let body =
                PlacedShape { name: "b".into(), shape, center: point, angle: 0.1, size: None };
            let carried = moved.carry(&body);
            assert!((carried.center - exact).norm() < 1e-14);
            let turned = carried.angle - 0.1 - angle;
            assert!((turned.sin().abs() < 1e-14) && turned.cos() > 0.0, "{angle}: {turned}");
        }
    }
}
