//! Short-range forces that keep bodies apart from each other and from walls, taken implicitly.
//!
//! Gaps are those of the exact outlines ([`alewife_mesh::closest_features`]); every close pair of
//! features counts. The fluid enters through the mobility of the bodies only.

mod error;
mod feature;
mod implicit;
mod law;
mod loads;
mod retract;
mod surfaces;

pub use error::ContactError;
pub use feature::{Feature, Partner};
pub use implicit::{ContactSolution, ContactStep};
pub use law::{Law, LawKind};
pub use loads::{Contact, ContactLoads};
pub use surfaces::{LeastGap, Surfaces};

/// Where a body is: x, y of its centre of mass (m), and its angle (rad), not reduced to one turn.
pub type Place = [f64; 3];
