//! Named functions of time at a time.

use crate::case::TimeFunction;

/// Value of a factor in time, 1 where there is none.
#[must_use]
pub fn factor_at(function: Option<&TimeFunction>, time: f64) -> f64 {
    function.map_or(1.0, |function| function.at(time))
}
