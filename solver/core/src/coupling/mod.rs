//! Fluid and bodies in one system: nobody else knows both.

mod constrain;
mod divergence_free;
mod drift;
mod joints;
mod link;
mod loads;
mod problem;
mod shapes;
mod surface_load;
mod swimming;
mod system;

pub use constrain::NodeSides;
pub use divergence_free::DivergenceFree;
pub use joints::{BodyStates, JointReport, joint_reports};
pub use link::{Arm, Link, MovingValue, Pivot, Turn};
pub use loads::{BodyLoads, body_loads};
pub use problem::{
    Drive, Problem, RateDiscontinuities, RigidBody, Side, Spring, TimeValue, VelocityProfile,
    second_moment,
};
pub use shapes::{BodyShapes, MovingSurface, ShapeError};
pub use surface_load::surface_load;
pub use swimming::{Effort, Group, MeanMotion, effort, group_load, mean_motion};
pub use system::{
    FluidSystem, Levels, PivotLoad, Solution, SolveError, embed, flatten, memory_estimate,
};

pub(crate) use system::newton_convection;
