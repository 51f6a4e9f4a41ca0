//! The incompressible Navier-Stokes equations on a (moving) mesh: element terms and their assembly.

mod assemble;
mod kernel;
mod local_viscosity;
mod nodal;
mod open_side;
mod parallel;
mod taylor_hood;
mod terms;
#[cfg(test)]
mod tests;
mod viscosity;

pub use assemble::{Assembly, assemble, pressure_unknowns, residual, transposed_product};
pub use local_viscosity::{LocalViscosity, PointViscosity, ViscosityTerm, squared_shear};
pub use nodal::{nodal_pressure, nodal_vorticity};
pub use open_side::OpenSide;
pub use parallel::{for_each_cell, integrate_basis};
pub use terms::{Convection, Fields, FlowTerms};
pub use viscosity::{Plateaus, Viscosity, ViscosityAtRate, YieldLaw};
