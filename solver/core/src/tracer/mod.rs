//! Particles that the flow carries along: where they begin, and their paths through a step.

mod carry;
mod cloud;
mod flow_step;
mod source;

pub use carry::carry;
pub use cloud::{Cloud, Fate, Particle, Tally};
pub use flow_step::{FlowStep, Passage};
pub use source::{Region, Source};
