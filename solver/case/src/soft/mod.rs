//! Soft cases: an elastic body without a flow, what it is told, what it is compared with, and what is sought.

mod parameters;
mod read;
mod rules;
pub mod search;
pub mod solid;
pub mod spec;
pub mod stretch;

pub use parameters::{KeyError, ParameterKey};
pub(crate) use read::is_soft;
pub use read::{BesideFile, OnlyModel, SoftFile, schema};
pub use rules::{check, check_starts};
