//! `AxialVector`: an angular velocity or a torque, a plain number where it is about z.

use std::fmt;

use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An angular velocity (rad/s) or a torque (N m): a number is its part about z, counter-clockwise; in
/// three dimensions it may be `[x, y, z]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(with = "Written"))]
pub struct AxialVector(pub [f64; 3]);

/// How it is written.
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "the schema is derived from it")]
enum Written {
    /// About z, counter-clockwise.
    AboutZ(f64),
    /// About x, y and z.
    AboutAll([f64; 3]),
}

impl AxialVector {
    /// One about z.
    #[must_use]
    pub fn about_z(z: f64) -> Self {
        Self([0.0, 0.0, z])
    }

    /// Its part about z.
    #[must_use]
    pub fn z(&self) -> f64 {
        self.0[2]
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.0 == [0.0; 3]
    }

    /// Whether it lies in the plane, about x or y.
    #[must_use]
    pub fn tilts(&self) -> bool {
        self.0[..2] != [0.0; 2]
    }

    /// Its length.
    #[must_use]
    pub fn norm(&self) -> f64 {
        nalgebra::Vector3::from(self.0).norm()
    }
}

impl Serialize for AxialVector {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.tilts() { self.0.serialize(serializer) } else { self.z().serialize(serializer) }
    }
}

impl<'de> Deserialize<'de> for AxialVector {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Parts)
    }
}

struct Parts;

impl<'de> Visitor<'de> for Parts {
    type Value = AxialVector;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or [x, y, z] in three dimensions,")
    }

    fn visit_f64<E: de::Error>(self, about_z: f64) -> Result<AxialVector, E> {
        Ok(AxialVector::about_z(about_z))
    }

    fn visit_i64<E: de::Error>(self, about_z: i64) -> Result<AxialVector, E> {
        Ok(AxialVector::about_z(about_z as f64))
    }

    fn visit_u64<E: de::Error>(self, about_z: u64) -> Result<AxialVector, E> {
        Ok(AxialVector::about_z(about_z as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<AxialVector, A::Error> {
        let mut vector = [0.0; 3];
        for (axis, part) in vector.iter_mut().enumerate() {
            *part = parts.next_element()?.ok_or_else(|| de::Error::invalid_length(axis, &self))?;
        }
        Ok(AxialVector(vector))
    }
}
