//! What moves as one piece: pose, velocity, load and inertia, in three dimensions whatever the flow is.
//!
//! A geometry leaves a body some of the six rigid motions ([`Modes`]).

mod embedding;
mod inertia;
mod load;
mod mesh_poses;
mod modes;
mod pose;
mod twist;

pub use embedding::{in_space, on_mesh};
pub use inertia::{Inertia, carried_velocity};
pub use load::{BodyLoad, LoadedBody};
pub use mesh_poses::MeshPoses;
pub use modes::{Mode, Modes, RigidVector};
pub use pose::{Orientation, Pose, rate_of_displacement};
pub use twist::{Twist, Wrench};
