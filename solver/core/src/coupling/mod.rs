//! Fluid and bodies in one system: nobody else knows both.

mod boundaries;
mod constrain;
mod error;
mod flexible_equation;
mod kinematics;
mod linear_system;
mod loads;
mod mass_tolerance;
mod mean_flow;
mod pressure_mean;
mod problem;
mod projection;
mod rigid_equations;
mod shapes;
mod solution;
mod surface;
mod system;
mod turning_base;
mod uniform_flows;

pub use boundaries::{Boundaries, BoundaryNode};
pub use constrain::{BodiesAt, BoundaryValues, impose_boundary_values};
pub use error::{SolveError, coordinates};
pub use flexible_equation::FlexibleEquation;
pub use linear_system::{SolverChoice, memory_estimate};
pub use loads::{
    BaseReport, BodyLoads, BodyStates, FlexibleReport, FlexibleStates, JointReport,
    LoadDerivatives, LoadWeights, LoadedBodies, MeanMotion, PropulsionPower, ResidualOnMesh,
    SideFlow, SurfaceLoads, SurfaceStress, flexible_report, group_load, joint_reports,
    load_derivatives, mean_motion, propulsion_power, surface_loads,
};
pub use mean_flow::MeanFlowReport;
pub use problem::{
    Arm, AttachedCoordinate, Attachment, BodyVector, Drive, FieldPart, Group, Joint, JointLaw,
    Length, Lever, LocalField, Magnet, MagneticField, MeanFlow, MeanFlowAlong, MeanFlowAt,
    MovingValue, OnBody, Pivot, PressureProfile, Problem, RateDiscontinuities, RigidBody, Side,
    Spring, TimeValue, Turn, UniformField, VelocityProfile, angle_about, coordinate_ranges,
    second_moments,
};
pub use projection::DivergenceFreeProjection;
pub use rigid_equations::{
    JointLoad, OlderMotion, PosesByVelocity, RigidBodyEquation, RigidBodyEquations,
};
pub use shapes::{BodyShapes, ShapeError};
pub use solution::Solution;
pub use surface::{MovingSurface, RestPlaces};
pub use system::{AddedLoads, Configuration, FluidSystem, ForcesBeyond, MeshedBodies, ResidualAt};
pub use turning_base::TurningBase;
