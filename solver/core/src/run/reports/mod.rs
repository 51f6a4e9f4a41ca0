//! What a run reports of the errors that its steps leave: in the first cycle of a swimmer, and over all steps.

mod cycle_report;
mod step_report;

pub use cycle_report::CycleReport;
pub(super) use step_report::LoadErrors;
pub use step_report::StepErrorReport;
