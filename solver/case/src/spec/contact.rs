//! `[contact]`: the short-range force that keeps bodies apart from each other and from walls.

#[cfg(test)]
use crate::spec::number::{NonNegative, Positive, UpToOne};
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
        /// Part of the velocity that is left after a rebound, from 0 to 1: a coefficient of restitution; 1 if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<UpToOne>"))]
        restitution: Option<f64>,
        /// Coefficient of friction, by Coulomb's law; none if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
        friction: Option<f64>,
        /// Speed far above which friction and restitution are what they are (m/s); a thousandth of the expected speed if
        /// absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<Positive>"))]
        slip: Option<f64>,
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
        /// Part of the velocity that is left after a rebound, from 0 to 1: a coefficient of restitution; 1 if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<UpToOne>"))]
        restitution: Option<f64>,
        /// Coefficient of friction, by Coulomb's law; none if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
        friction: Option<f64>,
        /// Speed far above which friction and restitution are what they are (m/s); a thousandth of the expected speed if
        /// absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(test, schemars(with = "Option<Positive>"))]
        slip: Option<f64>,
    },
}

/// Logarithm of the range over a gap that is none.
const LOGARITHM_OF_NO_GAP: f64 = 600.0;

/// What contact takes of the energy.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactLosses {
    /// Coefficient of restitution.
    pub restitution: Option<f64>,
    /// Coefficient of friction.
    pub friction: Option<f64>,
    /// Speed far above which both are what they are (m/s).
    pub slip: Option<f64>,
}

impl ContactLosses {
    /// Whether anything is taken.
    #[must_use]
    pub fn are_any(&self) -> bool {
        self.restitution.is_some() || self.friction.is_some()
    }
}

impl ContactSpec {
    /// Gap at which the force begins (m).
    #[must_use]
    pub fn range(&self) -> f64 {
        let (Self::Quadratic { range, .. } | Self::Barrier { range, .. }) = self;
        *range
    }

    /// What takes energy.
    #[must_use]
    pub fn losses(&self) -> ContactLosses {
        let (Self::Quadratic { restitution, friction, slip, .. }
        | Self::Barrier { restitution, friction, slip, .. }) = *self;
        ContactLosses { restitution, friction, slip }
    }

    /// Energy stored at a gap between zero and the range (J; J/m planar).
    #[must_use]
    pub fn energy(&self, gap: f64) -> f64 {
        let short = self.range() - gap;
        match self {
            Self::Quadratic { epsilon, .. } => short.powi(3) / (3.0 * epsilon),
            Self::Barrier { range, stiffness, .. } => {
                -stiffness * short * short * (gap / range).ln()
            }
        }
    }

    /// The gap at which an energy (J; J/m planar) is stored; zero where the law cannot store it.
    #[must_use]
    pub fn gap_of_energy(&self, energy: f64) -> f64 {
        // Halving the logarithm of the gap over the range
        let gap = |logarithm: f64| self.range() * (-logarithm).exp();
        let (mut near, mut far) = (LOGARITHM_OF_NO_GAP, 0.0);
        if self.energy(gap(near)) < energy {
            return 0.0;
        }
        for _ in 0..60 {
            let middle = 0.5 * (near + far);
            if self.energy(gap(middle)) > energy { near = middle } else { far = middle }
        }
        gap(far)
    }
}
