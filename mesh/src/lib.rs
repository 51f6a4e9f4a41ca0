//! Meshes of simplices around bodies: the door to shapes, generation, quality and files.
//!
//! Planar and axisymmetric problems are meshed in two dimensions; an axisymmetric mesh is the
//! half plane y >= 0 with x along the axis and y the distance from it. Every mesh carries P2
//! (quadratic) geometry: vertices first, then one node per edge.

mod domain;
mod mesh;
mod shape;
mod sizing;

pub use domain::Domain;
pub use mesh::{Boundary, BoundaryKind, Facet, Mesh, Point, nodes_per_cell};
pub use shape::{PlacedShape, Shape};
pub use sizing::{SizeBox, Sizing};
