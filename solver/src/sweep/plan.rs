//! `Plan`: what a sweep is, as `sweep.json` has it; what differs between two of them.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::case_hash::keys_of;
use crate::case::{CaseError, Sweep};

/// Differences that a message lists at most.
const MOST_LISTED: usize = 12;
/// Characters of a value that a message shows.
const SHOWN: usize = 60;

/// What a sweep is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Version of the program that began it.
    pub alewife: String,
    /// Name of the case, with its variant.
    pub case: String,
    /// Paths of the keys that are swept.
    pub swept: Vec<String>,
    /// Quantities to collect, besides those of references.
    pub quantities: Vec<String>,
    /// Values of these keys at each point, the first point first.
    pub points: Vec<Vec<Value>>,
    /// All other keys of the case that decide what is computed, by their paths.
    pub keys: BTreeMap<String, String>,
    /// Checksum of what is computed at each point, the first point first; none in plans of earlier versions.
    #[serde(default)]
    pub cases: Vec<String>,
}

impl Plan {
    /// The plan of a sweep, without the checksums of its cases.
    ///
    /// # Errors
    /// When the case of its first point is wrong, or cannot be written.
    pub fn new(sweep: &Sweep) -> Result<Self, CaseError> {
        let swept: Vec<String> = sweep.keys().into_iter().map(str::to_owned).collect();
        let first = if sweep.is_soft() {
            serde_json::to_value(sweep.soft_case(0)?.case)
        } else {
            serde_json::to_value(sweep.case(0)?.case())
        };
        let first = first.map_err(|error| CaseError::Unreadable {
            path: sweep.file().into(),
            source: error.into(),
        })?;
        let mut keys = keys_of(&first);
        keys.retain(|key, _| !swept.iter().any(|swept| is_within(key, swept)));
        Ok(Self {
            alewife: env!("CARGO_PKG_VERSION").to_owned(),
            case: sweep.name(),
            swept,
            quantities: sweep.quantities.iter().map(ToString::to_string).collect(),
            points: (0..sweep.n_points()).map(|index| sweep.point(index).values()).collect(),
            keys,
            cases: Vec::new(),
        })
    }

    /// What a point sets, in words.
    #[must_use]
    pub fn label(&self, index: usize) -> String {
        let values = self.points.get(index).into_iter().flatten();
        let settings = self.swept.iter().zip(values);
        settings.map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
    }

    /// What of the runs of an earlier plan would differ, line by line.
    #[must_use]
    pub fn differences(&self, earlier: &Self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.swept != earlier.swept {
            let [there, here] = [earlier, self].map(|plan| plan.swept.join(", "));
            lines.push(format!("swept keys: {there} there, {here} here"));
        } else if self.points.len() != earlier.points.len() {
            let [there, here] = [earlier, self].map(|plan| plan.points.len());
            lines.push(format!("number of points: {there} there, {here} here"));
        } else {
            let differs = |index: &usize| !are_equal(&self.points[*index], &earlier.points[*index]);
            for index in (0..self.points.len()).filter(differs) {
                let [there, here] = [earlier, self].map(|plan| plan.label(index));
                lines.push(format!("point {}: {there} there, {here} here", index + 1));
            }
        }
        let keys: BTreeSet<&String> = self.keys.keys().chain(earlier.keys.keys()).collect();
        for key in keys.into_iter().filter(|key| self.keys.get(*key) != earlier.keys.get(*key)) {
            let [there, here] = [earlier, self].map(|plan| {
                plan.keys.get(key).map_or_else(|| "absent".to_owned(), |value| shortened(value))
            });
            lines.push(format!("{key}: {there} there, {here} here"));
        }
        let more = lines.len().saturating_sub(MOST_LISTED);
        lines.truncate(MOST_LISTED);
        if more > 0 {
            lines.push(format!("and {more} more"));
        }
        lines
    }
}

/// Whether a key is a swept one, or in it.
fn is_within(key: &str, swept: &str) -> bool {
    key.strip_prefix(swept).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Whether values are the same; 1 is 1.0.
fn are_equal(one: &[Value], other: &[Value]) -> bool {
    let is_equal = |(one, other): (&Value, &Value)| {
        one == other || one.as_f64().is_some_and(|value| Some(value) == other.as_f64())
    };
    one.len() == other.len() && one.iter().zip(other).all(is_equal)
}

fn shortened(value: &str) -> String {
    match value.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &value[..end]),
        None => value.to_owned(),
    }
}
