//! What is given of a rod: size, mass, and what it resists.

use super::along::{Along, Field};
use super::error::RodError;

/// Bending in one direction, or twist.
#[derive(Debug, Clone)]
pub struct Flexure {
    /// Moment over curvature or twist (N m², in planar problems N m).
    pub stiffness: Along,
    /// Curvature or twist without a load (1/m); where it changes in time the rod bends actively.
    pub rest: Field,
    /// Active moment (N m, in planar problems N), which is added to the elastic one.
    pub moment: Field,
}

impl Flexure {
    /// Of a straight and passive rod with a stiffness.
    #[must_use]
    pub const fn passive(stiffness: Along) -> Self {
        Self { stiffness, rest: Field::ZERO, moment: Field::ZERO }
    }
}

/// What planar rods and rods in space have in common.
#[derive(Debug, Clone)]
pub struct RodProperties {
    /// Length (m).
    pub length: f64,
    /// Number of cubic elements, of equal length.
    pub elements: usize,
    /// Tension over stretch (N); [`RodProperties::stiff`] has one that is stiff enough.
    pub stretching: f64,
    /// Time (s) after which strains relax: moments of damping are this times stiffness times rate.
    pub damping: f64,
    /// Mass per length (kg/m, in planar problems kg/m²).
    pub mass: Along,
    /// Moment of inertia per length of sections: in the plane for turning in it, in space for turning about
    /// the centreline (kg m, in planar problems kg).
    pub section_inertia: Along,
}

impl RodProperties {
    /// Stretching stiffness of a rod of this bending stiffness (N m²) and length (m) whose stretch stays
    /// below 1e-4 up to a tension of 1000 times bending stiffness over length².
    #[must_use]
    pub fn stiff(bending: f64, length: f64) -> f64 {
        1e7 * bending / (length * length)
    }

    /// Whether there is such a rod.
    pub(super) fn validate(&self) -> Result<(), RodError> {
        let Self { length, elements, stretching, damping, .. } = *self;
        if !(length > 0.0 && length.is_finite() && elements > 0) {
            return Err(RodError::Size { length, elements });
        }
        positive("stretching", 0.0, stretching)?;
        if !(damping >= 0.0 && damping.is_finite()) {
            return Err(RodError::Property { name: "damping", along: 0.0, value: damping });
        }
        for element in 0..=elements {
            let along = length * element as f64 / elements as f64;
            for (name, number) in [("mass", &self.mass), ("section inertia", &self.section_inertia)]
            {
                let value = number.at(along);
                if !(value >= 0.0 && value.is_finite()) {
                    return Err(RodError::Property { name, along, value });
                }
            }
        }
        Ok(())
    }
}

/// Refuses a value that is not positive or not finite.
pub(super) fn positive(name: &'static str, along: f64, value: f64) -> Result<(), RodError> {
    let is_positive = value > 0.0 && value.is_finite();
    if is_positive { Ok(()) } else { Err(RodError::Property { name, along, value }) }
}

/// What is given of a planar rod.
#[derive(Debug, Clone)]
pub struct PlanarProperties {
    /// Size and mass.
    pub rod: RodProperties,
    /// Bending in the plane.
    pub bending: Flexure,
}

/// What is given of a rod in space.
#[derive(Debug, Clone)]
pub struct SpatialProperties {
    /// Size and mass.
    pub rod: RodProperties,
    /// Bending about d1 and about d2.
    pub bending: [Flexure; 2],
    /// Twist.
    pub twisting: Flexure,
}
