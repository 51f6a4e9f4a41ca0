//! The reduced model of a case: its bodies and joints as a tree of links, its motion, its quantities.

mod acting;
mod build;
mod calibrate;
mod error;
mod exchange;
mod guide;
mod hung;
mod inertia;
mod inputs;
mod law;
mod lift;
mod measure;
mod mover;
mod part;
mod play;
mod simulate;
mod slopes;
mod swimmer;

pub use calibrate::{
    CalibrateError, Calibrated, Deviation, JOURNAL, Overlay, RUN, Tally, calibrate, calibrate_in,
    check_records,
};
pub use error::ReducedError;
pub use exchange::{ExchangeError, Exported, Imported, Remark, RobotFormat, export, import};
pub use play::{Player, Playing, Scratch};
pub use simulate::simulate;
pub use slopes::{MotionByNumbers, SlopeError};
