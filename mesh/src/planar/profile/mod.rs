//! Profiles of slender bodies laid straight: fish, flagellates and tubes.

mod forms;
mod piece;
mod spread;
mod stations;
mod tube;

pub use forms::{FishForm, FlagellateForm};
pub use stations::{Profile, Station};
pub use tube::TubeForm;
