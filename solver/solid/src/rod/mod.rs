//! Elastic rods: geometrically exact, with a cubic centreline, in the plane and in space.
//!
//! A rod is a curve r(s), 0 <= s <= length, through knots. Its coordinates are the place and the tangent dr/ds of
//! each knot, in space also a vector across that shows how the section is turned. All are components in fixed
//! axes, so that velocities are their rates and the mass matrix is constant. What a rod resists are strains: bending,
//! twist, stretch. Energies are quadratic in strains, and strains are functions of coordinates whose derivatives are
//! taken by automatic differentiation.

mod along;
mod center;
mod clamp;
mod elastic;
mod end;
mod error;
mod hermite;
mod kinematics;
mod loads;
mod mass;
mod planar;
mod properties;
mod section;
mod spatial;
mod supports;
#[cfg(test)]
mod tests;

pub use along::{Along, Field, Varying};
pub use elastic::Rod;
pub use end::{Axes, End, Support};
pub use error::RodError;
pub use loads::{LineForce, Resistance};
pub use planar::{
    EndLoad, EndPose, LoadedEnd, PlanarRod, PlanarRodBody, RoundedStrip, SectionPoint, SectionRows,
    SurfaceRows,
};
pub use properties::{Flexure, PlanarProperties, RodProperties, SpatialProperties};
pub use section::Section;
pub use spatial::{
    SpatialEndLoad, SpatialEndPose, SpatialLoadedEnd, SpatialRod, SpatialRodBody,
    SpatialSectionPoint, SpatialSurfaceRows,
};
pub use supports::{HeldEnd, Supports};
