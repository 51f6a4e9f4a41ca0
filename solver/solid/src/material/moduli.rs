//! `Material`: a law with its moduli, from Young's modulus and Poisson's ratio.

use thiserror::Error;

use super::{Lame, Law};

/// What a material cannot be.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MaterialError {
    /// Young's modulus is not positive.
    #[error("Young's modulus is {0} Pa: it has to be positive")]
    Young(f64),
    /// Poisson's ratio is out of the range of a stable solid.
    #[error("Poisson's ratio is {0}: it has to be above -1 and at most 0.5")]
    Poisson(f64),
    /// The density is not positive.
    #[error("the density is {0} kg/m3: it has to be positive")]
    Density(f64),
    /// The viscosity is negative.
    #[error("the viscosity of the solid is {0} Pa s: it cannot be negative")]
    Viscosity(f64),
}

/// An elastic material with damping of Kelvin and Voigt's kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Its elastic energy.
    pub law: Law,
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Poisson's ratio nu; 0.5 for a material that cannot be compressed, J = 1.
    pub poisson: f64,
    /// Density (kg/m3) at rest.
    pub density: f64,
    /// Viscosity eta (Pa s): the stress of damping is F 2 eta dE/dt, with Green's strain E.
    pub viscosity: f64,
}

impl Material {
    /// Checks the numbers of a material.
    ///
    /// # Errors
    /// [`MaterialError`] names the first that cannot be.
    pub fn check(&self) -> Result<(), MaterialError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        if !positive(self.young) {
            return Err(MaterialError::Young(self.young));
        }
        if !(self.poisson > -1.0 && self.poisson <= 0.5) {
            return Err(MaterialError::Poisson(self.poisson));
        }
        if !positive(self.density) {
            return Err(MaterialError::Density(self.density));
        }
        if !(self.viscosity >= 0.0 && self.viscosity.is_finite()) {
            return Err(MaterialError::Viscosity(self.viscosity));
        }
        Ok(())
    }

    /// Whether its volume cannot change: a pressure stands for the volume term of its law.
    #[must_use]
    pub fn is_incompressible(&self) -> bool {
        self.poisson == 0.5
    }

    /// Lamé's moduli of Hooke's law at small strains; where the volume cannot change lambda, which is infinite, is
    /// left out as 0.
    #[must_use]
    pub fn lame(&self) -> Lame {
        let (young, nu) = (self.young, self.poisson);
        if self.is_incompressible() {
            return Lame { shear: young / 3.0, volume: 0.0 };
        }
        Lame {
            shear: young / (2.0 * (1.0 + nu)),
            volume: young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        }
    }

    /// Derivatives of Lamé's moduli by Young's modulus.
    #[must_use]
    pub fn lame_by_young(&self) -> Lame {
        Self { young: 1.0, ..*self }.lame()
    }

    /// Derivatives of Lamé's moduli by Poisson's ratio (Pa); 0 where the volume cannot change, which leaves no
    /// other ratio.
    #[must_use]
    pub fn lame_by_poisson(&self) -> Lame {
        if self.is_incompressible() {
            return Lame { shear: 0.0, volume: 0.0 };
        }
        let (young, nu) = (self.young, self.poisson);
        let denominator = (1.0 + nu) * (1.0 - 2.0 * nu);
        Lame {
            shear: -young / (2.0 * (1.0 + nu).powi(2)),
            volume: young * (1.0 + 2.0 * nu * nu) / denominator.powi(2),
        }
    }
}
