//! Contact coupled with the flow: its forces belong to the gaps at the end of a step, or of a stage (`explicit.rs`), and the flow
//! is linear in them: contact is refused with convection by Newton's method.
//!
//! On one configuration of the mesh the velocities of bodies are U = U* + M f, with loads f and the mobility M: the
//! equations of fluid and bodies condensed to the bodies. [`ContactStep`] finds the loads by Newton's method where M is known.
//! [`ByMobility`] has M from the factors of the system; where each column of M takes a solution by iterations,
//! [`ByQuasiNewton`] approximates it by secants. What they ask of a flow is [`LoadedFlow`]: contact knows neither
//! meshes nor equations.

mod body_rows;
mod by_mobility;
mod coupled_contact;
mod coupled_solver;
mod drag_mobility;
mod explicit;
mod loaded_flow;
mod predict;
mod quasi_newton;
mod secant_mobility;

pub use by_mobility::ByMobility;
pub use coupled_contact::{CoupledContact, ElasticContact};
pub use coupled_solver::CoupledSolver;
pub use drag_mobility::BodyDynamics;
pub use explicit::StageContact;
pub use loaded_flow::LoadedFlow;
pub use predict::ContactPrediction;
pub use quasi_newton::ByQuasiNewton;
pub use secant_mobility::SecantMobility;
