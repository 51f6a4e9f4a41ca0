//! What observers ask of the operating system: files written whole or removed, and what it knows of this process.

mod atomic;
pub mod process;
mod removal;

pub(super) use atomic::{AtPath, unfinished_file, write_whole};
pub use atomic::{UNFINISHED, directory_of, write_atomic};
pub use removal::remove_if_there;
pub(super) use removal::{names_in, remove_if_empty};
