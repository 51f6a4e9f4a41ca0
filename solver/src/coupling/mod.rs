//! Fluid and bodies in one system: nobody else knows both.

mod constrain;
mod divergence_free;
mod drift;
mod loads;
mod problem;
mod surface_load;
mod system;

pub use constrain::NodeSides;
pub use divergence_free::DivergenceFree;
pub use loads::{BodyLoads, body_loads};
pub use problem::{Drive, Problem, RigidBody, Side, Spring, TimeValue, VelocityProfile};
pub use surface_load::surface_load;
pub use system::{FluidSystem, Levels, Solution, SolveError, embed, flatten, memory_estimate};

pub(crate) use system::newton_convection;
