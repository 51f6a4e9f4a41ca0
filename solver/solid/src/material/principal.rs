//! `Principal`: singular values of a deformation, and a law's stress and tangent in their frame.

use nalgebra::{SMatrix, SVector};

use super::pairs::PAIRS;
use super::{Curvature, Lame, Law, Tangent, Tensor};

/// Two columns are orthogonal where the square of their cosine is below this.
const ORTHOGONAL: f64 = 1e-30;

/// Sweeps at most: four are enough for any matrix of rank three.
const N_SWEEPS: usize = 30;

/// A deformation gradient F = U diag(s) V^T, with rotations U and V.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    /// Principal directions in space, one a column.
    pub space: Tensor,
    /// Principal stretches, positive, in no order.
    pub stretches: [f64; 3],
    /// Principal directions in the body at rest, one a column.
    pub body: Tensor,
}

impl Principal {
    /// Singular values by one-sided Jacobi rotations; none where det F is not positive, that is where a cell
    /// is turned over.
    #[must_use]
    pub fn of(deformation: &Tensor) -> Option<Self> {
        if !(deformation.determinant() > 0.0 && deformation.norm_squared().is_finite()) {
            return None;
        }
        let (mut columns, mut body) = (*deformation, Tensor::identity());
        for _ in 0..N_SWEEPS {
            let mut is_done = true;
            for [p, q] in PAIRS {
                let (a, b) = (columns.column(p).norm_squared(), columns.column(q).norm_squared());
                let dot = columns.column(p).dot(&columns.column(q));
                if dot * dot > ORTHOGONAL * a * b {
                    is_done = false;
                    let zeta = (b - a) / (2.0 * dot);
                    let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
                    let cosine = 1.0 / tangent.hypot(1.0);
                    rotate(&mut columns, [p, q], cosine, cosine * tangent);
                    rotate(&mut body, [p, q], cosine, cosine * tangent);
                }
            }
            if is_done {
                break;
            }
        }
        let stretches: [f64; 3] = std::array::from_fn(|i| columns.column(i).norm());
        if stretches.contains(&0.0) {
            return None;
        }
        let space = Tensor::from_fn(|i, j| columns[(i, j)] / stretches[j]);
        Some(Self { space, stretches, body })
    }

    /// A tensor with these principal values.
    fn tensor(&self, values: [f64; 3]) -> Tensor {
        let scaled = Tensor::from_fn(|i, j| self.space[(i, j)] * values[j]);
        scaled * self.body.transpose()
    }

    /// Elastic energy a volume at rest (J/m3).
    #[must_use]
    pub fn energy(&self, law: Law, lame: Lame) -> f64 {
        let [shear, volume] = law.energies(self.stretches);
        lame.shear * shear + lame.volume * volume
    }

    /// First Piola-Kirchhoff stress P (Pa).
    #[must_use]
    pub fn stress(&self, law: Law, lame: Lame) -> Tensor {
        let [shear, volume] = law.stresses(self.stretches);
        self.tensor(std::array::from_fn(|i| lame.shear * shear[i] + lame.volume * volume[i]))
    }

    /// Derivatives of the stress by the shear modulus and by lambda.
    #[must_use]
    pub fn stress_by_moduli(&self, law: Law) -> [Tensor; 2] {
        law.stresses(self.stretches).map(|values| self.tensor(values))
    }

    /// Derivatives of the stress by the deformation gradient (Pa).
    #[must_use]
    pub fn tangent(&self, law: Law, lame: Lame, curvature: Curvature) -> Tangent {
        let moduli = law.moduli(self.stretches, lame);
        let moduli = match curvature {
            Curvature::True => moduli,
            Curvature::Positive => moduli.positive(),
        };
        let dyad = |i: usize, j: usize| -> SVector<f64, 9> {
            let (u, v) = (self.space.column(i), self.body.column(j));
            SVector::from_fn(|row, _| u[row / 3] * v[row % 3])
        };
        let principal = SMatrix::<f64, 9, 3>::from_columns(&[dyad(0, 0), dyad(1, 1), dyad(2, 2)]);
        let mut tangent: Tangent = principal * moduli.stretch * principal.transpose();
        for (pair, [i, j]) in PAIRS.into_iter().enumerate() {
            let (one, other) = (dyad(i, j), dyad(j, i));
            let (even, odd) = (one + other, one - other);
            for column in 0..9 {
                let twist = 0.5 * moduli.twist[pair] * even[column];
                let flip = 0.5 * moduli.flip[pair] * odd[column];
                for row in 0..9 {
                    tangent[(row, column)] += even[row] * twist + odd[row] * flip;
                }
            }
        }
        tangent
    }
}

/// Turns two columns by an angle.
fn rotate(matrix: &mut Tensor, [p, q]: [usize; 2], cosine: f64, sine: f64) {
    for row in 0..3 {
        let (a, b) = (matrix[(row, p)], matrix[(row, q)]);
        matrix[(row, p)] = cosine * a - sine * b;
        matrix[(row, q)] = sine * a + cosine * b;
    }
}
