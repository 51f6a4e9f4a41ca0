//! Structures without a fluid: steady equilibria and motions under given loads.

mod error;
mod level;
mod motion;
mod newton;
mod system;

pub use error::DryError;
pub use level::Level;
pub use motion::Motion;
pub use system::{DrySystem, Scaled};
