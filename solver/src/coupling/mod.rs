//! Fluid and bodies in one system: nobody else knows both.

mod constrain;
mod loads;
mod problem;
mod surface_load;
mod system;

pub use constrain::NodeSides;
pub use loads::{BodyLoads, body_loads};
pub use surface_load::surface_load;
pub use problem::{Drive, Problem, RigidBody, Side, TimeValue, VelocityProfile};
pub use system::{FluidSystem, Levels, SolveError, Solution, embed, flatten};

pub(crate) use system::newton_convection;
