//! Angles that look like degrees, and phases that look like radians.

use std::collections::{BTreeMap, HashSet};
use std::f64::consts::{PI, TAU};

use super::column::has_word;
use crate::CaseFile;
use crate::model::numbers::significant;
use crate::rules::Findings;
use crate::text::type_error::{CYCLE_OF_A_FILE, KNOTS_OF_A_FILE};

/// Part of a turn that is taken for rounding.
const ROUNDING: f64 = 1e-6;

/// Tables that are functions of time whose values are angles.
const FUNCTIONS: [&str; 3] = [".angle.", ".turn.", ".rotation.imposed."];

/// Swings of more than a turn, to and fro and to again, that make an oscillation: what turns on and on, and back,
/// has fewer.
const SWINGS: usize = 3;

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    let meant = file.recorded.iter().filter(|stroke| stroke.has_unit);
    let meant: Vec<String> = meant.map(|stroke| format!("{}.", stroke.key)).collect();
    let is_meant = |key: &str| meant.iter().any(|stroke| key.starts_with(stroke));
    // Of a table that is all in degrees the first value tells
    let mut told = HashSet::new();
    names_of_columns(findings, file, &mut told);
    let mut knots: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let numbers = file.numbers();
    for number in &numbers {
        let (key, value) = (number.path.as_str(), number.value);
        if key.ends_with(".phase") && value.abs() > 1.0 {
            phase(findings, key, value);
        }
        if is_meant(key) {
            continue;
        }
        let is_function = FUNCTIONS.iter().any(|table| is_value_of(key, table));
        if is_function && table_of(key) != key {
            knots.entry(table_of(key)).or_default().push(value);
        }
        let swings =
            key.ends_with(".sine.amplitude") && is_function && value.abs() > PI * (1.0 + ROUNDING);
        let more = if looks_like_degrees(key, value) {
            "this is more than a turn"
        } else if swings {
            "this is an oscillation by more than half a turn to either side"
        } else {
            continue;
        };
        if told.insert(table_of(key).to_owned()) {
            degrees(findings, key, value, more);
        }
    }
    for (table, values) in knots {
        let is_new = !told.contains(table);
        if let (true, Some(largest)) = (is_new && swings(&values) >= SWINGS, largest(&values)) {
            let more = "it swings by more than a turn, to and fro";
            degrees(findings, table, largest, more);
        }
    }
}

/// Asks for the unit of columns of angles that are by their names in degrees.
fn names_of_columns(findings: &mut Findings<'_>, file: &CaseFile, told: &mut HashSet<String>) {
    for stroke in file.recorded.iter().filter(|stroke| !stroke.has_unit) {
        let (key, column) = (format!("{}.", stroke.key), &stroke.columns[1]);
        let is_angle = FUNCTIONS.iter().any(|table| key.ends_with(table));
        if is_angle && has_word(column, &["deg", "degs", "degree", "degrees", "°"]) {
            findings.warning(
                &stroke.key,
                format!(
                    "angles of column `{column}` are by its name in degrees, and read as radians"
                ),
                "write unit = \"deg\" in `file`, or unit = \"rad\" if they are radians",
            );
            told.insert(key.clone() + KNOTS_OF_A_FILE);
            told.insert(key + CYCLE_OF_A_FILE + ".knots");
        }
    }
}

/// Whether the value of a key is an angle of more than a turn, or of a body that may turn on a round number of
/// degrees.
fn looks_like_degrees(key: &str, value: f64) -> bool {
    let last = key.rsplit('.').next().unwrap_or_default();
    let is_angle = ["angle", "heading", "direction", "rest", "rest_angle"].contains(&last)
        || key.contains(".directions.")
        || is_value_of(key, ".angle.");
    // What turns in time may turn more than once
    let may_turn = is_value_of(key, ".turn.") || is_value_of(key, ".rotation.imposed.");
    if may_turn {
        value.abs() >= 30.0 && value % 15.0 == 0.0
    } else {
        is_angle && value.abs() > TAU * (1.0 + ROUNDING)
    }
}

/// Asks whether an angle is in degrees.
fn degrees(findings: &mut Findings<'_>, key: &str, value: f64, more: &str) {
    // Columns of a file, which become cubic polynomials, are numbers
    let is_of_file = [KNOTS_OF_A_FILE, CYCLE_OF_A_FILE]
        .iter()
        .any(|name| format!("{key}.").contains(&format!(".{name}.")));
    findings.warning(
        key,
        format!("`{key}` is {value}: angles are in radians, and {more}"),
        &if is_of_file {
            "for a column in degrees write unit = \"deg\" in `file`, and unit = \"rad\" if radians are meant"
                .to_owned()
        } else {
            format!("for {value} degrees write \"{value} deg\", and \"{value} rad\" if radians are meant")
        },
    );
}

/// Asks whether a phase is an angle.
fn phase(findings: &mut Findings<'_>, key: &str, value: f64) {
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

/// How often values that follow each other change by more than a turn before they come back by as much.
fn swings(values: &[f64]) -> usize {
    let Some(&first) = values.first() else { return 0 };
    let (mut n, mut sense, mut extreme, mut other) = (0, 0.0, first, first);
    for &value in values {
        if sense == 0.0 {
            (extreme, other) = (extreme.max(value), other.min(value));
            if extreme - other > TAU * (1.0 + ROUNDING) {
                (n, sense) = (1, if value == extreme { 1.0 } else { -1.0 });
                extreme = value;
            }
        } else if (value - extreme) * sense > 0.0 {
            extreme = value;
        } else if (extreme - value) * sense > TAU * (1.0 + ROUNDING) {
            (n, sense, extreme) = (n + 1, -sense, value);
        }
    }
    n
}

/// The value of the largest size.
fn largest(values: &[f64]) -> Option<f64> {
    values.iter().copied().max_by(|one, other| one.abs().total_cmp(&other.abs()))
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
        ["legs" | "cycle", "knots", _, column] | ["table" | "cubic", _, column] => *column == "1",
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::swings;

    #[test]
    fn what_goes_to_and_fro_has_swings() {
        let wave = |amplitude: f64, n: u32| -> Vec<f64> {
            let at = |i: u32| amplitude * (f64::from(i) * 0.3).sin();
            (0..n).map(at).collect()
        };
        assert_eq!(swings(&wave(3.1, 200)), 0, "less than half a turn to either side");
        assert!(swings(&wave(20.0, 200)) > 10);
        // A motor that turns on, and one that turns back at last
        let on: Vec<f64> = (0..100).map(f64::from).collect();
        let back: Vec<f64> = on.iter().chain(on.iter().rev()).copied().collect();
        assert_eq!((swings(&on), swings(&back)), (1, 2));
        assert_eq!(swings(&[]), 0);
    }
}
