//! Environments for learning: a case with `[environment]`, decision by decision, one or many at once.

mod batch;
mod common;
mod environment;
mod episode;
mod error;
mod full;
mod reason;
mod swim;
mod task;

pub use batch::{Autoreset, Batch, Drawn};
pub use common::Head;
pub use environment::{Environment, Info, Observed, Outcome};
pub use error::EnvironmentError;
pub use full::Full;
pub use reason::Reason;
pub use swim::Swim;
pub use task::Task;
