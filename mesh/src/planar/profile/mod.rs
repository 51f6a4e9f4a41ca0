//! Profiles of slender bodies laid straight: fish and flagellates.

mod forms;
mod piece;
mod spread;
mod stations;

pub use forms::{FishForm, FlagellateForm};
pub use stations::{Profile, Station};
