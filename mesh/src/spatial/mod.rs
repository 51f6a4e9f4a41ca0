//! Meshes of tetrahedra: domains and bodies in space, their sizes, and the generator.
//!
//! A lattice of tetrahedra, graded by longest-edge bisection, is cut by one smooth surface after the
//! other and improved by local changes; where cells touch a curved surface, their quality is that
//! of the curved cell.

mod apart;
mod body_surface;
mod closest;
mod count;
mod curve;
mod domain;
mod gap_query;
mod generate;
mod geometry;
mod imported;
mod least_gap;
mod placement;
mod region;
mod sections;
mod shape;
mod size_field;
mod small_sheets;
mod surface;
mod triangles;

pub use body_surface::{BodySurface, MaterialPoint};
pub use closest::{ClosestPoints, WallSurface};
pub use count::{estimate_cells, estimate_cells_inside};
pub use curve::{Centreline, SpaceSpline};
pub use domain::Domain;
pub use gap_query::GapQuery;
pub use generate::{Purpose, generate, generate_inside};
pub use imported::Imported;
pub use placement::{check_placement, cutting_planes};
pub use region::Region;
pub use sections::{
    RulePoint, Section, SectionHeight, SectionMoments, SectionPoint, Sections, SolidMoments,
    Summand, along_section, in_plane, on_section, parts_of,
};
pub use shape::{Body, Part, Shape};
pub use size_field::SizeField;
pub use surface::{Slender, SolidHole, Triangulated};
pub use triangles::{
    NamedTriangles, Repaired, Repairs, SurfaceFault, SurfaceMeasures, SurfaceMoments,
    TriangleGroup, TriangleMesh,
};
