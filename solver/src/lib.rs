//! The program: its command line, what it writes, and how it compares with published values.
//!
//! The method itself is in `alewife-core`, the case files in `alewife-case`.

#![warn(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_possible_wrap)]

pub mod cli;
pub mod observer;
pub mod validation;

pub use alewife_core::{body, case, coupling, simulation, timing};
