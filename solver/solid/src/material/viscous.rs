//! `Viscous`: damping of Kelvin and Voigt's kind as an incremental energy of one time step.

use super::{Curvature, Tangent, Tensor};

/// The stress F 2 eta dE/dt of Green's strain E = (F^T F - 1)/2, whose rate at the end of a step is
/// a (E - E_h), with the strain E_h the backward difference has from levels before.
///
/// The stress is the derivative of eta a |E - E_h|^2: a step with damping still minimises an energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscous {
    /// 2 eta a (Pa).
    pub stiffness: f64,
    /// E_h, symmetric.
    pub history: Tensor,
}

/// Green's strain.
pub(crate) fn green(deformation: &Tensor) -> Tensor {
    0.5 * (deformation.transpose() * deformation - Tensor::identity())
}

impl Viscous {
    /// Second Piola-Kirchhoff stress (Pa).
    fn second_stress(&self, deformation: &Tensor) -> Tensor {
        (green(deformation) - self.history) * self.stiffness
    }

    /// Energy of the step a volume at rest (J/m3).
    #[must_use]
    pub fn energy(&self, deformation: &Tensor) -> f64 {
        0.5 * self.stiffness * (green(deformation) - self.history).norm_squared()
    }

    /// First Piola-Kirchhoff stress (Pa).
    #[must_use]
    pub fn stress(&self, deformation: &Tensor) -> Tensor {
        deformation * self.second_stress(deformation)
    }

    /// Derivatives of the stress by the deformation gradient (Pa).
    #[must_use]
    pub fn tangent(&self, deformation: &Tensor, curvature: Curvature) -> Tangent {
        let left = deformation * deformation.transpose();
        let initial = match curvature {
            Curvature::True => self.second_stress(deformation),
            // What remains is the square of a strain, so never negative
            Curvature::Positive => Tensor::zeros(),
        };
        let half = 0.5 * self.stiffness;
        Tangent::from_fn(|row, column| {
            let (i, j, k, l) = (row / 3, row % 3, column / 3, column % 3);
            let same = if j == l { half * left[(i, k)] } else { 0.0 };
            let geometric = if i == k { initial[(l, j)] } else { 0.0 };
            same + geometric + half * deformation[(i, l)] * deformation[(k, j)]
        })
    }
}
