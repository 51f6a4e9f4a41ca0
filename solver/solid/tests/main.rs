//! Solids against exact solutions, benchmarks and conservation laws.

mod beams;
mod benchmarks;
mod convergence;
mod cook;
mod incompressible;
mod meshes;
mod patch;
mod rigid;
mod time;
