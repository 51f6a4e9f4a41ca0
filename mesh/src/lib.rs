//! Meshes of simplices around bodies: the door to shapes, generation, quality and files.
//!
//! Planar and axisymmetric problems are meshed in two dimensions; an axisymmetric mesh is the
//! half plane y >= 0 with x along the axis and y the distance from it. Every mesh carries P2
//! (quadratic) geometry: vertices first, then one node per edge.

mod box_tree;
mod check;
mod count;
mod error;
mod hole;
mod locate;
mod mesh;
mod msh;
mod number;
mod periods;
mod planar;
mod quadrature;
mod quality;
mod side_shape;
mod sizing;
pub mod spatial;
mod surface;
#[cfg(test)]
mod test_meshes;
mod vtu;

pub(crate) use alewife_interrupt as interrupt;
pub use box_tree::{Bounds, BoxTree};
pub use check::check_mesh;
pub use error::MeshError;
pub use hole::{Hole, SideOfBody};
pub use locate::{Image, Located, Locator, Neighbours};
pub use mesh::{
    Boundary, BoundaryId, BoundaryKind, CellId, CellMap, CellNodes, Edge, Facet, FacetId, Mesh,
    NodeArray, NodeId, PairedMesh, PeriodicPair, Point, SidePair, Simplex, Topology, Unpaired,
    coordinates_of, jacobian_coefficients, map_quadratic, shape_functions,
};
pub use msh::{
    DomainMesh, Encoding, MshError, MshOptions, Place, ReadMsh, read_msh, read_msh_with,
    read_undivided_msh, write_msh,
};
pub use number::whole;
pub use planar::{
    Closest, Domain, FishForm, FlagellateForm, GapQuery, Moments, Nearest, Outline, PlacedShape,
    Profile, SMALLEST_GAP, Scattered, SecondMoments, Shape, Shares, SizeField, Spline, Station,
    Triangles, TubeForm, Wall, bulge, check_placement, check_wrapped_placement, closest,
    closest_features, closest_to_wall, estimate_cells, generate, generate_wrapped, on_meridian,
    overlap, points_of_outline, thickness, triangulate_inside, wall_features,
};
pub use quadrature::GaussRule;
pub use quality::{CellQuality, Quality, WorstCell};
pub use side_shape::{Circle, SideShape};
pub use sizing::{SizeBox, Sizing};
pub use surface::{
    Facing, FacingSurfaces, NearSurface, Sides, Surface, SurfacePoint, Surroundings,
};
pub use vtu::{Array, Precision, write_points_vtu, write_vtu, write_vtu_as};
