//! The sentence itself: bodies move, one system gives fluid and bodies together, observers look on.

mod build;
mod cycles;
mod error;
mod explicit;
mod follow;
mod march;
mod measure;
mod opened;
mod remake;
mod run;
mod saved;
mod series;
mod shape_motion;
mod snapshot;
mod state;
mod steady;

pub use crate::timing::{Stage, Timing, cpu_seconds};
pub use build::{build_mesh, build_problem, sizing};
pub use error::{RunError, StepError};
pub use follow::Follower;
pub use march::{March, MeshPath, StepResult};
pub use run::{Outcome, simulate, simulate_from};
pub use saved::SavedState;
pub use series::Series;
pub use shape_motion::shape_motion;
pub use snapshot::{BodyReport, Observer, Remains, Snapshot};
pub use state::State;
pub use steady::{SteadyFailure, SteadyFlow, solve_steady};
