//! Angles with a unit: a number of radians, or a text such as "30 deg".

use serde::{Deserialize, Deserializer};

use super::tree::{TomlNode, TomlValue};
use super::type_error::{Mismatch, TypeError};

/// Name by which a deserializer of case files knows an angle.
pub const ANGULAR: &str = "Angular";

/// Keys of a function of time that are no values of it.
const NO_ANGLES: [&str; 5] = ["period", "phase", "ramp", "duration", "filter"];

/// An angle, or what has angles as its values (rad).
///
/// Within it, every value may be written as a number of radians or as a text with a unit.
#[derive(Debug, Deserialize)]
struct Angular<T>(T);

/// Deserialises an angle, some, or a function of time whose values are angles.
pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    Angular::deserialize(deserializer).map(|Angular(angle)| angle)
}

/// A value with all angles in it that have a unit in radians.
pub fn in_radians(node: &TomlNode) -> Result<TomlNode, TypeError> {
    let mut converted = node.clone();
    match &mut converted.value {
        TomlValue::String(text) => {
            let angle = parse(text).ok_or_else(|| no_angle(text).at(&node.origin))?;
            converted.value = TomlValue::Float(angle);
        }
        TomlValue::Array(items) => {
            for (index, item) in items.iter_mut().enumerate() {
                let is_knot = |item: &TomlNode| item.array().is_some();
                *item = if is_knot(item) { knot_in_radians(item) } else { in_radians(item) }
                    .map_err(|error| error.below(index.to_string()))?;
            }
        }
        TomlValue::Table(entries) => {
            for (key, entry) in entries {
                if !NO_ANGLES.contains(&key.as_str()) {
                    *entry = in_radians(entry).map_err(|error| error.below(key.clone()))?;
                }
            }
        }
        _ => {}
    }
    Ok(converted)
}

/// A knot (time, angle) or (time, angle, rate) with the angle in radians.
fn knot_in_radians(knot: &TomlNode) -> Result<TomlNode, TypeError> {
    let mut converted = knot.clone();
    if let TomlValue::Array(columns) = &mut converted.value
        && let Some(angle) = columns.get_mut(1)
    {
        *angle = in_radians(angle).map_err(|error| error.below("1"))?;
    }
    Ok(converted)
}

/// The angle (rad) that a text with a unit says.
fn parse(text: &str) -> Option<f64> {
    let text = text.trim();
    let number = |unit: &str| text.strip_suffix(unit)?.trim_end().parse::<f64>().ok();
    let angle = number("deg").map(f64::to_radians).or_else(|| number("rad"))?;
    angle.is_finite().then_some(angle)
}

fn no_angle(text: &str) -> TypeError {
    TypeError::new(Mismatch::Other(
        format!("\"{text}\" is not an angle"),
        "write a number of radians, or a text with a unit: 0.5, \"30 deg\", \"0.5 rad\"".to_owned(),
    ))
}

/// How an angle is written: a number of radians, or a text with a unit such as "30 deg".
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the schema is derived from it")]
pub enum Angle {
    /// Radians.
    Number(f64),
    /// With its unit.
    Text(#[schemars(regex(pattern = r"^\s*[-+0-9.eE]+\s*(deg|rad)\s*$"))] String),
}

#[cfg(test)]
mod tests {
    use super::parse;
    use crate::Case;

    #[test]
    fn angles_have_the_unit_of_their_text() {
        assert_eq!(parse("180 deg"), Some(std::f64::consts::PI));
        assert_eq!(parse(" -0.5rad "), Some(-0.5));
        assert_eq!(parse("1e2 rad"), Some(100.0));
        for text in ["30", "30 degrees", "deg", "inf deg", "nan rad", "30 30 deg", "0.5 turn"] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    fn joint(angle: &str) -> Result<Case, crate::CaseError> {
        let text = format!(
            "
title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4, -4], max = [4, 4] }}
mesh = {{ size = 0.2 }}
time = {{ unsteady = {{ step = 0.1, end = 1.0 }} }}
body = [
  {{ name = 'a', shape.ellipse.semi_axes = [0.5, 0.1], center = [0, 0], angle = '90 deg', motion = 'free' }},
  {{ name = 'b', shape.ellipse.semi_axes = [0.5, 0.1], center = [0, 2], motion = 'free' }},
]
joint = [{{ parent = 'a', child = 'b', on_parent = [1, 0], on_child = [-1, 0], kind.bent.angle = {angle} }}]
"
        );
        Case::parse("t.toml", &text, &[]).map(|file| file.model.case)
    }

    #[test]
    fn every_angle_may_have_a_unit() {
        let case = joint("'180 deg'").unwrap();
        assert_eq!(case.body[0].angle, std::f64::consts::FRAC_PI_2);
        for (with_unit, in_radians) in [
            ("'180 deg'", "3.141592653589793"),
            ("{ constant = '0.25 rad' }", "0.25"),
            (
                "{ sine = { mean = '90 deg', amplitude = '1 rad', period = 2.0, phase = 0.5 } }",
                "{ sine = { mean = 1.5707963267948966, amplitude = 1.0, period = 2.0, phase = 0.5 } }",
            ),
            (
                "{ table = [[0.0, '180 deg'], [1.0, 0.5]] }",
                "{ table = [[0.0, 3.141592653589793], [1.0, 0.5]] }",
            ),
        ] {
            assert_eq!(joint(with_unit).unwrap(), joint(in_radians).unwrap(), "{with_unit}");
        }
    }

    #[test]
    fn what_is_no_angle_is_refused_with_what_is_accepted() {
        let message = |angle: &str| joint(angle).unwrap_err().to_string();
        let said = message("{ sine = { amplitude = '30 degrees', period = 2.0 } }");
        for part in ["t.toml:12", "kind.bent.angle.sine.amplitude", "\"30 degrees\"", "\"30 deg\""]
        {
            assert!(said.contains(part), "{said}");
        }
        // Phases are parts of a period, and times are no angles
        assert!(joint("{ sine = { amplitude = 1.0, period = 2.0, phase = '30 deg' } }").is_err());
        assert!(joint("{ table = [['0 deg', 0.0], [1.0, 0.5]] }").is_err());
    }
}
