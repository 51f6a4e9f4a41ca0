//! The reduced model of a case: its bodies and joints as a tree of links, its motion, its quantities.

mod acting;
mod build;
mod calibrate;
mod error;
mod guide;
mod hung;
mod inertia;
mod law;
mod lift;
mod measure;
mod mover;
mod simulate;
mod swimmer;
mod told;

pub use calibrate::{CalibrateError, Calibrated, Deviation, calibrate};
pub use error::ReducedError;
pub use simulate::simulate;
