//! The incompressible Navier-Stokes equations on a (moving) mesh: element terms and their assembly.

mod assemble;
mod cell_terms;
mod open_side;
mod surface_load;
mod terms;

pub use assemble::{Assembly, assemble, residual};
pub use surface_load::surface_load;
pub use terms::{BodyForce, Convection, FlowTerms, Fields};
