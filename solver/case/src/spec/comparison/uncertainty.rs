//! `Uncertainty`: how certain a value of a reference is, in its unit or in per cent of it.

use std::fmt;

use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize, Serializer};

/// How much a value may be wrong: a number in its unit, or a text such as "0.5 %" of it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(untagged))]
pub enum Uncertainty {
    /// In the unit of the value.
    Absolute(f64),
    /// In per cent of the value.
    Percent(#[cfg_attr(test, schemars(with = "PercentText"))] f64),
}

/// How per cent are written.
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[expect(dead_code, reason = "the schema is derived from it")]
struct PercentText(#[schemars(regex(pattern = r"^\s*[0-9.]+([eE][-+]?[0-9]+)?\s*%\s*$"))] String);

impl Uncertainty {
    /// In the unit of a value it is that of.
    #[must_use]
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Absolute(size) => size,
            Self::Percent(share) => 0.01 * share * value.abs(),
        }
    }
}

/// The per cent that a text says.
fn percent(text: &str) -> Option<f64> {
    let share: f64 = text.trim().strip_suffix('%')?.trim_end().parse().ok()?;
    share.is_finite().then_some(share)
}

impl fmt::Display for Uncertainty {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absolute(size) => write!(formatter, "{size}"),
            Self::Percent(share) => write!(formatter, "{share} %"),
        }
    }
}

impl Serialize for Uncertainty {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Absolute(size) => serializer.serialize_f64(*size),
            Self::Percent(_) => serializer.collect_str(self),
        }
    }
}

impl<'de> Deserialize<'de> for Uncertainty {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AsUncertainty;

        impl Visitor<'_> for AsUncertainty {
            type Value = Uncertainty;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str(
                    "a number in the unit of the value, or a text such as \"0.5 %\" of it",
                )
            }

            fn visit_f64<E: de::Error>(self, size: f64) -> Result<Uncertainty, E> {
                Ok(Uncertainty::Absolute(size))
            }

            fn visit_i64<E: de::Error>(self, size: i64) -> Result<Uncertainty, E> {
                Ok(Uncertainty::Absolute(size as f64))
            }

            fn visit_u64<E: de::Error>(self, size: u64) -> Result<Uncertainty, E> {
                Ok(Uncertainty::Absolute(size as f64))
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Uncertainty, E> {
                percent(text)
                    .map(Uncertainty::Percent)
                    .ok_or_else(|| E::invalid_value(de::Unexpected::Str(text), &self))
            }
        }

        deserializer.deserialize_any(AsUncertainty)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_absolute_and_per_cent_are_of_the_value() {
        assert_eq!(percent("0.5 %"), Some(0.5));
        assert_eq!(percent(" 1e-2%"), Some(0.01));
        for text in ["0.5", "%", "inf %", "nan%", "0.5 percent", "1 2 %"] {
            assert_eq!(percent(text), None, "{text}");
        }
        assert_eq!(Uncertainty::Absolute(0.5).of(-200.0), 0.5);
        assert_eq!(Uncertainty::Percent(0.5).of(-200.0), 1.0);
    }
}
