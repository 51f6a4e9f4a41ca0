//! The mesh follows the bodies: elliptic motion, rolling on round bodies, when to remesh, and transfer of a flow to another
//! mesh.

mod boundary_condition;
mod elliptic;
mod moving_mesh;
mod new_mesh;
mod present_gaps;
mod remesh;
mod replace_mesh;
mod rigid;
mod rolling;
mod scene;
mod stiffness;
mod surface_distance;
mod transfer;

pub use boundary_condition::{
    MeshBoundaryCondition, MotionError, PrescribedDisplacement, mesh_boundary_conditions,
};
pub use elliptic::MeshMotion;
pub use moving_mesh::{DEGENERATE, GapsAt, MotionSettings, MovingMesh};
pub use present_gaps::PresentGaps;
pub use remesh::{Fresh, Limits, Reason, needs_remesh};
pub use replace_mesh::replace_mesh;
pub use rigid::RigidMove;
pub use scene::{Meshed, MostCells, PosesByShift, RemeshError, RestPlace, Scene, UNCERTAIN};
pub use stiffness::{MotionKind, Stiffening};
pub use transfer::{Landing, Transfer, TransferReport};
