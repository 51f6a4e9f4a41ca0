//! What evolves in a run: mesh, flow and bodies at two levels, and the balances over time.

mod cycle_error;
mod cycles;
mod energy;
mod energy_supply;
mod initial_levels;
mod momentum;
mod new_level;
mod propulsion_history;
mod saved_mesh;
mod shape_state;
#[expect(clippy::module_inception, reason = "the state itself is what the room is named after")]
mod state;
mod step_errors;
#[cfg(test)]
mod tests;

pub use cycle_error::{CycleError, Leg, StagePoint, Waypoint};
pub use cycles::{CycleMeans, Cycles, Record};
pub use energy::{EnergyBalance, EnergyRecord};
pub use energy_supply::{Drives, EnergySupply, LoadHistory, LoadStep};
pub use initial_levels::InitialLevels;
pub use momentum::{MomentumBalance, MomentumRecord};
pub use new_level::{NewLevel, TransferredState};
pub use propulsion_history::{PowerShare, PropulsionHistory, PropulsionStep};
pub use saved_mesh::is_consistent;
pub use shape_state::ShapeState;
pub use state::{Evolving, State};
pub use step_errors::{ErrorOfChange, SquaredError, StepErrors};
