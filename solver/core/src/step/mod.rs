//! One step in time: the flow with its bodies, their poses and their contact, on a mesh that follows them.
//!
//! `step.rs` is the step by backward differences; `explicit/` the one by stages without inertia; `newton/` the equations of
//! the flow on one configuration, steady or in a step.

mod accuracy;
mod configuration;
mod context;
mod coupled_flow;
mod elastic;
mod error;
mod explicit;
mod finish;
mod history;
mod mesh_path;
mod newton;
mod place;
mod placement;
mod predict;
mod solve;
#[expect(clippy::module_inception, reason = "the step itself is what the room is named after")]
mod step;
mod stepper;
mod workspace;

pub use accuracy::{NEARLY_AT_REST, error_of_second_difference};
pub use error::{FlowError, StepError, at_step};
pub use explicit::{STAGES, Stage};
pub use history::INSIDE;
pub use mesh_path::{MeshPath, NodePath};
pub use newton::{
    SteadyFailure, SteadyFlow, SteadyTask, solve_steady, steady_convection, steady_terms,
};
pub use stepper::{Step, StepReport, StepResult, StopRequest, TimeStepper};
pub use workspace::Workspace;
