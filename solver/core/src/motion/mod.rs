//! The mesh follows the bodies: elliptic motion, when to remesh, and transfer of fields to another mesh.

mod boundary_condition;
mod elliptic;
mod remesh;
mod rigid;
mod stiffness;
mod surface_distance;
mod transfer;

pub use boundary_condition::{
    MeshBoundaryCondition, MotionError, PrescribedDisplacement, mesh_boundary_conditions,
};
pub use elliptic::MeshMotion;
pub use remesh::{Fresh, Limits, Reason, needs_remesh};
pub use rigid::RigidMove;
pub use stiffness::{MotionKind, Stiffening};
pub use transfer::{Landing, Transfer, TransferReport};
