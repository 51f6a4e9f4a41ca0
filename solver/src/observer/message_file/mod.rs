//! `run.mcap`: bodies, quantities and a picture of them as messages for viewers.

mod drawing;
mod foxglove;
mod mcap;
pub(super) mod messages;
mod points;
mod primitives;
mod quantities;
mod scene;
mod solids;
mod summary;

pub use mcap::MessageFile;
pub use summary::{MessageSummary, read_messages};
