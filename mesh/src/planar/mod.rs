//! Everything planar by nature: shapes, outlines, domains, sizes, and meshes of triangles.

mod boundary;
mod closest;
mod domain;
mod gap_query;
mod generate;
mod lattice;
mod outline;
mod placement;
mod profile;
mod shape;
mod size_field;
mod spline;
mod torus;
mod vector;

pub use closest::{
    Closest, Wall, closest, closest_features, closest_to_wall, on_meridian, overlap, thickness,
    wall_features,
};
pub use domain::Domain;
pub use gap_query::GapQuery;
pub use generate::{
    Scattered, Shares, Triangles, bulge, generate, generate_wrapped, points_of_outline,
    triangulate_inside,
};
pub use outline::{Nearest, Outline};
pub use placement::{SMALLEST_GAP, check_placement, check_wrapped_placement};
pub use profile::{FishForm, FlagellateForm, Profile, Station, TubeForm};
pub(crate) use shape::closed_profile;
pub use shape::{Moments, PlacedShape, SecondMoments, Shape};
pub use size_field::{SizeField, estimate_cells};
pub use spline::Spline;
