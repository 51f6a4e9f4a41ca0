//! `rod.load`: forces and moments at the ends of a rod.

use serde::{Deserialize, Serialize};

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
    /// Force along x and y, and in space z (N; N/m planar), whatever way the end is turned.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub force: Vec<Stroke>,
    /// Moment (N), positive where it turns the end counter-clockwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("geometries" = ["planar"])))]
    pub moment: Option<Stroke>,
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

impl EndLoadSpec {
    /// All that is given in time.
    pub fn strokes(&self) -> impl Iterator<Item = &Stroke> {
        self.force.iter().chain(&self.moment)
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
