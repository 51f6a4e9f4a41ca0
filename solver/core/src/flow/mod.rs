//! The incompressible Navier-Stokes equations on a (moving) mesh: element terms and their assembly.

mod assemble;
mod cell_terms;
mod open_side;
mod points;
mod terms;

pub use assemble::{Assembly, assemble, pressure_unknowns, residual};
pub use open_side::{FacetPoint, for_each_facet_point};
pub use terms::{BodyForce, Convection, Fields, FlowTerms};
