//! `Law`: elastic energies as functions of the principal stretches, each linear in Lamé's moduli.

use num_dual::DualNum;

use super::Tensor;
use super::pairs::{Moduli, PAIRS};
use super::volume::nearest_of_unit_volume;

/// Lamé's moduli (Pa), in that order: the shear modulus mu, and lambda.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lame {
    /// Shear modulus mu.
    pub shear: f64,
    /// Lambda: what a change of volume costs beyond the shear modulus.
    pub volume: f64,
}

/// An isotropic elastic law. With the principal stretches s_i, the volume ratio J = s_1 s_2 s_3 and Lamé's
/// moduli mu and lambda, its energy a volume at rest (J/m3) is as follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// mu sum e_i^2 + lambda/2 (sum e_i)^2, with e_i = (s_i^2 - 1)/2. It gives way in compression: for
    /// benchmarks and small strains.
    SaintVenantKirchhoff,
    /// mu/2 (sum s_i^2 - 3 - 2 ln J) + lambda/2 ln^2 J.
    NeoHookean,
    /// mu sum (s_i - 1)^2 + lambda/2 (J - 1)^2.
    Corotated,
    /// mu sum (s_i - 1)^2 + lambda/2 d^2, where d is the distance of the stretches from those of volume ratio
    /// one. For small strains d^2 is a third of the squared trace: its volume term is **a third** of Hooke's,
    /// as in the code it is compared with (@du2021).
    CorotatedVolume,
}

/// Energies by the shear modulus and by lambda, and their derivatives by the stretches.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstOrder {
    pub energies: [f64; 2],
    pub stresses: [[f64; 3]; 2],
}

/// Sum of two stretches at least, in moduli: it vanishes in a cell that is turned over.
const LEAST: f64 = 1e-3;

impl Law {
    /// The energies a volume by shear modulus and by lambda: with the moduli, their sum is the energy.
    pub(super) fn energies<T: DualNum<Primitive = f64> + Copy>(self, stretches: [T; 3]) -> [T; 2] {
        let [a, b, c] = stretches;
        let volume = a * b * c;
        let sum = |part: fn(T) -> T| part(a) + part(b) + part(c);
        match self {
            Self::SaintVenantKirchhoff => {
                let strain = |s: T| (s * s - 1.0) * 0.5;
                let trace = sum(strain);
                let squares = sum(|s| ((s * s - 1.0) * 0.5).powi(2));
                [squares, trace * trace * 0.5]
            }
            Self::NeoHookean => {
                let log = volume.ln();
                [(sum(|s| s * s - 1.0) - log * 2.0) * 0.5, log * log * 0.5]
            }
            Self::Corotated => [sum(|s| (s - 1.0).powi(2)), (volume - 1.0).powi(2) * 0.5],
            Self::CorotatedVolume => {
                let nearest = nearest_of_unit_volume(stretches);
                let apart = |i: usize| (stretches[i] - nearest[i]).powi(2);
                [sum(|s| (s - 1.0).powi(2)), (apart(0) + apart(1) + apart(2)) * 0.5]
            }
        }
    }

    /// The energies with their derivatives by the stretches.
    pub(super) fn first_order(self, s: [f64; 3]) -> FirstOrder {
        if self == Self::CorotatedVolume {
            // Where it is nearest is found once for both
            let nearest = nearest_of_unit_volume(s);
            let apart: [f64; 3] = std::array::from_fn(|i| s[i] - nearest[i]);
            let square = |a: [f64; 3]| a.iter().map(|a| a * a).sum::<f64>();
            return FirstOrder {
                energies: [square(s.map(|s| s - 1.0)), 0.5 * square(apart)],
                stresses: [s.map(|s| 2.0 * (s - 1.0)), apart],
            };
        }
        FirstOrder { energies: self.energies(s), stresses: self.stresses(s) }
    }

    /// Derivatives of the energies by the stretches.
    fn stresses(self, s: [f64; 3]) -> [[f64; 3]; 2] {
        let volume: f64 = s.iter().product();
        match self {
            Self::SaintVenantKirchhoff => {
                let strain = s.map(|s| 0.5 * (s * s - 1.0));
                let trace: f64 = strain.iter().sum();
                [std::array::from_fn(|i| 2.0 * strain[i] * s[i]), s.map(|s| trace * s)]
            }
            Self::NeoHookean => {
                let log = volume.ln();
                [s.map(|s| s - 1.0 / s), s.map(|s| log / s)]
            }
            Self::Corotated => [s.map(|s| 2.0 * (s - 1.0)), s.map(|s| (volume - 1.0) * volume / s)],
            Self::CorotatedVolume => {
                let nearest = nearest_of_unit_volume(s);
                [s.map(|s| 2.0 * (s - 1.0)), std::array::from_fn(|i| s[i] - nearest[i])]
            }
        }
    }

    /// Second derivatives by the stretches, and the moduli of pairs of them, free of differences of numbers
    /// that are nearly equal.
    pub(super) fn moduli(self, s: [f64; 3], Lame { shear: mu, volume: la }: Lame) -> Moduli {
        let volume: f64 = s.iter().product();
        let third = |pair: usize| s[2 - pair];
        let pairs = |value: &dyn Fn(f64, f64, usize) -> f64| -> [f64; 3] {
            std::array::from_fn(|pair| value(s[PAIRS[pair][0]], s[PAIRS[pair][1]], pair))
        };
        let entries = |value: &dyn Fn(usize, usize) -> f64| Tensor::from_fn(value);
        let same = |i: usize, j: usize, value: f64| if i == j { value } else { 0.0 };
        match self {
            Self::SaintVenantKirchhoff => {
                let trace: f64 = s.iter().map(|s| 0.5 * (s * s - 1.0)).sum();
                Moduli {
                    stretch: entries(&|i, j| {
                        la * s[i] * s[j] + same(i, j, mu * (3.0 * s[i] * s[i] - 1.0) + la * trace)
                    }),
                    twist: pairs(&|a, b, _| la * trace + mu * (a * a + a * b + b * b - 1.0)),
                    flip: pairs(&|a, b, _| la * trace + mu * (a * a - a * b + b * b - 1.0)),
                }
            }
            Self::NeoHookean => {
                let pressure = mu - la * volume.ln();
                Moduli {
                    stretch: entries(&|i, j| {
                        la / (s[i] * s[j]) + same(i, j, mu + pressure / (s[i] * s[i]))
                    }),
                    twist: pairs(&|a, b, _| mu + pressure / (a * b)),
                    flip: pairs(&|a, b, _| mu - pressure / (a * b)),
                }
            }
            Self::Corotated => Moduli {
                stretch: entries(&|i, j| {
                    let mixed = if i == j { volume } else { 2.0 * volume - 1.0 };
                    la * volume * mixed / (s[i] * s[j]) + same(i, j, 2.0 * mu)
                }),
                twist: pairs(&|_, _, pair| 2.0 * mu - la * (volume - 1.0) * third(pair)),
                flip: pairs(&|a, b, pair| {
                    2.0 * mu * (a + b - 2.0) / (a + b).max(LEAST)
                        + la * (volume - 1.0) * third(pair)
                }),
            },
            Self::CorotatedVolume => {
                let near = nearest_of_unit_volume(s);
                let weight: [f64; 3] = std::array::from_fn(|i| 1.0 / (s[i] - 2.0 * near[i]));
                let sum: f64 = (0..3).map(|i| weight[i] / near[i]).sum();
                Moduli {
                    // d near_i / d s_j from near_i (s_i - near_i) = kappa and a volume of one
                    stretch: entries(&|i, j| {
                        let moved = weight[i] * (weight[j] / sum - same(i, j, near[i]));
                        same(i, j, 2.0 * mu + la) - la * moved
                    }),
                    twist: pairs(&|_, _, pair| {
                        let [i, j] = PAIRS[pair];
                        2.0 * mu + la * (1.0 - near[i] / (near[i] + near[j] - s[j]))
                    }),
                    flip: pairs(&|a, b, pair| {
                        let [i, j] = PAIRS[pair];
                        (2.0 * mu * (a + b - 2.0) + la * (a - near[i] + b - near[j]))
                            / (a + b).max(LEAST)
                    }),
                }
            }
        }
    }
}
