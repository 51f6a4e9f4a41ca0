//! The sentence itself: bodies move, one system gives fluid and bodies together, observers look on.

mod error;
mod series;
mod snapshot;
mod timing;

pub use error::RunError;
pub use series::Series;
pub use snapshot::{BodyReport, Observer, Snapshot};
pub use timing::{Stage, Timing};
