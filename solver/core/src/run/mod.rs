//! From a case to a run: build, begin, make steps of a controlled size, measure, and let observers look on.

mod build;
mod case_mesh;
mod control;
mod error;
mod excess;
mod free_memory;
mod measure;
mod planar;
mod prepare;
mod reports;
mod resume;
#[expect(clippy::module_inception, reason = "the run itself is what the room is named after")]
mod run;
mod run_case;
mod series;
mod session;
mod simulation;
mod snapshot;
mod solve;
mod spatial;
mod start;
mod step_control;
mod timed_step;
mod watch;

pub use build::{BodyRecoil, build_problem, motion_settings, recoils, shape_motion, sizing};
pub use case_mesh::{CaseMesh, Dimension, InitialMesh, NearestOnBody, build_mesh};
pub use error::RunError;
pub use excess::Excess;
pub use measure::{BodiesInFlow, steady_value};
pub use prepare::{moving_mesh_on, simulation_on, simulation_with};
pub use reports::{CycleReport, StepErrorReport};
pub use resume::{Reference, ResumeError, SavedState, VERSION as STATE_VERSION};
pub use run::RunSummary;
pub use run_case::Start;
pub use series::Series;
pub use session::{Fields, Observers, Session};
pub use simulation::{Attempt, Simulation, StepScheme};
pub use snapshot::{BodyReport, LastState, Observer, Recorded, Snapshot};
pub use solve::{Solve, replay, simulate, simulate_from};
pub use step_control::{Piece, StepControl};
pub use timed_step::{Effort, TimedStep};
pub use watch::{Allowed, AllowedBy, AtHand, CellBound, NotFinite, Places, by_key};
