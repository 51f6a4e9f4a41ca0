//! The mesh follows the bodies: elliptic motion, when to mesh anew, and fields from mesh to mesh.

mod elliptic;
mod hold;
mod remesh;
mod rigid;
mod stiffness;
mod surface_distance;
mod transfer;

pub use elliptic::MeshMotion;
pub use hold::{Hold, MotionError, holds};
pub use remesh::{Fresh, Limits, Reason, needs_remesh};
pub use rigid::RigidMove;
pub use stiffness::{MotionKind, Stiffening};
pub use transfer::{Landing, Transfer, TransferReport};
