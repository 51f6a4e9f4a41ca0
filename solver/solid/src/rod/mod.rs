//! Elastic rods: geometrically exact, with a cubic centreline, in the plane and in space.
//!
//! A rod is a curve r(s), 0 <= s <= length, through knots. Its coordinates are the place and the tangent dr/ds of
//! each knot, in space also a vector across that shows how the section is turned. All are components in fixed
//! axes, so that velocities are their rates and the mass matrix is constant. What a rod resists are strains: bending,
//! twist, stretch. Energies are quadratic in strains, and strains are functions of coordinates whose derivatives are
//! taken by automatic differentiation.

mod along;
mod elastic;
mod end;
mod ends;
mod error;
mod frame;
mod hermite;
mod kinematics;
mod mass;
mod plane;
mod resistive;
mod rod_properties;
mod space;
mod spatial_ends;
mod spatial_surface;
mod surface;
#[cfg(test)]
mod tests;
mod weight;

pub use along::{Along, Field, Varying};
pub use elastic::{Rod, RodPower};
pub use end::End;
pub use ends::{EndLoad, EndPose, Support};
pub use error::RodError;
pub use plane::PlanarRod;
pub use resistive::Resistance;
pub use rod_properties::{Flexure, PlanarProperties, RodProperties, SpatialProperties};
pub use space::SpatialRod;
pub use spatial_ends::{SpatialEndLoad, SpatialEndPose};
pub use spatial_surface::{SpatialSectionPoint, SpatialSurfaceRows};
pub use surface::{RoundedStrip, SectionPoint, SurfaceRows};
pub use weight::LineForce;
