//! Finite elements: spaces, and the terms of the Navier-Stokes equations with their assembly.

pub mod flow;
pub mod space;

use alewife_linear::algebra;
