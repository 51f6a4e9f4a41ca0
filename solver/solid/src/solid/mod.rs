//! Solids of simplices: their energy, forces and stiffness, equilibria, steps in time and sensitivities.

mod assemble;
mod build;
mod cell_means;
mod cholesky;
mod error;
mod geometry;
mod mass;
mod mesh;
mod mixed;
mod modes;
mod newton;
mod pattern;
mod potential;
mod rigid;
mod sensitivity;
mod spec;
mod step;

pub use assemble::{StrainHistory, StrainLevel};
pub use build::Solid;
pub use cholesky::{Cholesky, Factor};
pub use error::SolidError;
pub use mesh::{Frame, Order, SolidFacet, SolidMesh};
pub use newton::{Minimiser, Minimum};
pub use potential::{Inertia, Potential, Way};
pub use sensitivity::{FibreEnergy, Sensitivity};
pub use spec::{Fibres, RigidPart, SolidSpec};
pub use step::{Difference, Level, Motion, Scheme, StepInput};
