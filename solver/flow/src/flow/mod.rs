//! The incompressible Navier-Stokes equations on a (moving) mesh: element terms and their assembly.

mod assemble;
mod kernel;
mod nodal;
mod open_side;
mod parallel;
mod taylor_hood;
mod terms;
#[cfg(test)]
mod tests;

pub use assemble::{Assembly, assemble, pressure_unknowns, residual};
pub use nodal::{nodal_pressure, nodal_vorticity};
pub use parallel::{for_each_cell, integrate_basis};
pub use terms::{BodyForce, Convection, Fields, FlowTerms};
