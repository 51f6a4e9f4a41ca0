//! `Kinematics`: what a law asks of a deformation, its volume ratio and cofactor alone or its singular values.

use super::direct::Direct;
use super::parts::TangentParts;
use super::{Curvature, Lame, Law, Principal, Stress, Tangent, Tensor};

/// A deformation gradient, made ready for a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kinematics {
    /// For laws that are functions of the deformation itself: no singular values have to be found.
    Direct(Direct),
    /// For laws of the principal stretches.
    Principal(Principal),
}

impl Kinematics {
    /// That of a deformation gradient for a law; none for a deformation without volume.
    #[must_use]
    pub fn of(law: Law, deformation: &Tensor) -> Option<Self> {
        if Direct::serves(law) {
            Direct::of(deformation).map(Self::Direct)
        } else {
            Principal::of(deformation).map(Self::Principal)
        }
    }

    /// Volume ratio J.
    #[must_use]
    pub fn volume(&self) -> f64 {
        match self {
            Self::Direct(direct) => direct.volume(),
            Self::Principal(principal) => principal.volume(),
        }
    }

    /// Derivatives J F^-T of the volume ratio by the deformation gradient.
    #[must_use]
    pub fn cofactor(&self) -> Tensor {
        match self {
            Self::Direct(direct) => direct.cofactor(),
            Self::Principal(principal) => principal.cofactor(),
        }
    }

    /// Elastic energy a volume at rest (J/m3) and first Piola-Kirchhoff stress (Pa), by the law it was made for.
    #[must_use]
    pub fn stress(&self, law: Law, lame: Lame) -> Stress {
        match self {
            Self::Direct(direct) => direct.stress(law, lame),
            Self::Principal(principal) => principal.stress(law, lame),
        }
    }

    /// Derivatives of the stress by the shear modulus and by lambda.
    #[must_use]
    pub fn stress_by_moduli(&self, law: Law) -> [Tensor; 2] {
        match self {
            Self::Direct(direct) => direct.stress_by_moduli(law),
            Self::Principal(principal) => principal.stress_by_moduli(law),
        }
    }

    /// The same derivatives as [`Self::tangent`] by what they are made of, where that is known: for laws that are
    /// functions of the deformation itself, the positive part aside.
    pub(crate) fn parts(
        &self,
        law: Law,
        lame: Lame,
        pressure: Option<f64>,
        curvature: Curvature,
    ) -> Option<TangentParts> {
        match self {
            Self::Direct(direct) if curvature == Curvature::True => {
                Some(direct.tangent(law, lame, pressure.unwrap_or(0.0)))
            }
            _ => None,
        }
    }

    /// Derivatives of the stress by the deformation gradient (Pa), of an energy less a pressure (Pa) times the volume
    /// ratio where there is one.
    #[must_use]
    pub fn tangent(
        &self,
        law: Law,
        lame: Lame,
        pressure: Option<f64>,
        curvature: Curvature,
    ) -> Tangent {
        let by = |principal: &Principal| match pressure {
            Some(pressure) => principal.tangent_under(law, lame, pressure, curvature),
            None => principal.tangent(law, lame, curvature),
        };
        match self {
            Self::Principal(principal) => by(principal),
            Self::Direct(direct) => {
                // The positive part is known in the principal frame alone
                let frame = (curvature == Curvature::Positive)
                    .then(|| Principal::of(direct.gradient()))
                    .flatten();
                let whole = || direct.tangent(law, lame, pressure.unwrap_or(0.0)).whole();
                frame.as_ref().map_or_else(whole, by)
            }
        }
    }
}
