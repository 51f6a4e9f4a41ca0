//! Numbers, lists, texts and names as TOML and cases have them.

use std::collections::BTreeSet;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use crate::reduced::exchange::markup::{number, words};

/// Numbers as a list of TOML.
pub(super) fn list(values: &[f64]) -> String {
    let floats: Vec<String> = words(values).into_iter().map(with_point).collect();
    format!("[{}]", floats.join(", "))
}

/// A number as a float of TOML.
pub(super) fn float(value: f64) -> String {
    with_point(number(value))
}

/// A number that is read as a float.
fn with_point(word: String) -> String {
    if word.contains(['.', 'e']) { word } else { word + ".0" }
}

/// A text as a string of TOML.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A remark in one line.
pub(super) fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// A rotation as a quaternion.
pub(super) fn quaternion(turn: &Matrix3<f64>) -> String {
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*turn));
    list(&[q.w, q.i, q.j, q.k])
}

/// Longest name.
const LONGEST: usize = 60;

/// Words that stand for something else in a case: sides of its region, what does not move, columns.
const TAKEN: [&str; 9] =
    ["left", "right", "bottom", "top", "back", "front", "laboratory", "flow", "time"];

/// Names that were given.
#[derive(Debug, Default)]
pub(super) struct Names {
    given: BTreeSet<String>,
}

impl Names {
    /// A name like one of a file: its letters and digits, and a number behind where it is taken.
    pub fn of(&mut self, name: &str) -> String {
        let plain = |c: char| {
            if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' }
        };
        let mut word: String = name.chars().map(plain).take(LONGEST).collect();
        if word.is_empty() {
            word = "body".to_owned();
        }
        if TAKEN.contains(&word.as_str()) {
            word.push_str("-part");
        }
        let mut free = word.clone();
        let mut nth = 2;
        while self.given.contains(&free) {
            free = format!("{word}-{nth}");
            nth += 1;
        }
        self.given.insert(free.clone());
        free
    }
}

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn names_are_words_and_differ() {
        let mut names = Names::default();
        let given =
            ["arm/link 1", "arm/link_1", "arm-link-1", "left", "", "ein Körper", "arm-link-1"];
        let found = given.map(|name| names.of(name));
        let expected = [
            "arm-link-1",
            "arm-link_1",
            "arm-link-1-2",
            "left-part",
            "body",
            "ein-K-rper",
            "arm-link-1-3",
        ];
        assert_eq!(found, expected);
    }
}
