//! Angles that look like degrees, and phases that look like radians.

use std::collections::HashSet;
use std::f64::consts::TAU;

use super::Findings;
use crate::CaseFile;
use crate::model::numbers::significant;

/// Part of a turn that is taken for rounding.
const ROUNDING: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    // Of a table that is all in degrees the first value tells
    let mut told = HashSet::new();
    for number in file.numbers() {
        let (key, value) = (number.path.as_str(), number.value);
        let last = key.rsplit('.').next().unwrap_or_default();
        let is_angle = ["angle", "heading", "direction", "rest", "rest_angle"].contains(&last)
            || key.contains(".directions.")
            || is_value_of(key, ".bent.angle.");
        // What turns in time may turn more than once
        let may_turn = is_value_of(key, ".turn.") || is_value_of(key, ".rotation.imposed.");
        let looks_like_degrees = if may_turn {
            value.abs() >= 30.0 && value % 15.0 == 0.0
        } else {
            is_angle && value.abs() > TAU * (1.0 + ROUNDING)
        };
        if looks_like_degrees && told.insert(table_of(key).to_owned()) {
            findings.warning(
                key,
                format!("`{key}` is {value}: angles are in radians, and this is more than a turn"),
                // Columns of a file, which become cubic polynomials, are numbers
                &if key.contains(".cubic.") {
                    "for a column in degrees write unit = \"deg\" in `file`".to_owned()
                } else {
                    format!("for {value} degrees write \"{value} deg\"")
                },
            );
        }
        if last == "phase" && value.abs() > 1.0 {
            findings.warning(
                key,
                format!("`{key}` is {value}: phases are parts of a period, not angles"),
                &if value.abs() >= 30.0 && value % 15.0 == 0.0 {
                    format!("for {value} degrees write {}", significant(value / 360.0))
                } else {
                    format!("for {value} rad write {}", significant(value / TAU))
                },
            );
        }
    }
}

/// The table a knot is of, or the key itself.
fn table_of(key: &str) -> &str {
    let mut steps = key.rsplitn(3, '.');
    let is_number = |step: Option<&str>| step.is_some_and(|step| step.parse::<usize>().is_ok());
    let is_knot = is_number(steps.next()) && is_number(steps.next());
    steps.next().filter(|_| is_knot).unwrap_or(key)
}

/// Whether a number is a value, not a time, of a function of time below a table.
fn is_value_of(key: &str, table: &str) -> bool {
    let Some((_, rest)) = key.split_once(table) else { return false };
    let steps: Vec<&str> = rest.split('.').collect();
    match steps.as_slice() {
        ["constant"] | ["steady", "start"] | ["sine", "mean" | "amplitude"] => true,
        ["legs", "knots", _, column] | ["table" | "cubic", _, column] => *column == "1",
        _ => false,
    }
}
