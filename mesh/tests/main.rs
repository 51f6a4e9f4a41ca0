//! Meshes through the door of the crate: any valid placement of bodies is meshed, and well.

mod closest;
mod common;
mod interrupted;
mod msh;
mod polygons;
mod properties;
mod sizes;
mod tetrahedra;
mod torus;
