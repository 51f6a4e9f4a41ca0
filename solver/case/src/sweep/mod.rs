//! `[sweep]`: many runs of one case, with values of some of its keys; nothing is run here.

mod axis_setting;
mod cases;
mod entries;
mod latin_hypercube;
mod quantity;
mod range;
pub mod spec;
#[cfg(test)]
mod tests;

pub use cases::{Sweep, SweepPoint};
pub use quantity::SweepQuantity;
