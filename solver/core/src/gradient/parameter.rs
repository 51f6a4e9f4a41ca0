//! `Parameter`: a number of a case by which a gradient is taken.

use super::error::GradientError;
use crate::case::{CaseFile, SOLVED_TABLES, nearest};

/// A number of a case.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    /// Its key.
    pub key: String,
    /// Its value.
    pub value: f64,
    /// How far from it the case is looked at.
    pub step: f64,
}

/// Part of a number by which it is changed: differences leave its square.
const STEP: f64 = 1e-4;
/// Longer steps of differences of complete solutions, which have fewer digits.
const LONGER: f64 = 10.0;

impl Parameter {
    /// The setting that gives it a value.
    pub fn setting(&self, value: f64) -> String {
        format!("{}={value:?}", self.key)
    }

    /// The same with a longer step.
    pub fn with_longer_step(&self) -> Self {
        Self { step: LONGER * self.step, ..self.clone() }
    }

    fn at(file: &CaseFile, key: &str) -> Result<Self, GradientError> {
        let table = key.split('.').next().unwrap_or_default();
        let known = file.number_keys();
        let is_solved =
            |key: &str| SOLVED_TABLES.contains(&key.split('.').next().unwrap_or_default());
        let Some(value) = file.number(key) else {
            let known: Vec<&str> =
                known.iter().map(String::as_str).filter(|key| is_solved(key)).collect();
            let meant = nearest(key, &known).map(|key| format!("do you mean `{key}`? "));
            return Err(GradientError::unknown(
                format!("`{key}` is no number that is written in the case"),
                format!(
                    "{}write the number into the case, or take one that is there: {}",
                    meant.unwrap_or_default(),
                    known.join(", ")
                ),
            ));
        };
        if !SOLVED_TABLES.contains(&table) || key.ends_with(".size") {
            return Err(GradientError::refused(
                file,
                key,
                format!("`{key}` is no number of what is solved"),
                "gradients are taken by numbers of [fluid], [boundary], [[body]], [[swimmer]], [[joint]], [field] and \
                 [scales]; sides of the domain stay where they are",
            ));
        }
        Ok(Self { key: key.to_owned(), value, step: STEP * size(file, key, value) })
    }
}

/// Part of the largest number of a list that each of it has as its size at least.
const BESIDE: f64 = 0.1;

/// The size of a number: its own, that of those beside it in its list, a radian of an angle, or 1 of zero.
fn size(file: &CaseFile, key: &str, value: f64) -> f64 {
    let (list, last) = key.rsplit_once('.').unwrap_or(("", key));
    let beside = (0..).map_while(|index| file.number(&format!("{list}.{index}")));
    let largest = beside.fold(0.0, |most: f64, value| most.max(value.abs()));
    let is_angle = ["angle", "heading"].iter().any(|name| last.contains(name));
    let least = if is_angle { 1.0 } else { BESIDE * largest };
    let size = value.abs().max(least);
    if size > 0.0 { size } else { 1.0 }
}

/// The numbers at these keys.
pub(super) fn parameters(
    file: &CaseFile,
    keys: &[String],
) -> Result<Vec<Parameter>, GradientError> {
    keys.iter().map(|key| Parameter::at(file, key)).collect()
}
