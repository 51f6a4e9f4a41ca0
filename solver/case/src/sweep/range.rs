//! `Range`: values from one number to another, by equal steps or equal factors.

use crate::text::tree::{TomlNode, TomlValue, TreeError};
use crate::text::type_error::suggestion;

/// How a range is written.
pub const EXAMPLE: &str = "a range is { from = 1.0, to = 10.0, n = 5 }, with scale = \"log\" for equal \
                           factors";

/// Most values of a range, and most points of a sweep.
pub const MOST_POINTS: usize = 100_000;

/// Keys of a range.
const KEYS: [&str; 4] = ["from", "to", "n", "scale"];

/// Digits that are kept of a value between the ends: 0.1 + 0.2 becomes 0.3.
const DIGITS: usize = 15;

/// Values from one number to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    from: f64,
    to: f64,
    /// By equal factors, not by equal steps.
    is_log: bool,
    /// Both ends are written as whole numbers.
    is_whole: bool,
}

/// A range, and how many values it has, if that is given.
pub struct CountedRange {
    pub range: Range,
    pub n: Option<usize>,
}

impl Range {
    /// A range between two numbers; `None` if it cannot be one.
    pub fn new(from: f64, to: f64, is_log: bool) -> Option<Self> {
        let is_possible = from.is_finite() && to.is_finite() && (!is_log || from > 0.0 && to > 0.0);
        is_possible.then_some(Self { from, to, is_log, is_whole: false })
    }

    /// The same, whose values are whole numbers if they can be.
    pub fn of_whole_numbers(self) -> Self {
        Self { is_whole: !self.is_log, ..self }
    }

    /// The value at a part of the way, 0 to 1.
    pub fn at(&self, part: f64) -> f64 {
        if self.is_log {
            (self.from.ln() + (self.to.ln() - self.from.ln()) * part).exp()
        } else {
            self.from + (self.to - self.from) * part
        }
    }

    /// So many values with both ends, at least two.
    pub fn values(&self, n: usize) -> Vec<TomlValue> {
        let last = n.saturating_sub(1);
        let value = |i: usize| match i {
            0 => self.from,
            _ if i == last => self.to,
            _ => rounded(self.at(i as f64 / last as f64)),
        };
        let values: Vec<f64> = (0..n).map(value).collect();
        if self.is_whole && values.iter().all(|value| value.fract() == 0.0) {
            values.iter().map(|value| TomlValue::Integer(whole(*value))).collect()
        } else {
            values.into_iter().map(TomlValue::Float).collect()
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "between two numbers that were integers")]
fn whole(value: f64) -> i64 {
    value as i64
}

fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// A number as it is written.
pub fn number(node: &TomlNode) -> Option<f64> {
    match node.value {
        TomlValue::Integer(value) => Some(value as f64),
        TomlValue::Float(value) => Some(value),
        _ => None,
    }
}

/// Reads a number of values or points.
///
/// # Errors
/// When it is none.
pub fn read_count(node: &TomlNode, least: usize) -> Result<usize, TreeError> {
    let count = match node.value {
        TomlValue::Integer(value) => usize::try_from(value).ok(),
        _ => None,
    };
    count.filter(|count| (least..=MOST_POINTS).contains(count)).ok_or_else(|| TreeError {
        origin: node.origin.clone(),
        message: "this is not a number of values a sweep can have".to_owned(),
        help: format!("write a whole number from {least} to {MOST_POINTS}"),
    })
}

/// Reads a range at a path.
///
/// # Errors
/// When it is none.
pub fn read(path: &str, node: &TomlNode) -> Result<CountedRange, TreeError> {
    let refused = |node: &TomlNode, message: String, help: &str| TreeError {
        origin: node.origin.clone(),
        message,
        help: help.to_owned(),
    };
    let Some(table) = node.table() else {
        return Err(refused(node, format!("`{path}` is no range"), EXAMPLE));
    };
    if let Some((key, unknown)) = table.iter().find(|(key, _)| !KEYS.contains(&key.as_str())) {
        return Err(TreeError {
            origin: unknown.key.clone(),
            message: format!("a range has no `{key}`"),
            help: suggestion(key, &KEYS),
        });
    }
    let end = |name: &str| {
        let found = table.get(name).ok_or_else(|| {
            refused(node, format!("the range of `{path}` has no `{name}`"), EXAMPLE)
        })?;
        number(found)
            .filter(|value| value.is_finite())
            .ok_or_else(|| refused(found, format!("`{name}` is not a number"), EXAMPLE))
    };
    let is_log = match table.get("scale").map(|scale| (scale, scale.text())) {
        None | Some((_, Some("linear"))) => false,
        Some((_, Some("log"))) => true,
        Some((scale, _)) => {
            let message = "this is no scale of a range".to_owned();
            return Err(refused(scale, message, "accepted: \"linear\", \"log\""));
        }
    };
    let range = Range::new(end("from")?, end("to")?, is_log).ok_or_else(|| {
        let message =
            format!("the range of `{path}` does not go from one positive number to another");
        refused(node, message, "with scale = \"log\" both ends are larger than 0")
    })?;
    let is_integer =
        |name: &str| matches!(table.get(name).map(|end| &end.value), Some(TomlValue::Integer(_)));
    let range =
        if is_integer("from") && is_integer("to") { range.of_whole_numbers() } else { range };
    let n = table.get("n").map(|n| read_count(n, 2)).transpose()?;
    Ok(CountedRange { range, n })
}
