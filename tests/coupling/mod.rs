//! Fluid and bodies in one system: loads, free motion, reciprocity, energy, frames, threads.

mod failure;
mod free;
mod loads;
mod mean_flow;
mod threads;
