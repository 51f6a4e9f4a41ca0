//! How a rate is approximated in time.

mod bdf;
mod function;

pub use bdf::Bdf;
pub use function::factor_at;
