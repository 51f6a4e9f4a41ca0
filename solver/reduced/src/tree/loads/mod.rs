//! Laws of what a fluid does to a rigid body that moves in it: one file each, formula and source above it.

mod ellipsoid;
mod elongated;
mod resistive;
mod strips;
mod vehicle;

pub use ellipsoid::{AddedMass, Ellipsoid, EllipsoidCoefficients, Lift};
pub use elongated::{ElongatedBody, ElongatedLink, elongated_mass};
pub use resistive::Resistive;
pub use strips::{StripCoefficients, Strips};
pub use vehicle::Vehicle;

use super::spatial::{Number, Symmetric, Twist, Wrench};

/// What resists a motion, about the origin of the frame of a load, in its axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resistance<T: Number> {
    /// The load (N, N m).
    pub wrench: Wrench<T>,
    /// About how much more load there is for more velocity: symmetric and not negative, for steps in time
    /// that take resistances implicitly. No result converges to another because of it.
    pub slope: Symmetric<T>,
}

/// A law of loads with its numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum Load<T: Number> {
    /// An ellipsoid with five coefficients.
    Ellipsoid(Box<Ellipsoid<T>>),
    /// A slender link in the plane, drag by strips along it.
    Strips(Strips<T>),
    /// A slender link in the plane, by elongated-body theory.
    Elongated(ElongatedLink<T>),
    /// A slender link without inertia of the fluid.
    Resistive(Resistive<T>),
    /// A vehicle with linear and quadratic damping.
    Vehicle(Vehicle<T>),
}

impl<T: Number> Load<T> {
    /// What resists a motion.
    #[must_use]
    pub fn resist(&self, twist: &Twist<T>) -> Resistance<T> {
        match self {
            Self::Ellipsoid(law) => law.resist(twist),
            Self::Strips(law) => law.resist(twist),
            Self::Elongated(law) => law.resist(twist),
            Self::Resistive(law) => law.resist(twist),
            Self::Vehicle(law) => law.resist(twist),
        }
    }

    /// Masses that the fluid adds to the body.
    #[must_use]
    pub fn added_mass(&self) -> Symmetric<T> {
        match self {
            Self::Ellipsoid(law) => law.added_mass(),
            Self::Strips(law) => law.added_mass(),
            Self::Elongated(law) => law.added_mass(),
            Self::Resistive(_) => Symmetric::zero(),
            Self::Vehicle(law) => law.added_mass(),
        }
    }
}
