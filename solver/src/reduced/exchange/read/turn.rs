//! Rotations as MJCF and URDF write them.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::defaults::Element;
use super::source::{Read, refuse, unit};

/// How a file writes angles.
#[derive(Debug, Clone)]
pub(super) struct Angles {
    /// Radians of a unit.
    pub unit: f64,
    /// Axes of Euler's angles in order; small ones turn with the body, large ones do not.
    pub sequence: String,
}

/// The rotation matrix of roll, pitch and yaw about the fixed axes x, y and z (rad).
pub(super) fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> Matrix3<f64> {
    *Rotation3::from_euler_angles(roll, pitch, yaw).matrix()
}

/// The rotation of an element by one of the attributes that MJCF has for it.
///
/// # Errors
/// When an attribute is wrong, or there are two.
pub(super) fn rotation(element: &Element<'_, '_, '_>, angles: &Angles) -> Read<Matrix3<f64>> {
    let node = element.node;
    let names = ["quat", "axisangle", "xyaxes", "zaxis", "euler"];
    let own: Vec<&str> = names.into_iter().filter(|name| node.attribute(*name).is_some()).collect();
    if own.len() > 1 {
        let what = format!("`{}` and `{}` both turn it", own[0], own[1]);
        return refuse(node, what, "one of them");
    }
    let name =
        own.first().copied().or_else(|| names.into_iter().find(|n| element.text(n).is_some()));
    let turn = |q: UnitQuaternion<f64>| *q.to_rotation_matrix().matrix();
    Ok(match name {
        Some("quat") => {
            let [w, x, y, z] = element.exactly::<4>("quat")?.unwrap_or([1.0, 0.0, 0.0, 0.0]);
            let q = Quaternion::new(w, x, y, z);
            if q.norm() < 1e-12 {
                return refuse(node, "`quat` has the length zero", "w x y z");
            }
            if q == Quaternion::identity() {
                return Ok(Matrix3::identity());
            }
            turn(UnitQuaternion::from_quaternion(q))
        }
        Some("axisangle") => {
            let [x, y, z, angle] = element.exactly::<4>("axisangle")?.unwrap_or_default();
            let axis = unit(node, "axisangle", [x, y, z])?;
            turn(UnitQuaternion::new(axis * (angle * angles.unit)))
        }
        Some("xyaxes") => {
            let [a, b, c, d, e, f] = element.exactly::<6>("xyaxes")?.unwrap_or_default();
            let x = unit(node, "xyaxes", [a, b, c])?;
            let y = Vector3::new(d, e, f);
            let y = unit(node, "xyaxes", (y - x * x.dot(&y)).into())?;
            Matrix3::from_columns(&[x, y, x.cross(&y)])
        }
        Some("zaxis") => {
            let axis = unit(node, "zaxis", element.vector("zaxis")?.into())?;
            *from_z(&axis).matrix()
        }
        Some(_) => euler(element, angles)?,
        None => Matrix3::identity(),
    })
}

/// The shortest turn of the z axis to a unit vector.
pub(super) fn from_z(axis: &Vector3<f64>) -> Rotation3<f64> {
    let half_turn = Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    Rotation3::rotation_between(&Vector3::z(), axis).unwrap_or(half_turn)
}

fn euler(element: &Element<'_, '_, '_>, angles: &Angles) -> Read<Matrix3<f64>> {
    let values = element.vector("euler")?;
    let mut turned = Rotation3::identity();
    for (axis, value) in angles.sequence.chars().zip(values.iter()) {
        let unit = match axis.to_ascii_lowercase() {
            'x' => Vector3::x_axis(),
            'y' => Vector3::y_axis(),
            'z' => Vector3::z_axis(),
            _ => {
                let what = format!("`eulerseq` is \"{}\"", angles.sequence);
                return refuse(element.node, what, "three of x, y, z, X, Y, Z");
            }
        };
        let one = Rotation3::from_axis_angle(&unit, value * angles.unit);
        turned = if axis.is_lowercase() { turned * one } else { one * turned };
    }
    Ok(*turned.matrix())
}
