//! `Placement`: where a root is, its rotation a unit quaternion that moves on its Lie group.

use nalgebra::{Matrix3, Vector3};

use super::spatial::{Number, Pose, Twist, real, vector};

/// Angles (rad) below which the exponential is summed as a series.
const SMALL: f64 = 1e-2;

/// Position and rotation of a frame in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement<T: Number> {
    /// Origin (m).
    pub position: Vector3<T>,
    /// Unit quaternion: w, x, y, z.
    pub quaternion: [T; 4],
}

/// sin(a)/a, (1 - cos a)/a^2 and (a - sin a)/a^3 of the square of an angle, all of them smooth at zero.
fn coefficients<T: Number>(square: T) -> [T; 3] {
    if square.re() < SMALL * SMALL {
        let series = |c: [f64; 4]| ((square * c[3] + c[2]) * square + c[1]) * square + c[0];
        return [
            series([1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0]),
            series([0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40_320.0]),
            series([1.0 / 6.0, -1.0 / 120.0, 1.0 / 5040.0, -1.0 / 362_880.0]),
        ];
    }
    let angle = square.sqrt();
    let (sine, cosine) = angle.sin_cos();
    [sine / angle, (-cosine + 1.0) / square, (angle - sine) / (square * angle)]
}

fn product<T: Number>(a: &[T; 4], b: &[T; 4]) -> [T; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

impl<T: Number> Placement<T> {
    /// In the world's frame.
    #[must_use]
    pub fn identity() -> Self {
        Self::turned(vector([0.0; 3]), &vector([0.0, 0.0, 1.0]), real(0.0))
    }

    /// At a position (m), turned about a unit vector by an angle (rad).
    #[must_use]
    pub fn turned(position: Vector3<T>, axis: &Vector3<T>, angle: T) -> Self {
        let (sine, cosine) = (angle * 0.5).sin_cos();
        let quaternion = [cosine, axis.x * sine, axis.y * sine, axis.z * sine];
        Self { position, quaternion }
    }

    /// The rotation matrix.
    #[must_use]
    pub fn rotation(&self) -> Matrix3<T> {
        let [w, x, y, z] = self.quaternion;
        let square = |a: T, b: T| -(a * a + b * b) * 2.0 + 1.0;
        Matrix3::new(
            square(y, z),
            (x * y - w * z) * 2.0,
            (x * z + w * y) * 2.0,
            (x * y + w * z) * 2.0,
            square(x, z),
            (y * z - w * x) * 2.0,
            (x * z - w * y) * 2.0,
            (y * z + w * x) * 2.0,
            square(x, y),
        )
    }

    /// The same as a pose.
    #[must_use]
    pub fn pose(&self) -> Pose<T> {
        Pose { rotation: self.rotation(), position: self.position }
    }

    /// Angle about z (rad) of the x axis, from -pi to pi.
    #[must_use]
    pub fn heading(&self) -> T {
        let r = self.rotation();
        r[(1, 0)].atan2(r[(0, 0)])
    }

    /// Where it gets in a time (s) with a constant twist about its origin, in its own axes: the exponential
    /// of SE(3), so that a constant twist is followed exactly.
    #[must_use]
    pub fn moved(&self, twist: &Twist<T>, time: T) -> Self {
        let (turn, way) = (twist.angular * time, twist.linear * time);
        let square = turn.dot(&turn);
        let [_, first, second] = coefficients(square);
        let cross = turn.cross(&way);
        let along = way + cross * first + turn.cross(&cross) * second;
        let [half_sinc, half_versine, _] = coefficients(square * 0.25);
        // cos(a/2) = 1 - (a/2)^2 (1 - cos(a/2)) / (a/2)^2
        let cosine = -(square * 0.25 * half_versine) + 1.0;
        let factor = half_sinc * 0.5;
        let step = [cosine, turn.x * factor, turn.y * factor, turn.z * factor];
        let q = product(&self.quaternion, &step);
        let size = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
        Self {
            position: self.position + self.rotation() * along,
            quaternion: q.map(|part| part / size),
        }
    }
}
