//! `StopRequest`: what a run asks whether it is to end.

use std::sync::Arc;

/// Whether a run is to end, asked between steps and within long ones; what is not yet a whole step is
/// then left out.
pub type StopRequest = Arc<dyn Fn() -> bool + Send + Sync>;
