//! Environments for learning: a case with `[environment]`, decision by decision, one or many at once.

mod batch;
mod common;
mod episode;
mod error;
mod full;
mod interface;
mod reason;
mod swim;
mod task;

pub use batch::{Autoreset, Batch, Drawn};
pub use common::Head;
pub use error::EnvironmentError;
pub use full::Full;
pub use interface::{Environment, Info, Observed, Outcome};
pub use reason::Reason;
pub use swim::Swim;
pub use task::Task;
