//! `ViscositySpec`: a viscosity as a number, or the law by which it depends on the rate of shear.

use std::fmt;

use serde::de::{self, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// A plain number is the dynamic viscosity (Pa s) of a Newtonian fluid; else one law of the rate of shear
/// g = sqrt(2 D : D).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(with = "Written"))]
pub enum ViscositySpec {
    /// The same at all rates (Pa s).
    Newtonian(f64),
    /// A law of the rate of shear.
    Law(ShearLaw),
}

/// How the viscosity depends on the rate of shear g (1/s).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ShearLaw {
    /// infinite + (zero - infinite) (1 + (time g)^2)^((index - 1) / 2).
    Carreau(Plateaus),
    /// infinite + (zero - infinite) / (1 + (time g)^(1 - index)), with an index below 1.
    Cross(Plateaus),
    /// consistency G^(index - 1), with G^2 = g^2 + regularised^2.
    PowerLaw(PowerLaw),
    /// yield_stress / G + consistency G^(index - 1), with G^2 = g^2 + regularised^2.
    HerschelBulkley(HerschelBulkley),
}

/// A law between two constant viscosities.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Plateaus {
    /// Viscosity at small rates (Pa s).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub zero: f64,
    /// Viscosity at large rates (Pa s), not above `zero`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub infinite: f64,
    /// Time (s), the inverse of the rate from which the fluid is thinned.
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub time: f64,
    /// Power of the rate in the stress between the two (1): below 1 the fluid is thinned by shear.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub index: f64,
}

/// A power of the rate of shear.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PowerLaw {
    /// Factor of the power (Pa s^index).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub consistency: f64,
    /// Power of the rate in the stress (1).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub index: f64,
    /// Rate of shear (1/s) below which the viscosity no longer changes: far below the rates that matter.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub regularised: f64,
}

/// A power of the rate of shear beyond a yield stress.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HerschelBulkley {
    /// Stress below which the fluid hardly flows (Pa).
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub yield_stress: f64,
    /// Factor of the power (Pa s^index).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub consistency: f64,
    /// Power of the rate in the stress (1).
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub index: f64,
    /// Rate of shear (1/s) below which the viscosity no longer changes: far below the rates that matter.
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub regularised: f64,
}

/// How it is written.
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "the schema is derived from it")]
enum Written {
    /// The same at all rates of shear (Pa s).
    Newtonian(#[schemars(with = "Positive")] f64),
    /// A law of the rate of shear.
    Law(ShearLaw),
}

impl ViscositySpec {
    /// The viscosity (Pa s) that numbers of a case are made of: of a law between two plateaus that at small rates, of
    /// powers that at a rate of shear (1/s).
    #[must_use]
    pub fn reference(&self, rate: f64) -> f64 {
        match self {
            Self::Newtonian(viscosity) => *viscosity,
            Self::Law(ShearLaw::Carreau(law) | ShearLaw::Cross(law)) => law.zero,
            Self::Law(ShearLaw::PowerLaw(law)) => {
                law.consistency * rate.hypot(law.regularised).powf(law.index - 1.0)
            }
            Self::Law(ShearLaw::HerschelBulkley(law)) => {
                let rate = rate.hypot(law.regularised);
                law.yield_stress / rate + law.consistency * rate.powf(law.index - 1.0)
            }
        }
    }

    /// The law, if it is one.
    #[must_use]
    pub fn law(&self) -> Option<&ShearLaw> {
        if let Self::Law(law) = self { Some(law) } else { None }
    }
}

impl ShearLaw {
    /// Its key.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Carreau(_) => "carreau",
            Self::Cross(_) => "cross",
            Self::PowerLaw(_) => "power-law",
            Self::HerschelBulkley(_) => "herschel-bulkley",
        }
    }

    /// Power of the rate in the stress (1).
    #[must_use]
    pub fn index(&self) -> f64 {
        match self {
            Self::Carreau(law) | Self::Cross(law) => law.index,
            Self::PowerLaw(law) => law.index,
            Self::HerschelBulkley(law) => law.index,
        }
    }
}

impl Serialize for ViscositySpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Newtonian(viscosity) => viscosity.serialize(serializer),
            Self::Law(law) => law.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for ViscositySpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SpecVisitor)
    }
}

/// Names of the laws.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum LawName {
    Carreau,
    Cross,
    PowerLaw,
    HerschelBulkley,
}

/// Tells a number and a law by their type, so that an error is that of the form that was meant.
struct SpecVisitor;

impl<'de> Visitor<'de> for SpecVisitor {
    type Value = ViscositySpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a law such as { carreau = { zero, infinite, time, index } },")
    }

    fn visit_f64<E: de::Error>(self, viscosity: f64) -> Result<ViscositySpec, E> {
        Ok(ViscositySpec::Newtonian(viscosity))
    }

    fn visit_i64<E: de::Error>(self, viscosity: i64) -> Result<ViscositySpec, E> {
        Ok(ViscositySpec::Newtonian(viscosity as f64))
    }

    fn visit_u64<E: de::Error>(self, viscosity: u64) -> Result<ViscositySpec, E> {
        Ok(ViscositySpec::Newtonian(viscosity as f64))
    }

    /// A text is a number that was put in quotes, or written with its unit.
    fn visit_str<E: de::Error>(self, text: &str) -> Result<ViscositySpec, E> {
        Err(E::invalid_type(Unexpected::Str(text), &"a number"))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<ViscositySpec, A::Error> {
        let one = "exactly one law is wanted: carreau, cross, power-law or herschel-bulkley";
        let Some(name) = entries.next_key::<LawName>()? else {
            return Err(de::Error::custom(format!("the table is empty, but {one}")));
        };
        let law = match name {
            LawName::Carreau => ShearLaw::Carreau(entries.next_value()?),
            LawName::Cross => ShearLaw::Cross(entries.next_value()?),
            LawName::PowerLaw => ShearLaw::PowerLaw(entries.next_value()?),
            LawName::HerschelBulkley => ShearLaw::HerschelBulkley(entries.next_value()?),
        };
        if entries.next_key::<LawName>()?.is_some() {
            return Err(de::Error::custom(format!("there are several laws, but {one}")));
        }
        Ok(ViscositySpec::Law(law))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Case;
    use crate::read::library;

    fn read(viscosity: &str) -> Result<ViscositySpec, String> {
        let settings = [format!("fluid.viscosity={viscosity}")];
        let file =
            Case::read("squirmer-unbounded", &settings).map_err(|error| error.to_string())?;
        Ok(file.model.case.fluid.viscosity)
    }

    #[test]
    fn a_number_stays_a_number() {
        assert!(library::list().len() > 1);
        assert_eq!(read("2"), Ok(ViscositySpec::Newtonian(2.0)));
        assert_eq!(serde_json::to_string(&ViscositySpec::Newtonian(2.5)).unwrap(), "2.5");
    }

    #[test]
    fn each_law_is_read_and_written_alike() {
        for text in [
            "{ carreau = { zero = 1.0, infinite = 0.1, time = 2.0, index = 0.25 } }",
            "{ cross = { zero = 1.0, time = 2.0, index = 0.25 } }",
            "{ power-law = { consistency = 1.0, index = 0.5, regularised = 1e-3 } }",
            "{ herschel-bulkley = { yield_stress = 1.0, consistency = 1.0, index = 0.5, \
             regularised = 1e-3 } }",
        ] {
            let law = read(text).unwrap();
            let written = serde_json::to_value(law).unwrap();
            assert_eq!(serde_json::from_value::<ViscositySpec>(written).unwrap(), law, "{text}");
            let name = law.law().map(ShearLaw::name).unwrap();
            assert!(text.contains(name) && law.reference(1.0) > 0.0, "{text}");
        }
    }

    #[test]
    fn what_is_no_law_is_refused_with_what_is_one() {
        let plateaus = "{ zero = 1.0, time = 1.0, index = 0.5 }";
        for (text, said) in [
            ("{}", "exactly one law"),
            (&format!("{{ careau = {plateaus} }}")[..], "carreau"),
            (&format!("{{ carreau = {plateaus}, cross = {plateaus} }}")[..], "exactly one law"),
            ("{ carreau = { zero = 1.0, time = 1.0 } }", "index"),
            ("[1.0]", "a number, or a law"),
            ("true", "a number, or a law"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
