//! Contact forces at the gaps at the end of a step, by Newton's method on the mobility of the bodies.

mod correction;
mod direction;
mod dissipative;
mod inner_forces;
mod placed;
mod step;
mod unknowns;

pub use step::{ContactSolution, ContactStep};
