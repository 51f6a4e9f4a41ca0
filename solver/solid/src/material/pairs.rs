//! `Moduli`: second derivatives of an energy in its principal frame, and their positive part.

use nalgebra::SymmetricEigen;

use super::Tensor;

/// Pairs of principal directions; the third direction of pair k is number 2 - k.
pub(super) const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// Second derivatives of an energy in the principal frame (Pa).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// By two stretches.
    pub stretch: Tensor,
    /// (psi_i - psi_j)/(s_i - s_j) for the pairs (0, 1), (0, 2), (1, 2).
    pub twist: [f64; 3],
    /// (psi_i + psi_j)/(s_i + s_j) for the same pairs.
    pub flip: [f64; 3],
}

impl Moduli {
    /// The moduli of an energy less a pressure (Pa) times the volume ratio of the stretches.
    #[must_use]
    pub(super) fn under(&self, pressure: f64, s: [f64; 3]) -> Self {
        let mut moduli = *self;
        for (pair, [i, j]) in PAIRS.into_iter().enumerate() {
            let third = pressure * s[2 - pair];
            moduli.stretch[(i, j)] -= third;
            moduli.stretch[(j, i)] -= third;
            moduli.twist[pair] += third;
            moduli.flip[pair] -= third;
        }
        moduli
    }

    /// The nearest moduli that are not negative in any direction.
    #[must_use]
    pub fn positive(&self) -> Self {
        let eigen = SymmetricEigen::new(self.stretch);
        let kept = eigen.eigenvalues.map(|value| value.max(0.0));
        let is_positive = eigen.eigenvalues.iter().all(|value| *value >= 0.0);
        let vectors = eigen.eigenvectors;
        Self {
            stretch: if is_positive {
                self.stretch
            } else {
                vectors * Tensor::from_diagonal(&kept) * vectors.transpose()
            },
            twist: self.twist.map(|modulus| modulus.max(0.0)),
            flip: self.flip.map(|modulus| modulus.max(0.0)),
        }
    }
}
