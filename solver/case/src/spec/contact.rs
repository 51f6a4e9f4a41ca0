//! `[contact]`: the short-range force that keeps bodies apart from each other and from walls.

#[cfg(test)]
use crate::spec::number::Positive;
use serde::{Deserialize, Serialize};

/// `[contact.quadratic]` or `[contact.barrier]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ContactSpec {
    /// Force (range - gap)^2 / epsilon where the gap is below the range; finite at contact.
    Quadratic {
        /// Gap at which the force begins (m); about a cell on the surface is usual.
        #[cfg_attr(test, schemars(with = "Positive"))]
        range: f64,
        /// Small number that makes the force strong (m2/N; m3/N in planar cases).
        #[cfg_attr(test, schemars(with = "Positive"))]
        epsilon: f64,
    },
    /// Energy -stiffness (gap - range)^2 ln(gap / range) where the gap is below the range; its
    /// force has no bound at contact.
    Barrier {
        /// Gap at which the force begins (m); about a cell on the surface is usual.
        #[cfg_attr(test, schemars(with = "Positive"))]
        range: f64,
        /// Strength (N/m; N/m2 in planar cases).
        #[cfg_attr(test, schemars(with = "Positive"))]
        stiffness: f64,
    },
}

impl ContactSpec {
    /// Gap at which the force begins (m).
    #[must_use]
    pub fn range(&self) -> f64 {
        let (Self::Quadratic { range, .. } | Self::Barrier { range, .. }) = self;
        *range
    }
}
