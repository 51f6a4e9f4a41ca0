//! The program: its command line, what it writes, and how it compares with references.
//!
//! The method itself is in `alewife-core`, the case files in `alewife-case`.

pub mod cli;
pub mod observer;
pub mod sweep;
pub mod validation;

pub use alewife_core::{body, case, coupling, flow, simulation, timing};
