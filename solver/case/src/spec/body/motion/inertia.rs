//! `InertiaSpec`: the inertia of a body: a moment, three of them, or a tensor.

use std::fmt;

use nalgebra::{Matrix3, Vector3};
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

#[cfg(test)]
use crate::spec::number::NonNegative;

/// Inertia about the centre of mass, in the frame of the body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum InertiaSpec {
    /// About z (kg m; planar).
    AboutZ(#[cfg_attr(test, schemars(with = "NonNegative"))] f64),
    /// About x, y and z of the body (kg m2).
    Moments(#[cfg_attr(test, schemars(with = "[NonNegative; 3]"))] [f64; 3]),
    /// The tensor, row by row (kg m2).
    Tensor([[f64; 3]; 3]),
}

impl InertiaSpec {
    /// The tensor (kg m2; kg m planar, where only the moment about z is known, and needed).
    #[must_use]
    pub fn tensor(&self) -> Matrix3<f64> {
        match self {
            Self::AboutZ(moment) => Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, *moment)),
            Self::Moments(moments) => Matrix3::from_diagonal(&Vector3::from(*moments)),
            Self::Tensor(rows) => Matrix3::from_fn(|i, j| rows[i][j]),
        }
    }
}

impl<'de> Deserialize<'de> for InertiaSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Written)
    }
}

/// Tells the forms by their types.
struct Written;

/// An entry of a list: a moment, or a row of a tensor.
#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    Moment(f64),
    Row([f64; 3]),
}

impl<'de> Visitor<'de> for Written {
    type Value = InertiaSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or in space [xx, yy, zz] or three rows of a tensor,")
    }

    fn visit_f64<E: de::Error>(self, moment: f64) -> Result<InertiaSpec, E> {
        Ok(InertiaSpec::AboutZ(moment))
    }

    fn visit_i64<E: de::Error>(self, moment: i64) -> Result<InertiaSpec, E> {
        Ok(InertiaSpec::AboutZ(moment as f64))
    }

    fn visit_u64<E: de::Error>(self, moment: u64) -> Result<InertiaSpec, E> {
        Ok(InertiaSpec::AboutZ(moment as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<InertiaSpec, A::Error> {
        let mut all = Vec::new();
        while let Some(entry) = entries.next_element::<Entry>()? {
            all.push(entry);
        }
        match all[..] {
            [Entry::Moment(x), Entry::Moment(y), Entry::Moment(z)] => {
                Ok(InertiaSpec::Moments([x, y, z]))
            }
            [Entry::Row(x), Entry::Row(y), Entry::Row(z)] => Ok(InertiaSpec::Tensor([x, y, z])),
            _ => Err(de::Error::invalid_length(all.len(), &self)),
        }
    }
}
