//! Contact forces: laws, equilibria, balance, rest for ever, symmetry, many contacts at once.
#![expect(clippy::unwrap_used, reason = "a test that cannot set up its bodies has failed")]

mod common;
mod equilibria;
mod pairs;
mod random;
mod rebound;
