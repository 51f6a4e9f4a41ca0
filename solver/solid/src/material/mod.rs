//! Elastic laws: energies of the principal stretches, their stresses and tangents, fibres and damping.

mod direct;
mod fibre;
mod kinematics;
mod law;
mod moduli;
mod pairs;
mod parts;
mod principal;
#[cfg(test)]
mod tests;
mod viscous;
mod volume;

pub use direct::Direct;
pub use fibre::Fibre;
pub use kinematics::Kinematics;
pub use law::{Lame, Law};
pub use moduli::{Material, MaterialError};
pub use pairs::Moduli;
pub use parts::{Dyad, TangentParts};
pub use principal::{Principal, Stress};
pub use viscous::Viscous;
pub(crate) use viscous::green;

use nalgebra::SMatrix;

/// A stress or a gradient, 3 x 3; in the plane its third row and column are those of the thickness, around
/// an axis those of the hoop.
pub type Tensor = SMatrix<f64, 3, 3>;

/// Derivatives of a stress by a gradient, 9 x 9: entry (i, j) of a tensor is number 3 i + j.
pub type Tangent = SMatrix<f64, 9, 9>;

/// Which tangent of an energy is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Curvature {
    /// The second derivatives: what sensitivities need.
    True,
    /// Their positive part: what a descent needs, as Newton's step then leads downwards.
    Positive,
}
