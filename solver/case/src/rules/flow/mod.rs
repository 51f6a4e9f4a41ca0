//! Problems of the fluid, of the sides of its domain and of the mesh.

pub(super) mod boundary;
pub(super) mod cells;
pub(super) mod fluid;
mod given_flow;
pub(super) mod given_mesh;
pub(super) mod mean_flow;
pub(super) mod mesh;
pub(super) mod scalars;
pub(super) mod tracers;
mod viscosity;
