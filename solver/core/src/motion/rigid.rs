//! `RigidMove`: how a rigid body carries the nodes on it from one pose to another.

use alewife_mesh::{PlacedShape, Point};
use nalgebra::{Matrix2, Vector3};

use crate::body::Pose;

/// The rigid motion of the plane that takes one pose to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMove {
    pivot: Point<2>,
    shift: Point<2>,
    /// Q - I with Q the rotation: exactly zero when nothing turns.
    turn: Matrix2<f64>,
    /// Angle of the rotation (rad), within (-pi, pi].
    angle: f64,
}

impl RigidMove {
    /// The motion from one planar pose to another.
    #[must_use]
    pub fn between(from: &Pose, to: &Pose) -> Self {
        let rotation = to.rotation() * from.rotation().inverse();
        // 1 - cos and sin by half angles: no digits are lost where the body hardly turns
        let (half_sin, half_cos) = (rotation.k, rotation.w);
        let (sin, less) = (2.0 * half_sin * half_cos, -2.0 * half_sin * half_sin);
        let plane = |v: &Vector3<f64>| Point::<2>::new(v.x, v.y);
        Self {
            pivot: plane(&from.center),
            shift: plane(&(to.center - from.center)),
            turn: Matrix2::new(less, -sin, sin, less),
            angle: 2.0 * (half_sin * half_cos.signum()).atan2(half_cos.abs()),
        }
    }

    /// Displacement (m) of a point of the body that was at `place` (m) in the first pose.
    #[must_use]
    pub fn displacement(&self, place: &Point<2>) -> Point<2> {
        self.shift + self.turn * (place - self.pivot)
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
    fn points_and_shapes_go_with_the_body_through_any_turn() {
        let from = Pose::planar(0.3, -0.7, 0.4);
        for angle in [0.5, -0.5, 3.1, -3.1, 10.0] {
            let to = Pose::planar(-1.0, 2.0, 0.4 + angle);
            let moved = RigidMove::between(&from, &to);
            let place = Point::<2>::new(1.5, 0.2);
            let lever = nalgebra::Rotation2::new(angle) * (place - Point::<2>::new(0.3, -0.7));
            let exact = Point::<2>::new(-1.0, 2.0) + lever;
            assert!((place + moved.displacement(&place) - exact).norm() < 1e-14);
            let shape = Shape::Ellipse { semi_axes: [2.0, 1.0] };
            let body =
                PlacedShape { name: "b".into(), shape, center: place, angle: 0.1, size: None };
            let carried = moved.carry(&body);
            assert!((carried.center - exact).norm() < 1e-14);
            let turned = carried.angle - 0.1 - angle;
            assert!((turned.sin().abs() < 1e-14) && turned.cos() > 0.0, "{angle}: {turned}");
        }
    }
}
