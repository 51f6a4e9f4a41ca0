//! Swimmers in a viscous fluid: bodies move, the mesh follows, one system gives fluid and bodies
//! together, observers look on.

pub mod body;
pub mod contact;
pub mod coupling;
pub mod gait;
pub mod gradient;
pub mod motion;
pub mod run;
pub mod scalar;
pub mod state;
pub mod step;
pub mod time;
pub mod timing;
pub mod tracer;

pub use alewife_case as case;
pub use alewife_flow::{flow, space};
pub use alewife_linear::{algebra, multifrontal};
pub use alewife_solid::{rod, structure};
