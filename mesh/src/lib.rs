//! Meshes of simplices around bodies: the door to shapes, generation, quality and files.
//!
//! Planar and axisymmetric problems are meshed in two dimensions; an axisymmetric mesh is the
//! half plane y >= 0 with x along the axis and y the distance from it. Every mesh carries P2
//! (quadratic) geometry: vertices first, then one node per edge.

mod box_tree;
mod check;
mod closest;
mod curved;
mod cut;
mod domain;
mod error;
mod generate;
mod index;
mod locate;
mod mesh;
mod outline;
mod profile;
mod quadrature;
mod quality;
mod shape;
mod simplex;
mod sizing;
mod spline;
mod surroundings;
#[cfg(test)]
mod test_meshes;
mod vtu;

pub use check::check_mesh;
pub use closest::{
    Closest, Wall, closest, closest_features, closest_to_wall, on_meridian, overlap, thickness,
    wall_features,
};
pub use curved::{CellMap, CellNodes, jacobian_coefficients, map_quadratic, shape_functions};
pub use cut::Cut;
pub use domain::Domain;
pub use error::MeshError;
pub use generate::{check_placement, check_wrapped_placement, generate, generate_along};
pub use index::{BoundaryId, CellId, FacetId, NodeId};
pub use locate::{Located, Locator};
pub use mesh::{Boundary, BoundaryKind, Edge, Facet, Mesh, PeriodicPair, Point};
pub use outline::{Nearest, Outline};
pub use profile::{FishForm, FlagellateForm, Profile, Station};
pub use quality::{CellQuality, Quality, WorstCell};
pub use shape::{Moments, PlacedShape, SecondMoments, Shape};
pub use simplex::{NodeArray, Simplex};
pub use sizing::{SizeBox, SizeField, Sizing};
pub use spline::Spline;
pub use surroundings::Surroundings;
pub use vtu::{Array, Precision, write_vtu, write_vtu_as};
