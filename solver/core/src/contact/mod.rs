//! Short-range forces that keep bodies apart from each other and from walls, taken implicitly, or at the gaps of a stage where steps
//! are explicit.
//!
//! [`Gaps`] gives the close pairs of points of all surfaces with their exact gaps and derivatives,
//! in the plane those of outlines ([`PlanarGaps`]), in space those of surfaces ([`SpatialGaps`]). The law of the force, the time step with
//! contact and its correction know bodies by pose and rigid motions only, whatever the dimension.
//! The fluid enters through the mobility of the bodies.

mod coupled;
mod dissipation;
mod elastic;
mod energy;
mod error;
mod gaps;
mod implicit;
mod law;
mod loads;

pub use coupled::{
    BodyDynamics, ByMobility, ByQuasiNewton, ContactPrediction, CoupledContact, CoupledSolver,
    ElasticContact, LoadedFlow, SecantMobility, StageContact,
};
pub use dissipation::Dissipation;
pub use elastic::{ElasticBodies, ElasticStep, InnerForces};
pub use energy::{BodyInStep, ContactEnergy, ElasticMotion, StepEnergy};
pub use error::ContactError;
pub use gaps::{
    COORDINATES_OF_SECTION, ContactPair, ContactSurface, Curvatures, FacingPoints, Gaps,
    MinimumGap, PairMatrix, PairVector, Partner, PlanarGaps, PlanarSurface, Section, Sections,
    SpatialGaps, SpatialSurface, SurfaceGaps, frame_of, largest_open_part,
};
pub use implicit::{ContactSolution, ContactStep};
pub use law::{Law, LawKind};
pub use loads::{ContactForce, ContactLoads};
