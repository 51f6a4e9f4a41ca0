//! Short-range forces that keep bodies apart from each other and from walls, taken implicitly.
//!
//! [`Gaps`] gives the close pairs of points of all surfaces with their exact gaps and derivatives,
//! in the plane those of outlines ([`PlanarGaps`]), in space those of surfaces ([`SpatialGaps`]). The law of the force, the time step with
//! contact and its correction know bodies by pose and rigid motions only, whatever the dimension.
//! The fluid enters through the mobility of the bodies.

mod broad_phase;
mod correction;
mod coupled;
mod curvature;
mod direction;
mod encounter;
mod error;
mod gaps;
mod implicit;
mod law;
mod loads;
mod pair;
mod pair_vector;
mod planar;
mod spatial;
mod surface;
mod surface_gaps;
mod unknowns;

pub use coupled::{
    BodyDynamics, ByMobility, ByQuasiNewton, ContactPrediction, CoupledContact, CoupledSolver,
    LoadedFlow, SecantMobility, StageContact,
};
pub use curvature::Curvatures;
pub use error::ContactError;
pub use gaps::{Gaps, MinimumGap};
pub use implicit::{ContactSolution, ContactStep};
pub use law::{Law, LawKind};
pub use loads::{ContactForce, ContactLoads};
pub use pair::{ContactPair, Partner};
pub use pair_vector::{PairMatrix, PairVector};
pub use planar::{PlanarGaps, PlanarSurface};
pub use spatial::{SpatialGaps, SpatialSurface, frame_of};
pub use surface::{ContactSurface, FacingPoints};
pub use surface_gaps::SurfaceGaps;
