//! By how much a step is wrong: its local error, what it leaves over a run, and what it does to the energy of contact.

mod contact_energy;
mod error_estimate;
mod step_errors;

pub(super) use contact_energy::{StepEnd, acceleration};
pub use error_estimate::NEARLY_AT_REST;
pub(super) use error_estimate::{local_error, pose_errors};
pub use step_errors::error_of_second_difference;
