//! `rod`, `attached` and `activation`: slender bodies that bend as their elasticity and their muscles let them.

mod end_loads;

use std::fmt;

use serde::de::value::SeqAccessDeserializer;
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

pub use self::end_loads::{EndFrame, EndLoadSpec, EndLoads, EndMoment, LoadedEnd, RodEnd};
use super::stroke::Stroke;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// `rod`: the body bends about its midline as an elastic rod.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RodSpec {
    /// Bending stiffness (N m2; N m planar); instead of `young`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending: Option<AlongBody>,
    /// Young's modulus (Pa), in planar cases over 1 - nu2, from which the stiffness follows by the sections.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub young: Option<f64>,
    /// Stiffness in twist (N m2, spatial); that of a material that keeps its volume if absent, two thirds of `bending` of round
    /// sections.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    pub twisting: Option<AlongBody>,
    /// Tension over stretch (N; N/m planar); 1e7 times bending stiffness over squared length if absent, which keeps the
    /// length, at most 1e9 times the drag of what moves by that length in a step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<Positive>"))]
    pub stretching: Option<f64>,
    /// Time over which bending relaxes (s): the moment of damping is stiffness times this times the rate of the curvature.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "NonNegative"))]
    pub damping: f64,
    /// Whether its tail is joined to its own head a period of the domain further: a sheet without ends, of which the slit
    /// between both is part.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    pub periodic: bool,
    /// Number of elements along the body.
    #[serde(default = "elements")]
    #[cfg_attr(test, schemars(range(min = 2, max = 1000)))]
    pub elements: usize,
    /// Shape without loads; straight if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<RestShape>,
    /// Forces and moments that are given at its ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<EndLoads>,
}

/// `rest`: the shape of a rod without loads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum RestShape {
    /// The same curvature everywhere (1/m), positive where the body turns counter-clockwise from head to tail.
    Curvature(f64),
    /// [distance from the head (m), curvature (1/m)], joined by straight lines.
    Table(Vec<[f64; 2]>),
    /// Rates (1/m, spatial) at which sections turn from head to tail about the x, y and z axes of the straight body, which they carry along:
    /// twist, and bending about y and z. All of them make a helix.
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    Turning([f64; 3]),
}

/// A positive number, or one that changes along the body.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum AlongBody {
    /// The same everywhere.
    Constant(#[cfg_attr(test, schemars(with = "Positive"))] f64),
    /// [distance from the head (m), value], joined by straight lines.
    Table(Vec<[f64; 2]>),
}

/// `attached`: what holds the head of a rod.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Attached {
    /// Name of the body it is attached to, as it is at the start; the laboratory if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// What is given of it.
    pub hold: Hold,
}

/// `hold`: what is given of an end of a rod that is attached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Hold {
    /// Its place and its direction.
    Clamped,
    /// Its place.
    Hinged,
    /// Its place, and the angle by which it is turned from its direction at rest (rad).
    Angle(#[serde(deserialize_with = "crate::text::angle::deserialize")] Stroke),
}

/// `activation`: muscles or motors within a rod: stroke(t - s / wave_speed) times the envelope at the distance s from the
/// head.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Activation {
    /// Curvature (1/m) that is added to that at rest; instead of `moment`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curvature: Option<Stroke>,
    /// Moment (N m; N planar) that bends the body counter-clockwise from head to tail.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment: Option<Stroke>,
    /// The same curvature about the body's y (1/m, spatial), beside `curvature`, which is about z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    pub curvature_y: Option<Stroke>,
    /// The same moment about the body's y (N m, spatial), beside `moment`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["spatial"])))]
    pub moment_y: Option<Stroke>,
    /// Speed of the wave from head to tail (m/s), negative from tail to head; at once everywhere if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<crate::spec::number::NonZero>"))]
    pub wave_speed: Option<f64>,
    /// [distance from the head (m), factor], joined by straight lines; 1 everywhere if absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub envelope: Vec<[f64; 2]>,
}

fn elements() -> usize {
    24
}

impl RestShape {
    /// The curvature about z at a distance from the head (m): 1/m.
    #[must_use]
    pub fn at(&self, along: f64) -> f64 {
        let rows = match self {
            Self::Curvature(curvature) => return *curvature,
            Self::Turning([_, _, about_z]) => return *about_z,
            Self::Table(rows) => rows,
        };
        let next = rows.partition_point(|row| row[0] <= along);
        match (next.checked_sub(1).and_then(|last| rows.get(last)), rows.get(next)) {
            (Some([from, start]), Some([to, end])) => {
                start + (end - start) * (along - from) / (to - from)
            }
            (Some([_, value]), None) | (None, Some([_, value])) => *value,
            (None, None) => 0.0,
        }
    }

    /// Largest |curvature| (1/m).
    #[must_use]
    pub fn sharpest(&self) -> f64 {
        match self {
            Self::Curvature(curvature) => curvature.abs(),
            Self::Turning([_, about_y, about_z]) => about_y.hypot(*about_z),
            Self::Table(rows) => rows.iter().map(|row| row[1].abs()).fold(0.0, f64::max),
        }
    }
}

impl Activation {
    /// The time after which it begins again (s), if it does.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        self.strokes().find_map(Stroke::period)
    }

    /// All that is given in time.
    pub fn strokes(&self) -> impl Iterator<Item = &Stroke> {
        [&self.curvature, &self.moment, &self.curvature_y, &self.moment_y].into_iter().flatten()
    }
}

impl<'de> Deserialize<'de> for AlongBody {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AlongBodyVisitor)
    }
}

/// Tells the two forms by their type, so that an error is that of the form that was meant.
struct AlongBodyVisitor;

impl<'de> Visitor<'de> for AlongBodyVisitor {
    type Value = AlongBody;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or [[distance from the head, value], ...],")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<AlongBody, E> {
        Ok(AlongBody::Constant(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<AlongBody, E> {
        Ok(AlongBody::Constant(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<AlongBody, E> {
        Ok(AlongBody::Constant(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, rows: A) -> Result<AlongBody, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(rows)).map(AlongBody::Table)
    }
}
