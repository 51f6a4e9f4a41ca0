//! `Units`: the units of the numbers of a case, as a text or as a table of labels.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Deserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

/// Most characters of a unit.
const LONGEST: usize = 16;

/// The consistent units of all numbers: printed and drawn, never converted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Units {
    /// What they are, in words: `dimensionless`, `SI`, `cm g s`, ...
    Words(String),
    /// Labels of units, such as `{ length = "um", time = "s", force = "pN" }`.
    Labels(UnitLabels),
}

/// Labels of units; each is drawn where it is known.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct UnitLabels {
    /// Unit of lengths, such as `um`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<String>,
    /// Unit of times, such as `s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// Unit of forces, such as `pN`; in the plane forces are given per unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<String>,
}

/// A label as it may be given.
#[derive(Debug, Clone, Copy)]
pub struct UnitLabel<'a> {
    /// Its key.
    pub key: &'static str,
    /// The unit, if it is given.
    pub unit: Option<&'a str>,
}

impl UnitLabels {
    /// All labels there may be.
    pub fn each(&self) -> [UnitLabel<'_>; 3] {
        let Self { length, time, force } = self;
        let label = |key, unit| UnitLabel { key, unit };
        [
            label("length", length.as_deref()),
            label("time", time.as_deref()),
            label("force", force.as_deref()),
        ]
    }
}

impl Default for Units {
    fn default() -> Self {
        Self::Words("dimensionless".to_owned())
    }
}

impl fmt::Display for Units {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Words(text) => formatter.write_str(text),
            Self::Labels(labels) => {
                let told = |label: UnitLabel<'_>| Some(format!("{} {}", label.key, label.unit?));
                let parts: Vec<_> = labels.each().into_iter().filter_map(told).collect();
                formatter.write_str(&parts.join(", "))
            }
        }
    }
}

/// What is wrong with a unit, if anything: it is a word to be drawn behind a number.
pub fn defect(unit: &str) -> Option<&'static str> {
    let first = unit.chars().next()?;
    if unit.trim() != unit || unit.chars().any(char::is_control) {
        return Some("has blanks or line breaks around it");
    }
    if first.is_ascii_digit() || "+-.".contains(first) {
        return Some("begins with a number, and numbers are not converted");
    }
    (unit.chars().count() > LONGEST).then_some("is too long for a label")
}

impl<'de> Deserialize<'de> for Units {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AsUnits;

        impl<'de> Visitor<'de> for AsUnits {
            type Value = Units;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str(
                    "a text, such as \"SI\", or a table, such as { length = \"um\", time = \"s\" }",
                )
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Units, E> {
                Ok(Units::Words(text.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Units, A::Error> {
                UnitLabels::deserialize(MapAccessDeserializer::new(map)).map(Units::Labels)
            }
        }

        deserializer.deserialize_any(AsUnits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Case, Severity, check};

    const REST: &str = r#"
title = "a disc"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.disc.radius = 5.0
boundary.wall = "no-slip"
mesh = { size = 1.0, surface = 0.3 }
time.steady = {}
"#;

    fn read(units: &str) -> Result<crate::CaseFile, String> {
        Case::parse("disc", &format!("units = {units}\n{REST}"), &[])
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_text_and_labels_are_written_as_they_were_read() {
        let labels = "{ length = \"um\", time = \"s\", force = \"pN\" }";
        for (text, told) in [
            ("\"SI\"", "SI"),
            ("{ length = \"mm\" }", "length mm"),
            (labels, "length um, time s, force pN"),
        ] {
            let file = read(text).unwrap();
            let case = file.case();
            assert_eq!(case.units.to_string(), told);
            let again = Case::parse("again", &case.to_toml().unwrap(), &[]).unwrap();
            assert_eq!(again.case(), case);
        }
        let none = Case::parse("disc", REST, &[]).unwrap();
        assert_eq!(none.case().units.to_string(), "dimensionless");
    }

    #[test]
    fn what_is_no_label_is_refused_where_it_stands() {
        for (text, key, message) in [
            ("{ length = \"\" }", "units.length", "is empty"),
            ("{ length = \"10 um\" }", "units.length", "begins with a number"),
            ("{ time = \"s \" }", "units.time", "has blanks"),
            ("{ time = \"1/s\" }", "units.time", "begins with a number"),
            ("{ force = \"piconewtons per metre\" }", "units.force", "is too long"),
            ("{}", "units", "names no unit"),
        ] {
            let file = read(text).unwrap();
            let found = check(&file);
            let error = found.iter().find(|one| one.severity == Severity::Error).unwrap();
            assert_eq!(error.key, key);
            assert!(error.message.contains(message), "{}", error.message);
            assert!(error.location.is_some() && error.help.contains("um"), "{}", error.help);
        }
        for good in ["µm", "body lengths", "a", "L/D"] {
            assert_eq!(defect(good), None);
        }
    }

    #[test]
    fn other_keys_and_types_are_told_with_what_is_accepted() {
        let error = read("{ lenght = \"um\" }").unwrap_err();
        assert!(error.contains("lenght") && error.contains("length"), "{error}");
        let error = read("{ length = 1.0 }").unwrap_err();
        assert!(error.contains("units.length"), "{error}");
        let error = read("3.0").unwrap_err();
        assert!(error.contains("length = \"um\""), "{error}");
    }
}
