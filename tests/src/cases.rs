//! Cases given as text, for tests that need a whole run.

use alewife_core::case::{Case, Model};
use alewife_core::run::{RunSummary, simulate};

/// Sides of a channel that is periodic along x.
pub const PERIODIC_CHANNEL: &str = r#"boundary = { left.periodic = "right", right.periodic = "left", bottom = "no-slip", top = "no-slip" }"#;

/// Sides of a box that is periodic along x and y.
pub const PERIODIC_BOX: &str = r#"boundary = { left.periodic = "right", right.periodic = "left", bottom.periodic = "top", top.periodic = "bottom" }"#;

/// A case from its text, with what follows from it.
///
/// # Panics
/// When the text is not a valid case.
#[must_use]
pub fn case(text: &str) -> Model {
    Case::parse("test", text, &[]).unwrap_or_else(|error| panic!("{error}")).model
}

/// Runs a case without writing anything.
///
/// # Panics
/// When the run fails.
#[must_use]
pub fn run(model: &Model) -> RunSummary {
    simulate::<2>(model, &mut []).expect("the case runs")
}

/// All values of a quantity.
///
/// # Panics
/// When there is no such quantity.
#[must_use]
pub fn column(outcome: &RunSummary, quantity: &str) -> Vec<f64> {
    outcome.series.column(quantity).expect("the quantity exists")
}

/// The last value of a quantity.
///
/// # Panics
/// When there is no such quantity.
#[must_use]
pub fn last(outcome: &RunSummary, quantity: &str) -> f64 {
    *column(outcome, quantity).last().expect("the run has a row")
}
