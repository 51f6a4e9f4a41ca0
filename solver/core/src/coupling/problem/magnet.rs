//! `Magnet`: a magnetic moment in a body, and the field it is in.
//!
//! With m the moment in the world and B the field at the centre of mass, the torque is m x B and the force
//! grad(m . B) = G^T m, G_ij = dB_i/dx_j.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::in_time::TimeValue;
use crate::body::{Pose, Wrench};

/// Angle from a moment to the field (rad) below which Newton's method for sin(angle) = 0 converges to the field; it
/// does below 1.1656, where tan(angle) = 2 angle.
const NEWTON_ANGLE: f64 = 1.1;

/// Sine of the angle from a moment to the field below which the axis of the torque is rounding.
const ALIGNED: f64 = 1e-8;

/// A field as a function of time alone (T).
pub type UniformField = Box<dyn Fn(f64) -> Vector3<f64> + Send + Sync>;

/// A magnetic field: the sum of its parts.
pub struct MagneticField {
    /// The parts.
    pub parts: Vec<FieldPart>,
}

/// A part of a magnetic field.
pub enum FieldPart {
    /// The same everywhere.
    Uniform(UniformField),
    /// gradient (x - center), times the factor.
    Linear {
        /// dB_i/dx_j (T/m).
        gradient: Matrix3<f64>,
        /// Where it is zero (m).
        center: Vector3<f64>,
        /// Factor in time.
        factor: TimeValue,
    },
    /// That of a dipole: [n (s . r) r / r^2 - s] / (2 (n - 1) pi r^n) in n dimensions.
    Dipole {
        /// Where it is (m).
        position: Vector3<f64>,
        /// s: its moment times the permeability (T m3; T m2 planar).
        strength: Vector3<f64>,
        /// n: 3 of a point, 2 of a line along z.
        dimensions: i32,
        /// Factor in time.
        factor: TimeValue,
    },
}

/// A field at a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LocalField {
    /// B (T).
    pub value: Vector3<f64>,
    /// dB_i/dx_j (T/m).
    pub gradient: Matrix3<f64>,
}

/// A magnetic moment fixed in a body.
pub struct Magnet {
    /// Moment in the frame of the body (A m2; A m planar).
    pub moment: Vector3<f64>,
    /// The field it is in.
    pub field: Arc<MagneticField>,
}

impl FieldPart {
    /// At a time (s) and a place (m).
    fn at(&self, time: f64, place: &Vector3<f64>) -> LocalField {
        match self {
            Self::Uniform(value) => LocalField { value: value(time), gradient: Matrix3::zeros() },
            Self::Linear { gradient, center, factor } => {
                let gradient = gradient * factor(time);
                LocalField { value: gradient * (place - center), gradient }
            }
            Self::Dipole { position, strength, dimensions, factor } => {
                dipole(&(strength * factor(time)), &(place - position), *dimensions)
            }
        }
    }
}

/// The field of a dipole of a strength (T m3; T m2 planar) at a distance from it (m).
fn dipole(strength: &Vector3<f64>, way: &Vector3<f64>, dimensions: i32) -> LocalField {
    let n = f64::from(dimensions);
    let square = way.norm_squared();
    let scale = 1.0 / (2.0 * (n - 1.0) * PI * square.sqrt().powi(dimensions));
    let along = strength.dot(way) / square;
    let value = (way * (n * along) - strength) * scale;
    let products = strength * way.transpose() + way * strength.transpose();
    let radial = Matrix3::identity() * along - way * way.transpose() * ((n + 2.0) * along / square);
    LocalField { value, gradient: (products / square + radial) * (n * scale) }
}

impl MagneticField {
    /// At a time (s) and a place (m).
    #[must_use]
    pub fn at(&self, time: f64, place: &Vector3<f64>) -> LocalField {
        let parts = self.parts.iter().map(|part| part.at(time, place));
        parts.fold(LocalField::default(), |sum, part| LocalField {
            value: sum.value + part.value,
            gradient: sum.gradient + part.gradient,
        })
    }
}

/// A moment and the field at it, in the world.
struct Pair {
    moment: Vector3<f64>,
    field: LocalField,
}

impl Magnet {
    fn pair(&self, time: f64, pose: &Pose) -> Pair {
        Pair { moment: pose.to_world(&self.moment), field: self.field.at(time, &pose.center) }
    }

    /// Force and torque of the field (N, N m) at a time (s) on the body at a pose.
    #[must_use]
    pub fn load(&self, time: f64, pose: &Pose) -> Wrench {
        let Pair { moment, field } = self.pair(time, pose);
        Wrench { force: field.gradient.transpose() * moment, torque: moment.cross(&field.value) }
    }

    /// The largest torque of the field at a time (s), however the body is turned at this place (N m).
    #[must_use]
    pub fn largest_torque(&self, time: f64, pose: &Pose) -> f64 {
        let Pair { moment, field } = self.pair(time, pose);
        moment.norm() * field.value.norm()
    }

    /// The angle from the moment to the field (rad): in the plane counter-clockwise, within half a turn, in
    /// space from 0 to pi. Not a number where there is no field.
    #[must_use]
    pub fn lag(&self, time: f64, pose: &Pose, is_planar: bool) -> f64 {
        let Pair { moment, field } = self.pair(time, pose);
        let (across, along) = (moment.cross(&field.value), moment.dot(&field.value));
        if across.norm() == 0.0 && along == 0.0 {
            return f64::NAN;
        }
        if is_planar { across.z.atan2(along) } else { across.norm().atan2(along) }
    }

    /// K of the torque T(pose) - K turn by which a step takes the field implicitly (N m/rad).
    #[must_use]
    pub fn turning_stiffness(&self, time: f64, pose: &Pose) -> Matrix3<f64> {
        let Pair { moment, field } = self.pair(time, pose);
        restoring_stiffness(&moment, &field.value)
    }
}

/// K of the torque T - K turn, T = m x B, of a moment m that turns and a field B that does not, all in the world.
///
/// With n the axis from moment to field, phi the angle between them and e = n x m / |m|,
/// -dT/dturn = m B (cos(phi) (n n + e e) - sin(phi) m e / |m|). About n the secant sin(phi) / phi takes the place of
/// cos(phi) where phi is large: there the tangent overshoots, and beyond a quarter of a turn leads away from the
/// field. The pose is found by iteration, so that this makes no difference to it. About e the cosine counts
/// where it is positive.
pub(super) fn restoring_stiffness(moment: &Vector3<f64>, field: &Vector3<f64>) -> Matrix3<f64> {
    let size = moment.norm() * field.norm();
    if size == 0.0 {
        return Matrix3::zeros();
    }
    let (torque, along) = (moment.cross(field), moment.dot(field));
    let own = moment / moment.norm();
    let across = torque.norm();
    let restoring = along.max(0.0);
    let Some(axis) = torque.try_normalize(ALIGNED * size) else {
        return (Matrix3::identity() - own * own.transpose()) * restoring;
    };
    let side = axis.cross(&own);
    let angle = across.atan2(along);
    let about = if angle < NEWTON_ANGLE { along } else { across / angle };
    axis * axis.transpose() * about + (side * restoring - own * across) * side.transpose()
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;

    fn uniform(value: Vector3<f64>) -> Arc<MagneticField> {
        Arc::new(MagneticField { parts: vec![FieldPart::Uniform(Box::new(move |_| value))] })
    }

    fn around(center: Vector3<f64>) -> Pose {
        Pose::spatial(center, UnitQuaternion::from_euler_angles(0.4, -0.7, 1.2))
    }

    /// Fields without sources: their divergence and rotation are zero, and gradients are those of the values.
    #[test]
    fn gradients_are_those_of_the_field() {
        let factor = || -> TimeValue { Box::new(|time| 1.0 + time) };
        let gradient = Matrix3::new(1.0, 0.3, -0.2, 0.3, 0.5, 0.7, -0.2, 0.7, -1.5);
        let strength = Vector3::new(0.5, -1.0, 0.8);
        let [flat, place] = [Vector3::new(0.5, -1.0, 0.0), Vector3::new(0.9, 1.4, -0.6)];
        let dipole = |strength, dimensions| FieldPart::Dipole {
            position: Vector3::new(-0.2, 0.1, 0.0),
            strength,
            dimensions,
            factor: factor(),
        };
        let linear = FieldPart::Linear { gradient, center: Vector3::x(), factor: factor() };
        let in_plane = Vector3::new(place.x, place.y, 0.0);
        for (part, place, dimensions) in
            [(linear, place, 3), (dipole(strength, 3), place, 3), (dipole(flat, 2), in_plane, 2)]
        {
            let found = part.at(0.5, &place).gradient;
            let small = 1e-5;
            for axis in 0..dimensions {
                let ends =
                    [small, -small].map(|by| part.at(0.5, &(place + Vector3::ith(axis, by))).value);
                let slope = (ends[0] - ends[1]) / (2.0 * small);
                assert!((slope - found.column(axis)).norm() < 1e-9, "{slope} {found}");
            }
            let trace: f64 = (0..dimensions).map(|axis| found[(axis, axis)]).sum();
            assert!(trace.abs() < 1e-14, "{trace}");
            assert!((found - found.transpose()).norm() < 1e-14);
        }
        // On its axis a point has twice the field that it has beside it, a line the same
        let beside = |dimensions| {
            [Vector3::x(), Vector3::y()]
                .map(|way| super::dipole(&Vector3::x(), &(way * 2.0), dimensions).value.x)
        };
        let [on, off] = beside(3);
        assert!((on - 2.0 / (4.0 * PI * 8.0)).abs() < 1e-15 && (off + on / 2.0).abs() < 1e-15);
        let [on, off] = beside(2);
        assert!((on - 1.0 / (2.0 * PI * 4.0)).abs() < 1e-15 && (off + on).abs() < 1e-15);
    }

    /// Force and torque are what the energy -m . B changes by.
    #[test]
    fn loads_are_those_of_the_energy() {
        let part = FieldPart::Dipole {
            position: Vector3::new(0.3, -0.2, 0.5),
            strength: Vector3::new(0.4, 1.0, -0.3),
            dimensions: 3,
            factor: Box::new(|_| 2.0),
        };
        let field = Arc::new(MagneticField { parts: vec![part] });
        let magnet = Magnet { moment: Vector3::new(1.0, -0.4, 0.2), field };
        let pose = around(Vector3::new(1.0, 0.7, -0.4));
        let energy = |pose: &Pose| {
            let Pair { moment, field } = magnet.pair(0.0, pose);
            -moment.dot(&field.value)
        };
        let load = magnet.load(0.0, &pose).to_vector();
        for entry in 0..6 {
            let by = |small: f64| {
                let mut way = crate::body::RigidVector::zeros();
                way[entry] = small;
                energy(&pose.displaced(&way))
            };
            let slope = (by(1e-5) - by(-1e-5)) / 2e-5;
            assert!((load[entry] + slope).abs() < 1e-9, "{entry}: {} {slope}", load[entry]);
        }
    }

    /// The stiffness is minus the derivative of the torque, but for secants where that leads away from the field.
    #[test]
    fn the_stiffness_is_that_of_the_torque() {
        let pose = around(Vector3::zeros());
        let torque = |magnet: &Magnet, turn: Vector3<f64>| {
            let turned = UnitQuaternion::from_scaled_axis(turn) * pose.rotation();
            magnet.load(0.0, &Pose::spatial(Vector3::zeros(), turned)).torque
        };
        let moment = Vector3::new(0.5, 1.0, -0.7);
        let own = pose.to_world(&moment);
        let axis = own.cross(&Vector3::new(0.2, 0.3, 0.9)).normalize();
        for angle in [0.0, 1e-6, 0.4, 1.3, 2.2, 3.1, PI] {
            let ahead = UnitQuaternion::from_scaled_axis(axis * angle) * own * 1.7;
            let magnet = Magnet { moment, field: uniform(ahead) };
            let found = magnet.turning_stiffness(0.0, &pose);
            let slope = |turn: Vector3<f64>| {
                (torque(&magnet, turn * 1e-5) - torque(&magnet, turn * -1e-5)) / -2e-5
            };
            let size = own.norm_squared() * 1.7;
            // About the moment itself nothing changes
            assert!((found * own).norm() < 1e-9 * size && slope(own).norm() < 1e-8 * size);
            let about = (found * axis).dot(&axis) / size;
            let wanted = if angle < NEWTON_ANGLE { angle.cos() } else { angle.sin() / angle };
            assert!((about - wanted).abs() < 1e-9, "{angle}: {about}");
            let side = axis.cross(&own).normalize();
            let off = found * side - slope(side);
            let tangent = if angle < PI / 2.0 { 0.0 } else { -angle.cos() * size };
            assert!((off - side * tangent).norm() < 1e-8 * size, "{angle}: {off}");
        }
    }

    #[test]
    fn the_lag_is_counted_from_the_moment_to_the_field() {
        let pose = Pose::planar(0.0, 0.0, 0.3);
        for lag in [-3.0f64, -0.5, 0.0, 1.2, 3.0] {
            let (sin, cos) = (0.3 + lag).sin_cos();
            let field = uniform(Vector3::new(cos, sin, 0.0) * 2.0);
            let magnet = Magnet { moment: Vector3::x() * 0.5, field };
            assert!((magnet.lag(0.0, &pose, true) - lag).abs() < 1e-14);
            assert!((magnet.lag(0.0, &pose, false) - lag.abs()).abs() < 1e-14);
            assert!((magnet.load(0.0, &pose).torque.z - lag.sin()).abs() < 1e-14);
            assert!((magnet.largest_torque(0.0, &pose) - 1.0).abs() < 1e-14);
        }
        let nowhere = Magnet { moment: Vector3::x(), field: uniform(Vector3::zeros()) };
        assert!(nowhere.lag(0.0, &pose, true).is_nan());
    }
}
