//! `Direct`: stress and tangent of laws that are functions of the deformation itself, without its principal frame.

use nalgebra::SMatrix;

use super::{Lame, Law, Stress, Tangent, Tensor, green};

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

/// Factors of tangents made of the dyad T_iJ T_kL of a tensor T, its crossed dyad T_iL T_kJ and others.
#[derive(Debug, Clone, Copy)]
struct Dyads {
    straight: f64,
    crossed: f64,
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
    pub(super) fn tangent(&self, law: Law, lame: Lame, pressure: f64) -> Tangent {
        let Lame { shear: mu, volume: la } = lame;
        let volume = self.volume;
        if law != Law::SaintVenantKirchhoff {
            let inverse = self.cofactor / volume;
            let straight = la - pressure * volume;
            let crossed = mu - la * self.log_volume + pressure * volume;
            let mut tangent = dyads(&inverse, Dyads { straight, crossed });
            (0..9).for_each(|k| tangent[(k, k)] += mu);
            return tangent;
        }
        let f = &self.gradient;
        let strain = green(f);
        let second = strain * (2.0 * mu) + Tensor::identity() * (la * strain.trace());
        let left = f * f.transpose() * mu;
        let mut tangent = dyads(f, Dyads { straight: la, crossed: mu });
        for i in 0..3 {
            for k in 0..3 {
                for j in 0..3 {
                    tangent[(3 * i + j, 3 * k + j)] += left[(i, k)];
                    tangent[(3 * i + j, 3 * i + k)] += second[(k, j)];
                }
            }
        }
        if pressure != 0.0 {
            let part = pressure / volume;
            tangent += dyads(&self.cofactor, Dyads { straight: -part, crossed: part });
        }
        tangent
    }
}

/// The other two axes, in the order of a right-handed frame.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// The sum of multiples of T_iJ T_kL and T_iL T_kJ.
fn dyads(tensor: &Tensor, Dyads { straight, crossed }: Dyads) -> Tangent {
    let t = tensor;
    let mut sum = SMatrix::<f64, 9, 9>::zeros();
    for k in 0..3 {
        for l in 0..3 {
            let one = straight * t[(k, l)];
            for i in 0..3 {
                let other = crossed * t[(i, l)];
                for j in 0..3 {
                    sum[(3 * i + j, 3 * k + l)] = one * t[(i, j)] + other * t[(k, j)];
                }
            }
        }
    }
    sum
}
