//! `Resistive`: a slender link in slow flow, with a force a length along itself and one across.

use nalgebra::Vector3;

use super::Resistance;
use crate::tree::spatial::{Number, Symmetric, Twist, real};

/// A straight slender link of length L along x in a flow without inertia resists by forces a length
///
/// ```text
/// f = -mu (c_t u, c_n v)
/// ```
///
/// along and across itself (Gray and Hancock 1955, J. Exp. Biol. 32, 802), so by mu `c_t` L and mu `c_n` L as a
/// whole, and by the torque mu `c_n` L^3/12 a rate about any axis across. About its own axis it resists by the
/// torque mu `c_t` L b^2 of its half width b, so that a round link in space does not spin for nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resistive<T: Number> {
    /// Length L along x (m).
    pub length: T,
    /// Half width b (m).
    pub half_width: T,
    /// Dynamic viscosity (Pa s).
    pub viscosity: T,
    /// `c_t`: force along, a length, by viscosity times velocity.
    pub along: T,
    /// `c_n`: force across, a length, by viscosity times velocity.
    pub across: T,
}

impl<T: Number> Resistive<T> {
    pub(super) fn resist(&self, twist: &Twist<T>) -> Resistance<T> {
        let size = self.viscosity * self.length;
        let (along, across) = (size * self.along, size * self.across);
        let turn = across * self.length * self.length / 12.0;
        let spin = along * self.half_width * self.half_width;
        let slope = Symmetric::diagonal(
            Vector3::new(along, across, across),
            Vector3::new(spin, turn, turn),
        );
        let mut wrench = slope.times(twist);
        wrench.force *= real::<T>(-1.0);
        wrench.torque *= real::<T>(-1.0);
        Resistance { wrench, slope }
    }
}
