//! The soft tier: elastic and active bodies under loads facet by facet, with exact gradients of whole motions.

mod adjoint;
mod angles;
mod body;
mod curve;
mod error;
mod facets;
mod motion;
mod objective;
mod record;
mod tracks;
mod work;

pub use adjoint::{Gradient, Seeds, WithGradient};
pub use angles::{Angles, Bend};
pub use body::SoftBody;
pub use curve::Curve;
pub use error::SoftError;
pub use facets::FacetLaw;
pub use motion::{Plan, Trajectory};
pub use objective::{Markers, Objective, Travel};
pub use record::{Gaps, Record};
pub use tracks::Tracks;
