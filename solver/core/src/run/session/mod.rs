//! Runs that wait for what is asked of them.

mod act;
#[expect(clippy::module_inception, reason = "the session itself is what the room is named after")]
mod session;

pub use session::{Fields, Observers, Session};
