//! Fluid and bodies in one system: loads, free motion, reciprocity, energy, frames, threads.

mod blow_up;
mod driven_sides;
mod failure;
mod free;
mod holes;
mod holes_in_space;
mod loads;
mod magnets;
mod mean_flow;
mod periodic_given;
mod rods_on_bodies;
mod rods_on_bodies_in_space;
mod sides;
mod step_errors;
mod threads;
