//! How a body moves as a whole: held, free, by a velocity that is given, or each motion in its own way.

pub(crate) mod by_axis;
pub(crate) mod inertia;
mod lock;
mod of_body;

use std::fmt;

use serde::de::value::{MapAccessDeserializer, StringDeserializer};
use serde::de::{self, DeserializeSeed, Deserializer, IntoDeserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use self::by_axis::MotionsByAxis;
pub use self::lock::Lock;
use super::axial_vector::AxialVector;
#[cfg(test)]
use crate::spec::number::PerDimension;
use crate::spec::time_function::TimeFunction;

/// How a body moves as a whole.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Motion {
    /// It does not move.
    Held,
    /// It obeys Newton and Euler under the fluid's load, gravity and external loads.
    Free,
    /// Its velocity is given; the reaction is an output.
    Imposed(ImposedMotion),
    /// Each motion in its own way.
    #[serde(untagged)]
    ByAxis(Box<MotionsByAxis>),
}

/// A rigid velocity given as a function of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ImposedMotion {
    /// Velocity (m/s), one number per dimension.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "PerDimension"))]
    pub velocity: Vec<f64>,
    /// Angular velocity (rad/s): counter-clockwise in planar cases, [x, y, z] in space.
    #[serde(default, skip_serializing_if = "AxialVector::is_zero")]
    pub angular_velocity: AxialVector,
    /// Factor in time for both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<TimeFunction>,
    /// Factor in time for the angular velocity, in place of `factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_factor: Option<TimeFunction>,
}

impl ImposedMotion {
    /// The factor of the angular velocity.
    #[must_use]
    pub fn factor_of_turn(&self) -> Option<&TimeFunction> {
        self.angular_factor.as_ref().or(self.factor.as_ref())
    }
}

/// `load_frame`: axes along which the external force and torque of a body are given.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum LoadFrame {
    /// Those of the laboratory.
    #[default]
    Laboratory,
    /// Those of the body, with which the load turns.
    Body,
}

impl LoadFrame {
    /// Whether it is that of the laboratory.
    #[must_use]
    pub fn is_laboratory(&self) -> bool {
        *self == Self::Laboratory
    }
}

/// The motions that have a word of their own.
const WORDS: &[&str] = &["held", "free", "imposed"];

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Written)
    }
}

/// Tells the two forms by their first key, so that an error is that of the form that was meant.
struct Written;

impl<'de> Visitor<'de> for Written {
    type Value = Motion;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"free\", \"held\", { imposed = ... } or { x = ..., y = ..., rotation = ... }")
    }

    fn visit_str<E: de::Error>(self, word: &str) -> Result<Motion, E> {
        match word {
            "held" => Ok(Motion::Held),
            "free" => Ok(Motion::Free),
            "imposed" => {
                let what = "`imposed` needs values of its own: write { imposed = ... } instead of \"imposed\"";
                Err(E::custom(what))
            }
            _ => Err(E::unknown_variant(word, WORDS)),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Motion, A::Error> {
        let first: Option<String> = entries.next_key()?;
        let alone = |word: &str| format!("`{word}` stands alone: it says how all motions are");
        match first.as_deref() {
            Some("imposed") => {
                let motion = entries.next_value()?;
                match entries.next_key::<String>()? {
                    Some(_) => Err(de::Error::custom(alone("imposed"))),
                    None => Ok(Motion::Imposed(motion)),
                }
            }
            Some(word @ ("held" | "free")) => Err(de::Error::custom(alone(word))),
            _ => {
                let deserializer = MapAccessDeserializer::new(Peeked { first, entries });
                let motions = MotionsByAxis::deserialize(deserializer)?;
                Ok(Motion::ByAxis(Box::new(motions)))
            }
        }
    }
}

/// Entries of which the first key has been looked at.
struct Peeked<A> {
    first: Option<String>,
    entries: A,
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Peeked<A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, A::Error> {
        let Some(first) = self.first.take() else { return self.entries.next_key_seed(seed) };
        let deserializer: StringDeserializer<A::Error> = first.into_deserializer();
        seed.deserialize(deserializer).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, A::Error> {
        self.entries.next_value_seed(seed)
    }
}
