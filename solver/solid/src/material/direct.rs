//! `Direct`: stress and tangent of laws that are functions of the deformation itself, without its principal frame.

use super::parts::{Dyad, TangentParts};
use super::{Lame, Law, Stress, Tensor, green};

/// A deformation gradient F with its volume ratio J and what follows from these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direct {
    /// F.
    gradient: Tensor,
    /// J F^-T, the derivatives of J by F.
    cofactor: Tensor,
    /// J.
    volume: f64,
    /// ln J; no number in a cell that is turned over.
    log_volume: f64,
}

impl Direct {
    /// Whether a law is one of these: Saint-Venant and Kirchhoff's, and the neo-Hookean one.
    #[must_use]
    pub(super) fn serves(law: Law) -> bool {
        matches!(law, Law::NeoHookean | Law::SaintVenantKirchhoff)
    }

    /// That of a deformation gradient; none for one without volume.
    #[must_use]
    pub(super) fn of(gradient: &Tensor) -> Option<Self> {
        let f = gradient;
        let minor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (OTHERS[i], OTHERS[j]);
            f[(a, c)] * f[(b, d)] - f[(a, d)] * f[(b, c)]
        };
        let cofactor = Tensor::from_fn(minor);
        let volume: f64 = (0..3).map(|j| f[(0, j)] * cofactor[(0, j)]).sum();
        let is_some = volume != 0.0 && volume.is_finite();
        is_some.then(|| Self { gradient: *gradient, cofactor, volume, log_volume: volume.ln() })
    }

    /// F.
    pub(super) fn gradient(&self) -> &Tensor {
        &self.gradient
    }

    /// Volume ratio J.
    pub(super) fn volume(&self) -> f64 {
        self.volume
    }

    /// Derivatives J F^-T of the volume ratio by the deformation gradient.
    pub(super) fn cofactor(&self) -> Tensor {
        self.cofactor
    }

    /// Elastic energy a volume at rest and first Piola-Kirchhoff stress.
    pub(super) fn stress(&self, law: Law, lame: Lame) -> Stress {
        let Lame { shear: mu, volume: la } = lame;
        if law == Law::SaintVenantKirchhoff {
            let strain = green(&self.gradient);
            let trace = strain.trace();
            let second = strain * (2.0 * mu) + Tensor::identity() * (la * trace);
            return Stress {
                energy: mu * strain.norm_squared() + 0.5 * la * trace * trace,
                stress: self.gradient * second,
            };
        }
        let log = self.log_volume;
        Stress {
            energy: 0.5 * (mu * (self.stretched() - 2.0 * log) + la * log * log),
            stress: self.gradient * mu + self.cofactor * ((la * log - mu) / self.volume),
        }
    }

    /// The sum of squared stretches less that at rest.
    fn stretched(&self) -> f64 {
        let f = &self.gradient;
        let diagonal: f64 = (0..3).map(|i| f[(i, i)] * f[(i, i)] - 1.0).sum();
        let pairs = (0..3).flat_map(|i| OTHERS[i].map(|j| f[(i, j)] * f[(i, j)]));
        diagonal + pairs.sum::<f64>()
    }

    /// Derivatives of the stress by the shear modulus and by lambda.
    pub(super) fn stress_by_moduli(&self, law: Law) -> [Tensor; 2] {
        let units = [Lame { shear: 1.0, volume: 0.0 }, Lame { shear: 0.0, volume: 1.0 }];
        units.map(|unit| self.stress(law, unit).stress)
    }

    /// Derivatives of the stress by the deformation gradient (Pa), less those of a pressure (Pa) times the volume
    /// ratio.
    pub(super) fn tangent(&self, law: Law, lame: Lame, pressure: f64) -> TangentParts {
        let Lame { shear: mu, volume: la } = lame;
        let volume = self.volume;
        if law != Law::SaintVenantKirchhoff {
            let straight = la - pressure * volume;
            let crossed = mu - la * self.log_volume + pressure * volume;
            let inverse = Dyad { tensor: self.cofactor / volume, straight, crossed };
            return TangentParts {
                dyads: [Some(inverse), None],
                space: Tensor::identity() * mu,
                body: Tensor::zeros(),
            };
        }
        let f = &self.gradient;
        let strain = green(f);
        let part = pressure / volume;
        let kept = Dyad { tensor: self.cofactor, straight: -part, crossed: part };
        TangentParts {
            dyads: [
                Some(Dyad { tensor: *f, straight: la, crossed: mu }),
                (pressure != 0.0).then_some(kept),
            ],
            space: f * f.transpose() * mu,
            body: strain * (2.0 * mu) + Tensor::identity() * (la * strain.trace()),
        }
    }
}

/// The other two axes, in the order of a right-handed frame.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
