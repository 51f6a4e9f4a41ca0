//! The reduced tier: trees of rigid links in the plane and in space under loads by laws, with exact derivatives.

mod cholesky;
pub mod compiled;
mod connection;
mod drift;
mod equations;
mod error;
mod fit;
mod link;
pub mod loads;
mod placement;
mod spatial;
mod state;
mod step;
mod tendon;
mod thrusters;
mod topology;

pub use num_dual::Dual64;

pub use connection::{Connection, magnus, nodes};
pub use drift::Drift;
pub use equations::Inputs;
pub use error::TreeError;
pub use fit::{Bounds, Fit, Residuals, fit, fit_linear};
pub use link::{Command, Drive, Joint, JointKind, Link, PlacedLoad, Stops, Weight};
pub use placement::Placement;
pub use spatial::{Number, Pose, Symmetric, Twist, Wrench, norm, real, rotation, vector};
pub use state::State;
pub use step::{Scheme, Stepper};
pub use tendon::{Site, Tendon};
pub use thrusters::{Lag, Thruster, Thrusters};
pub use topology::{Root, Tree};
