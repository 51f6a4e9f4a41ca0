//! The functions of time of a field, with their keys.

use crate::rules::Findings;
use crate::rules::body::joints::stroke as check_stroke;
use crate::{MagneticSpec, Stroke};

/// A function of time of a field, with its key.
pub struct KeyedStroke<'a> {
    pub key: String,
    pub stroke: &'a Stroke,
}

/// All functions of time of a field.
pub fn strokes(field: &MagneticSpec) -> Vec<KeyedStroke<'_>> {
    let keyed = |rest: String, stroke| {
        let key = format!("field.magnetic.{rest}");
        KeyedStroke { key, stroke }
    };
    let components = field.components.iter().enumerate();
    let mut all: Vec<_> =
        components.map(|(axis, one)| keyed(format!("components.{axis}"), one)).collect();
    let linear = field.linear.iter().filter_map(|linear| linear.factor.as_ref());
    all.extend(linear.map(|factor| keyed("linear.factor".to_owned(), factor)));
    for (nth, dipole) in field.dipoles.iter().enumerate() {
        let factor = dipole.factor.iter();
        all.extend(factor.map(|factor| keyed(format!("dipoles.{nth}.factor"), factor)));
    }
    all
}

/// The numbers of all functions of time of a field.
pub fn check_strokes(findings: &mut Findings<'_>, field: &MagneticSpec) {
    for KeyedStroke { key, stroke } in strokes(field) {
        check_stroke(findings, &key, stroke);
    }
}
