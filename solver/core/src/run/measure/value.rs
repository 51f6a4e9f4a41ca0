//! `Value`: what a quantity of any shape is at one time.

use nalgebra::{Quaternion, Vector3};

use crate::case::Component;

/// What a quantity is at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Value {
    /// A number.
    Scalar(f64),
    /// A vector, or what belongs to a rotation; three-dimensional in the plane, too.
    Vector(Vector3<f64>),
    /// A quaternion.
    Quaternion(Quaternion<f64>),
}

impl Value {
    /// A vector of which there may be none: its numbers are none then.
    pub(super) fn of(vector: Option<Vector3<f64>>) -> Self {
        Self::Vector(vector.unwrap_or(Vector3::repeat(f64::NAN)))
    }

    /// One of its numbers; not a number where its shape has no such component.
    pub(super) fn component(&self, component: Component) -> f64 {
        match (self, component) {
            (Self::Scalar(value), Component::Whole) => *value,
            (Self::Vector(vector), Component::X) => vector.x,
            (Self::Vector(vector), Component::Y) => vector.y,
            (Self::Vector(vector), Component::Z) => vector.z,
            (Self::Quaternion(quaternion), Component::W) => quaternion.w,
            (Self::Quaternion(quaternion), Component::X) => quaternion.i,
            (Self::Quaternion(quaternion), Component::Y) => quaternion.j,
            (Self::Quaternion(quaternion), Component::Z) => quaternion.k,
            _ => f64::NAN,
        }
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Scalar(value)
    }
}

impl From<Vector3<f64>> for Value {
    fn from(vector: Vector3<f64>) -> Self {
        Self::Vector(vector)
    }
}
