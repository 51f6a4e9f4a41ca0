//! Loads of rods that do without a flow.

mod line_force;
mod resistance;

pub use line_force::LineForce;
pub use resistance::Resistance;
