//! `rod.load`: forces and moments at the ends of a rod.

use std::fmt;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::spec::body::stroke::Stroke;

/// `load`: what is given at the ends of a rod.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EndLoads {
    /// At its head, where nothing holds that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<EndLoadSpec>,
    /// At its tail.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip: Option<EndLoadSpec>,
}

/// `base`, `tip`: the load at an end of a rod.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EndLoadSpec {
    /// Force along x and y, and in space z, of `frame` (N; N/m planar).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub force: Vec<Stroke>,
    /// Moment (N m; N planar): positive where it turns the end counter-clockwise, in space a list about x, y and z of `frame`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment: Option<EndMoment>,
    /// Axes along which both are given.
    #[serde(default, skip_serializing_if = "EndFrame::is_laboratory")]
    pub frame: EndFrame,
}

/// `frame`: axes along which the load at an end of a rod is given.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum EndFrame {
    /// Those of the laboratory: the load keeps its direction.
    #[default]
    Laboratory,
    /// Those of the straight body, as the section at the end carries them along: x goes on from the tail to the head, and a
    /// force along it at the tail is a compressive follower force.
    End,
}

/// A moment in time: about the normal of the plane, or about three axes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum EndMoment {
    /// Counter-clockwise (N).
    Planar(Stroke),
    /// About x, y and z (N m).
    Spatial(Vec<Stroke>),
}

/// An end of a rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RodEnd {
    /// Its head.
    Base,
    /// Its tail.
    Tip,
}

/// An end with the load that is given there, `L` lent for good or for a while.
#[derive(Debug)]
pub struct LoadedEnd<L> {
    /// Which end.
    pub end: RodEnd,
    /// The load.
    pub load: L,
}

impl RodEnd {
    /// Its key.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Base => "base",
            Self::Tip => "tip",
        }
    }
}

impl EndFrame {
    /// Whether it is that of the laboratory.
    #[must_use]
    pub fn is_laboratory(&self) -> bool {
        *self == Self::Laboratory
    }
}

impl EndLoadSpec {
    /// All that is given in time.
    pub fn strokes(&self) -> impl Iterator<Item = &Stroke> {
        self.force.iter().chain(self.moment.iter().flat_map(EndMoment::components))
    }
}

impl EndMoment {
    /// Its components: the one of the plane, or those about x, y and z.
    #[must_use]
    pub fn components(&self) -> &[Stroke] {
        match self {
            Self::Planar(moment) => std::slice::from_ref(moment),
            Self::Spatial(moments) => moments,
        }
    }

    /// The same, to be changed.
    pub(crate) fn components_mut(&mut self) -> &mut [Stroke] {
        match self {
            Self::Planar(moment) => std::slice::from_mut(moment),
            Self::Spatial(moments) => moments,
        }
    }
}

impl<'de> Deserialize<'de> for EndMoment {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EndMomentVisitor)
    }
}

/// Tells the two forms by their type, so that an error is that of the form that was meant.
struct EndMomentVisitor;

impl<'de> Visitor<'de> for EndMomentVisitor {
    type Value = EndMoment;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a function of time, in space a list of three,")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<EndMoment, A::Error> {
        let stroke = Stroke::deserialize(MapAccessDeserializer::new(&mut map))?;
        match map.next_key::<String>()? {
            None => Ok(EndMoment::Planar(stroke)),
            Some(key) => Err(de::Error::custom(format!("`{key}` is a second function of time"))),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, components: A) -> Result<EndMoment, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(components)).map(EndMoment::Spatial)
    }
}

impl EndLoads {
    /// The ends at which loads are given.
    pub fn ends(&self) -> impl Iterator<Item = LoadedEnd<&EndLoadSpec>> {
        let ends = [(RodEnd::Base, &self.base), (RodEnd::Tip, &self.tip)];
        ends.into_iter().filter_map(|(end, load)| Some(LoadedEnd { end, load: load.as_ref()? }))
    }

    /// The same, to be changed.
    pub(crate) fn ends_mut(&mut self) -> impl Iterator<Item = LoadedEnd<&mut EndLoadSpec>> {
        let ends = [(RodEnd::Base, &mut self.base), (RodEnd::Tip, &mut self.tip)];
        ends.into_iter().filter_map(|(end, load)| Some(LoadedEnd { end, load: load.as_mut()? }))
    }
}
