//! Passive scalars that the flow carries and that diffuse: their equation on the mesh, their amounts.

mod amount;
mod cells;
mod equation;
mod field;
mod surface;
mod transfer;

pub use amount::{Amount, amount};
pub use equation::{Carrier, Equation, Solved, Step};
pub use field::{Condition, Level, Profile, Scalar, ScalarField};
pub use transfer::MassMatrix;
