//! `Fibre`: an active fibre, which pulls or pushes towards a given length.

use nalgebra::Vector3;

use super::parts::{Dyad, TangentParts};
use super::{Curvature, Tensor};

/// Fibres along a direction m of the body at rest, with the energy w/2 (|F m| - a)^2 a volume: they pull where
/// longer than a times their length at rest, and push where shorter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fibre {
    /// Unit vector m.
    pub direction: Vector3<f64>,
    /// Stiffness w (Pa).
    pub stiffness: f64,
    /// The stretch a they tend to.
    pub target: f64,
}

impl Fibre {
    /// Their stretch |F m|.
    #[must_use]
    pub fn stretch(&self, deformation: &Tensor) -> f64 {
        (deformation * self.direction).norm()
    }

    /// Energy a volume at rest (J/m3).
    #[must_use]
    pub fn energy(&self, deformation: &Tensor) -> f64 {
        0.5 * self.stiffness * (self.stretch(deformation) - self.target).powi(2)
    }

    /// First Piola-Kirchhoff stress (Pa).
    #[must_use]
    pub fn stress(&self, deformation: &Tensor) -> Tensor {
        let fibre = deformation * self.direction;
        fibre * self.direction.transpose() * (self.stiffness * (1.0 - self.target / fibre.norm()))
    }

    /// Derivative of the stress by the target a (Pa).
    #[must_use]
    pub fn stress_by_target(&self, deformation: &Tensor) -> Tensor {
        let fibre = deformation * self.direction;
        fibre * self.direction.transpose() * (-self.stiffness / fibre.norm())
    }

    /// Derivatives of the stress by the deformation gradient (Pa).
    #[must_use]
    pub fn tangent(&self, deformation: &Tensor, curvature: Curvature) -> TangentParts {
        let fibre = deformation * self.direction;
        let stretch = fibre.norm();
        let along = fibre / stretch;
        let across = match curvature {
            Curvature::True => 1.0 - self.target / stretch,
            Curvature::Positive => (1.0 - self.target / stretch).max(0.0),
        };
        let m = &self.direction;
        let dyad = Dyad {
            tensor: along * m.transpose(),
            straight: self.stiffness * (1.0 - across),
            crossed: 0.0,
        };
        TangentParts {
            dyads: [Some(dyad), None],
            space: Tensor::zeros(),
            body: m * m.transpose() * (self.stiffness * across),
        }
    }
}
