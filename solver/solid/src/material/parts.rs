//! `TangentParts`: a tangent by the few tensors it is made of, which the gradients of shape functions meet one by one.

use super::{Tangent, Tensor};

/// Multiples of the dyad T_iJ T_kL of a tensor T, and of the crossed one T_iL T_kJ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dyad {
    /// T.
    pub tensor: Tensor,
    /// The factor of the dyad.
    pub straight: f64,
    /// The factor of the crossed one.
    pub crossed: f64,
}

/// Derivatives A_iJkL of a stress by the deformation gradient (Pa): dyads, and a_ik d_JL + d_ik b_JL with the unit
/// tensor d. Between the gradients g and h of two shape functions, A_iJkL g_J h_L takes some products of vectors
/// where the whole tangent takes 81 numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentParts {
    /// Dyads.
    pub dyads: [Option<Dyad>; 2],
    /// a.
    pub space: Tensor,
    /// b.
    pub body: Tensor,
}

impl TangentParts {
    /// The whole tangent.
    #[must_use]
    pub fn whole(&self) -> Tangent {
        let mut whole = Tangent::zeros();
        for dyad in self.dyads.iter().flatten() {
            dyad.add_to(&mut whole);
        }
        for i in 0..3 {
            for k in 0..3 {
                for j in 0..3 {
                    whole[(3 * i + j, 3 * k + j)] += self.space[(i, k)];
                    whole[(3 * i + j, 3 * i + k)] += self.body[(j, k)];
                }
            }
        }
        whole
    }
}

impl Dyad {
    fn add_to(&self, sum: &mut Tangent) {
        let t = &self.tensor;
        for k in 0..3 {
            for l in 0..3 {
                let one = self.straight * t[(k, l)];
                for i in 0..3 {
                    let other = self.crossed * t[(i, l)];
                    for j in 0..3 {
                        sum[(3 * i + j, 3 * k + l)] += one * t[(i, j)] + other * t[(k, j)];
                    }
                }
            }
        }
    }
}
