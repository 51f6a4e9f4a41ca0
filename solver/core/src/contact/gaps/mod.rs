//! Surfaces of bodies and walls, and where they are close: pairs of points with their gaps and derivatives.

mod broad_phase;
mod curvature;
mod encounter;
#[expect(clippy::module_inception, reason = "the trait is what the folder is named after")]
mod gaps;
mod pair;
mod pair_vector;
mod planar;
mod section;
mod spatial;
mod surface;
mod surface_gaps;

pub use curvature::Curvatures;
pub use gaps::{Gaps, MinimumGap, largest_open_part};
pub use pair::{ContactPair, Partner};
pub use pair_vector::{PairMatrix, PairVector};
pub use planar::{PlanarGaps, PlanarSurface};
pub use section::{COORDINATES_OF_SECTION, Section, Sections};
pub use spatial::{SpatialGaps, SpatialSurface, frame_of};
pub use surface::{ContactSurface, FacingPoints};
pub use surface_gaps::SurfaceGaps;
