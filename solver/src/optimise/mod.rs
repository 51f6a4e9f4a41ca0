//! Searches for the numbers of a steady flow, of a run without inertia or of a reduced motion, that make an objective large, by its gradients.

mod constraints;
mod error;
mod numbers;
mod objective;
mod optimum;
mod rounds;
mod sought;
mod tier;

pub use constraints::Held;
pub use error::OptimiseError;
pub use objective::{Objective, Objectively};
pub use optimum::{Compared, Optimum};
pub use rounds::{FlowSearch, RoundProgress};
