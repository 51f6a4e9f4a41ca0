//! `Principal`: singular values of a deformation, and a law's stress and tangent in their frame.

use nalgebra::{SMatrix, SVector};

use super::law::FirstOrder;
use super::pairs::{Moduli, PAIRS};
use super::{Curvature, Lame, Law, Tangent, Tensor};

/// Two columns are orthogonal where the square of their cosine is below this.
const ORTHOGONAL: f64 = 1e-30;

/// Squared size of a coupling, of the matrix, that is none.
const DIAGONAL: f64 = 1e-32;

/// Sweeps at most: four are enough for any matrix of rank three.
const N_SWEEPS: usize = 30;

/// A deformation gradient F = U diag(s) V^T, with rotations U and V.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    /// Principal directions in space, one a column.
    pub space: Tensor,
    /// Principal stretches, in no order.
    pub stretches: [f64; 3],
    /// Principal directions in the body at rest, one a column.
    pub body: Tensor,
}

/// An energy with its stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stress {
    /// Energy a volume at rest (J/m3).
    pub energy: f64,
    /// First Piola-Kirchhoff stress P (Pa).
    pub stress: Tensor,
}

impl Principal {
    /// Singular values by Jacobi rotations; where det F is negative, as in a cell that is turned over on the
    /// way of a search, the smallest is. None for a deformation without volume.
    #[must_use]
    pub fn of(deformation: &Tensor) -> Option<Self> {
        let volume = deformation.determinant();
        if volume == 0.0 || !volume.is_finite() {
            return None;
        }
        let mut body = directions(deformation.transpose() * deformation);
        let mut columns = deformation * body;
        // The square has lost digits of the smaller stretches, if any: they are found here
        for _ in 0..N_SWEEPS {
            let turned = [
                straighten::<0, 1>(&mut columns, &mut body),
                straighten::<0, 2>(&mut columns, &mut body),
                straighten::<1, 2>(&mut columns, &mut body),
            ];
            if turned == [false; 3] {
                break;
            }
        }
        let mut stretches: [f64; 3] = std::array::from_fn(|i| columns.column(i).norm());
        if stretches.contains(&0.0) {
            return None;
        }
        if volume < 0.0 {
            let smaller = |a: usize, b: usize| if stretches[b] < stretches[a] { b } else { a };
            let smallest = smaller(smaller(0, 1), 2);
            stretches[smallest] = -stretches[smallest];
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

    /// Elastic energy a volume at rest and first Piola-Kirchhoff stress.
    #[must_use]
    pub fn stress(&self, law: Law, lame: Lame) -> Stress {
        let FirstOrder { energies, stresses: [shear, volume] } = law.first_order(self.stretches);
        Stress {
            energy: lame.shear * energies[0] + lame.volume * energies[1],
            stress: self
                .tensor(std::array::from_fn(|i| lame.shear * shear[i] + lame.volume * volume[i])),
        }
    }

    /// Volume ratio J.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.stretches.iter().product()
    }

    /// Derivatives J F^-T of the volume ratio by the deformation gradient.
    #[must_use]
    pub fn cofactor(&self) -> Tensor {
        let [a, b, c] = self.stretches;
        self.tensor([b * c, c * a, a * b])
    }

    /// Derivatives of the stress by the shear modulus and by lambda.
    #[must_use]
    pub fn stress_by_moduli(&self, law: Law) -> [Tensor; 2] {
        law.first_order(self.stretches).stresses.map(|values| self.tensor(values))
    }

    /// Derivatives of the stress by the deformation gradient (Pa).
    #[must_use]
    pub fn tangent(&self, law: Law, lame: Lame, curvature: Curvature) -> Tangent {
        self.tangent_of(&law.moduli(self.stretches, lame), curvature)
    }

    /// The same of an energy less a pressure (Pa) times the volume ratio.
    #[must_use]
    pub fn tangent_under(
        &self,
        law: Law,
        lame: Lame,
        pressure: f64,
        curvature: Curvature,
    ) -> Tangent {
        let moduli = law.moduli(self.stretches, lame).under(pressure, self.stretches);
        self.tangent_of(&moduli, curvature)
    }

    fn tangent_of(&self, moduli: &Moduli, curvature: Curvature) -> Tangent {
        let moduli = match curvature {
            Curvature::True => *moduli,
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

/// Eigenvectors of a symmetric matrix by Jacobi rotations.
fn directions(mut square: Tensor) -> Tensor {
    let mut vectors = Tensor::identity();
    let small = DIAGONAL * square.norm_squared();
    for _ in 0..N_SWEEPS {
        let couplings = [square[(0, 1)], square[(0, 2)], square[(1, 2)]];
        if couplings.iter().all(|coupling| coupling * coupling <= small) {
            break;
        }
        diagonalise::<0, 1, 2>(&mut square, &mut vectors);
        diagonalise::<0, 2, 1>(&mut square, &mut vectors);
        diagonalise::<1, 2, 0>(&mut square, &mut vectors);
    }
    vectors
}

/// Turns the axes P and Q of a symmetric matrix so that nothing couples them; R is the third. Its lower triangle
/// is not kept.
fn diagonalise<const P: usize, const Q: usize, const R: usize>(
    square: &mut Tensor,
    vectors: &mut Tensor,
) {
    let coupling = square[(P, Q)];
    if coupling == 0.0 {
        return;
    }
    let turn = Turn::of((square[(Q, Q)] - square[(P, P)]) / (2.0 * coupling));
    square[(P, P)] -= turn.tangent * coupling;
    square[(Q, Q)] += turn.tangent * coupling;
    square[(P, Q)] = 0.0;
    let (one, other) = ((P.min(R), P.max(R)), (Q.min(R), Q.max(R)));
    let (a, b) = (square[one], square[other]);
    square[one] = turn.cosine * a - turn.sine * b;
    square[other] = turn.sine * a + turn.cosine * b;
    turn.columns::<P, Q>(vectors);
}

/// Turns two columns so that they are orthogonal, and those of `body` with them; false where they were.
fn straighten<const P: usize, const Q: usize>(columns: &mut Tensor, body: &mut Tensor) -> bool {
    let (p, q) = (columns.column(P), columns.column(Q));
    let (a, b, dot) = (p.norm_squared(), q.norm_squared(), p.dot(&q));
    if dot * dot <= ORTHOGONAL * a * b {
        return false;
    }
    let turn = Turn::of((b - a) / (2.0 * dot));
    turn.columns::<P, Q>(columns);
    turn.columns::<P, Q>(body);
    true
}

/// A Jacobi rotation.
struct Turn {
    tangent: f64,
    cosine: f64,
    sine: f64,
}

impl Turn {
    /// By the cotangent of twice its angle.
    fn of(zeta: f64) -> Self {
        let tangent = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
        let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
        Self { tangent, cosine, sine: cosine * tangent }
    }

    /// Turns two columns.
    fn columns<const P: usize, const Q: usize>(&self, matrix: &mut Tensor) {
        for row in 0..3 {
            let (a, b) = (matrix[(row, P)], matrix[(row, Q)]);
            matrix[(row, P)] = self.cosine * a - self.sine * b;
            matrix[(row, Q)] = self.sine * a + self.cosine * b;
        }
    }
}
