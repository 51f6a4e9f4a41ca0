//! `Findings`: the diagnostics of a case found so far.

use crate::read::CaseFile;
use crate::text::diagnostic::{Diagnostic, Severity};
use crate::{Case, Model};

/// Diagnostics of the same kind on bodies that are made for the same swimmer.
const MOST_ALIKE: usize = 3;

/// Errors, and warnings, that are located in their file.
const MOST_LOCATED: usize = 100;

/// Characters of a number that are written out; of longer ones the first digits.
const MOST_DIGITS: usize = 12;

/// The first ten digits of a number, as a power of ten where it would still be long.
fn shortened(value: f64) -> String {
    let power = format!("{value:.9e}");
    let plain = power.parse().map_or_else(|_| power.clone(), |rounded: f64| rounded.to_string());
    if plain.len() <= MOST_DIGITS && value.abs() < f64::MAX {
        return plain;
    }
    let (digits, exponent) = power.split_once('e').unwrap_or((&power, "0"));
    format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
}

/// A message whose numbers have no endless digits: 1e308 stays 1e308, and 0.1 + 0.2 is 0.3.
fn readable(message: &str) -> String {
    let mut text = String::with_capacity(message.len());
    let mut rest = message;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let after = &rest[start..];
        let length = after.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(after.len());
        let number = after[..length].trim_end_matches('.');
        text += &rest[..start];
        match number.parse::<f64>() {
            Ok(value) if number.len() > MOST_DIGITS => text += &shortened(value),
            _ => text += number,
        }
        rest = &after[number.len()..];
    }
    text + rest
}

/// Two keys of which one has to be given.
#[derive(Debug, Clone, Copy)]
pub struct OneOf<'a> {
    /// What they are of, such as "a rod".
    pub what: &'a str,
    /// Both.
    pub names: [&'a str; 2],
    /// Which of them are given.
    pub given: [bool; 2],
    /// What each of them is.
    pub help: &'a str,
}

/// The diagnostics found so far.
pub struct Findings<'a> {
    file: &'a CaseFile,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Findings<'a> {
    /// None yet.
    pub fn new(file: &'a CaseFile) -> Self {
        Self { file, diagnostics: Vec::new() }
    }

    /// All of them, in the order in which they were found.
    pub fn into_diagnostics(self) -> Vec<Diagnostic> {
        self.diagnostics
    }

    /// The case as it is written.
    pub fn case(&self) -> &'a Case {
        &self.file.model.case
    }

    /// What follows from it.
    pub fn model(&self) -> &'a Model {
        &self.file.model
    }

    /// Whether there are warnings at most.
    pub fn has_no_error(&self) -> bool {
        self.diagnostics.iter().all(|one| one.severity == Severity::Warning)
    }

    fn add(&mut self, severity: Severity, key: &str, message: String, help: &str) {
        let made = self.written(key);
        // Copies of a swimmer are all wrong in the same way
        let is_same = |one: &&Diagnostic| one.key == made && one.help == help;
        if made != key && self.diagnostics.iter().filter(is_same).count() >= MOST_ALIKE {
            return;
        }
        let key = &made;
        // Lines are counted from the start of the file, and of so many only the first ones are read
        let n_before = self.diagnostics.iter().filter(|one| one.severity == severity).count();
        let location = if n_before < MOST_LOCATED { self.file.location(key) } else { None };
        let (key, message, help) = (key.to_owned(), readable(&message), readable(help));
        self.diagnostics.push(Diagnostic { severity, key, message, help, location });
    }

    /// The key of what stands in the file: for one of a body made for a swimmer that of the swimmer.
    fn written(&self, key: &str) -> String {
        let number = |list: &str| {
            let rest = key.strip_prefix(list)?;
            rest.split('.').next()?.parse::<usize>().ok()
        };
        let of_body = number("body.").and_then(|body| self.model().swimmer_of_body(body));
        let of_joint = number("joint.").and_then(|joint| self.model().swimmer_of_joint(joint));
        of_body
            .or(of_joint)
            .map_or_else(|| key.to_owned(), |swimmer| format!("swimmer.{swimmer}.kind"))
    }

    /// Adds an error.
    pub fn error(&mut self, key: &str, message: String, help: &str) {
        self.add(Severity::Error, key, message, help);
    }

    /// Adds a warning.
    pub fn warning(&mut self, key: &str, message: String, help: &str) {
        self.add(Severity::Warning, key, message, help);
    }

    /// Whether one of two keys is given, as has to be; that none or both are is reported.
    pub fn one_of(&mut self, key: &str, of: &OneOf<'_>) -> bool {
        let OneOf { what, names: [one, other], given, help } = of;
        match given {
            [true, true] => self.error(
                key,
                format!("{what} has both `{one}` and `{other}`"),
                &format!("leave one of them out: {help}"),
            ),
            [false, false] => self.error(
                key,
                format!("{what} has neither `{one}` nor `{other}`"),
                &format!("write one of them: {help}"),
            ),
            _ => return true,
        }
        false
    }

    /// Whether nothing is wrong with a key or what is in its table.
    pub fn is_right(&self, key: &str) -> bool {
        let written = self.written(key);
        self.diagnostics.iter().all(|one| !one.key.starts_with(&written))
    }

    /// Whether a vector has a number for each dimension; one that has not is refused elsewhere.
    pub fn is_vector(&self, values: &[f64]) -> bool {
        values.len() == self.case().geometry.dimensions()
    }
}

#[cfg(test)]
mod tests {
    use super::readable;

    #[test]
    fn numbers_with_endless_digits_become_powers_of_ten() {
        let huge = f64::MAX;
        let tiny = -1e-300;
        assert_eq!(readable(&format!("`a.0.b` is {huge}.")), "`a.0.b` is 1.797693135e308.");
        assert_eq!(readable(&format!("[{tiny}, 0.125]")), "[-1e-300, 0.125]");
        assert_eq!(readable("3.141592653589793, body-12, v1."), "3.141592654, body-12, v1.");
        assert_eq!(readable("0.30000000000000004 of 10000000"), "0.3 of 10000000");
    }
}
