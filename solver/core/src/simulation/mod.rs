//! The sentence itself: bodies move, one system gives fluid and bodies together, observers look on.

mod advance;
mod build;
mod contact_step;
mod control;
mod cycle_error;
mod cycles;
mod energy;
mod error;
mod error_estimate;
mod explicit;
mod explicit_contact;
mod fluid_loads;
mod history;
mod measure;
mod mesh_path;
mod momentum;
mod moving_mesh;
mod new_level;
mod newton;
mod pass;
mod planar;
mod predict;
mod propulsion_history;
mod remesh;
mod resume;
mod run;
mod scene;
mod series;
mod snapshot;
mod soundness;
mod start;
mod state;
mod steady;
mod step;
mod stepper;
mod stop_request;
mod workspace;

pub use crate::timing::{Stage, Timing, cpu_seconds};
pub use advance::{Attempt, Simulation, StepScheme};
pub use error::{RunError, StepError};
pub use mesh_path::{MeshPath, NodePath};
pub use moving_mesh::{MotionSettings, MovingMesh};
pub use planar::{
    BodyRecoil, build_mesh, build_problem, mesh_quality, recoils, shape_motion, simulation_on,
    sizing,
};
pub use resume::{ResumeError, SavedState};
pub use run::{RunSummary, simulate, simulate_from};
pub use scene::{Meshed, PosesByShift, RemeshError, Scene};
pub use series::Series;
pub use snapshot::{BodyReport, LastState, Observer, Snapshot};
pub use state::{NewLevel, State};
pub use steady::{SteadyFailure, SteadyFlow, SteadyTask, solve_steady};
pub use stepper::{Step, StepReport, StepResult, TimeStepper};
pub use stop_request::StopRequest;
pub use workspace::Workspace;
