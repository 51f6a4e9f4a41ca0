//! Fluid and bodies in one system: nobody else knows both.

mod boundaries;
mod constrain;
mod diagnosis;
mod driven;
mod error;
mod joint_loads;
mod kinematics;
mod linear_system;
mod loads;
mod mass_tolerance;
mod mean_flow;
mod mobility;
mod nullspace;
mod numbering;
mod preconditioning;
mod pressure_mean;
mod problem;
mod projection;
mod propulsion;
mod refine;
mod rigid_equations;
mod rigid_unknowns;
mod shapes;
mod solution;
mod solver_memory;
mod surface_load;
mod system;
mod uniform_flows;
mod wall_distance;

pub use boundaries::{Boundaries, BoundaryNode};
pub use constrain::{BodiesAt, BoundaryValues, count_unknowns, impose_boundary_values};
pub use error::{SolveError, coordinates};
pub use joint_loads::{BodyStates, JointReport, joint_reports};
pub use linear_system::{SolverChoice, memory_estimate};
pub use loads::{BodyLoads, ResidualOnMesh, SurfaceLoads, surface_loads};
pub use mean_flow::MeanFlowReport;
pub use mobility::{BodyLoad, LoadedBody};
pub use problem::{
    Arm, Drive, Group, Joint, JointLaw, Length, MeanFlow, MeanFlowAlong, MeanFlowAt, MovingValue,
    Pivot, Problem, RateDiscontinuities, RigidBody, Side, Spring, TimeValue, Turn, VelocityProfile,
    angle_about, second_moments,
};
pub use projection::DivergenceFreeProjection;
pub use propulsion::{
    LoadedBodies, MeanMotion, PropulsionPower, group_load, mean_motion, propulsion_power,
};
pub use rigid_equations::{
    JointLoad, OlderMotion, PosesByVelocity, RigidBodyEquation, RigidBodyEquations,
};
pub use shapes::{BodyShapes, MovingSurface, ShapeError};
pub use solution::Solution;
pub use surface_load::SurfaceStress;
pub use system::{Configuration, FluidSystem};
