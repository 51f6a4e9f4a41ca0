//! What a soft case may seek, and what it may be compared with.

use super::mistakes::Mistakes;
use crate::soft::ParameterKey;
use crate::soft::search::{ObjectiveSpec, Parameter, SearchSettings};
use crate::soft::spec::{ReferenceOf, SoftCase};
use crate::soft::stretch::Stretch;

/// Frames that a mean is taken of at least: with fewer a taper is hardly more than one of them.
const FEWEST_FRAMES: usize = 4;

/// Part of a frame that a time may be off by rounding.
const ROUNDING: f64 = 1e-6;

pub fn check(mistakes: &mut Mistakes<'_>) {
    let case = mistakes.case().clone();
    if let Some(calibration) = &case.calibration {
        let has_angles = case.angle.iter().any(|angle| angle.column.is_some());
        if !has_angles && !case.marker.iter().any(|marker| !marker.columns.is_empty()) {
            let message = "nothing recorded can be compared with".to_owned();
            let help = "add [record], and `columns` to the markers, or a `column` to the angles, that are in it";
            mistakes.add("calibration", message, help);
        }
        parameters(mistakes, "calibration", &calibration.parameter);
        settings(mistakes, "calibration", &calibration.search);
    }
    if let Some(optimisation) = &case.optimisation {
        let kind = match &optimisation.objective {
            ObjectiveSpec::Travel { cost_of_work, .. } => {
                let key = "optimisation.objective.travel.cost_of_work";
                mistakes.not_negative(key, *cost_of_work);
                "travel"
            }
            ObjectiveSpec::WayPerWork { standing_power, .. } => {
                let key = "optimisation.objective.way-per-work.standing_power";
                mistakes.not_negative(key, *standing_power);
                "way-per-work"
            }
        };
        if let Some(after) = optimisation.objective.after() {
            counted(mistakes, &format!("optimisation.objective.{kind}.after"), after);
        }
        let key = format!("optimisation.objective.{kind}.direction");
        mistakes.direction(&key, optimisation.objective.direction());
        if case.marker.is_empty() {
            let message = "the way of the markers is sought, and there are none".to_owned();
            mistakes.add("optimisation.objective", message, "add [[marker]]");
        }
        parameters(mistakes, "optimisation", &optimisation.parameter);
        settings(mistakes, "optimisation", &optimisation.search);
    }
    let at = |key: &str| format!("robot.set.{key}");
    for (key, value) in case.robot.iter().flat_map(|robot| &robot.set) {
        match ParameterKey::find(&case, key) {
            Ok(found) if found.len() == 1 => keeps_kind(mistakes, key, found[0], *value),
            Ok(_) => {
                let message = format!("`{key}` is a list");
                mistakes.add(&at(key), message, "give the key of one number in it");
            }
            Err(error) => mistakes.add(&at(key), error.message, &error.help),
        }
    }
    references(mistakes);
}

/// A time from which on a motion counts: frames have to be left, or there is no mean.
fn counted(mistakes: &mut Mistakes<'_>, key: &str, after: f64) {
    mistakes.not_negative(key, after);
    let soft = &mistakes.case().soft;
    let end = soft.frame * soft.frames as f64;
    let last = soft.frame * soft.frames.saturating_sub(FEWEST_FRAMES) as f64;
    if after > last + ROUNDING * soft.frame {
        let message = format!("`{key}` is {after}, and the motion ends at {end}");
        let help = format!(
            "write at most {last}, {FEWEST_FRAMES} frames before the end, better some periods of the fibres; or \
             more soft.frames"
        );
        mistakes.add(key, message, &help);
    }
}

fn settings(mistakes: &mut Mistakes<'_>, key: &str, search: &SearchSettings) {
    if search.evaluations == 0 {
        let at = format!("{key}.search.evaluations");
        mistakes.add(&at, format!("`{at}` is 0"), "write 1 or more");
    }
    mistakes.positive(&format!("{key}.search.decrease"), search.decrease);
    mistakes.positive(&format!("{key}.search.slope"), search.slope);
}

fn parameters(mistakes: &mut Mistakes<'_>, of: &str, parameters: &[Parameter]) {
    if parameters.is_empty() {
        let message = format!("[{of}] seeks nothing");
        mistakes.add(of, message, &format!("add [[{of}.parameter]]"));
    }
    let mut taken: Vec<ParameterKey> = Vec::new();
    for (index, parameter) in parameters.iter().enumerate() {
        let at = format!("{of}.parameter.{index}");
        if parameters[..index].iter().any(|other| other.name == parameter.name) {
            let message = format!("two parameters are called \"{}\"", parameter.name);
            mistakes.add(&format!("{at}.name"), message, "give each its own name");
        }
        if parameter.keys.is_empty() {
            let message = format!("\"{}\" has no keys", parameter.name);
            mistakes.add(&format!("{at}.keys"), message, "name the key of a number of the case");
        }
        let mut n_numbers = None;
        for (nth, key) in parameter.keys.iter().enumerate() {
            let here = format!("{at}.keys.{nth}");
            let found = match ParameterKey::find(mistakes.case(), key) {
                Ok(found) => found,
                Err(error) => {
                    mistakes.add(&here, error.message, &error.help);
                    continue;
                }
            };
            if *n_numbers.get_or_insert(found.len()) != found.len() {
                let message = format!("the keys of \"{}\" have different lengths", parameter.name);
                mistakes.add(&here, message, "name numbers, or lists of one length");
            }
            if found.iter().any(|one| taken.contains(one)) {
                let message = format!("`{key}` is sought twice");
                mistakes.add(&here, message, "take it out of one of the parameters");
            }
            for one in &found {
                limits(mistakes, &at, parameter, *one);
            }
            taken.extend(found);
        }
        bounds(mistakes, &at, parameter);
    }
}

/// Numbers that are not between their bounds, from where a search cannot start; a motion can be made with them.
pub fn check_starts(mistakes: &mut Mistakes<'_>) {
    let case = mistakes.case().clone();
    let calibrated = case.calibration.iter().map(|own| ("calibration", &own.parameter));
    let optimised = case.optimisation.iter().map(|own| ("optimisation", &own.parameter));
    for (of, parameters) in calibrated.chain(optimised) {
        for (index, parameter) in parameters.iter().enumerate() {
            starts(mistakes, &format!("{of}.parameter.{index}"), parameter);
        }
    }
}

/// Whether a parameter starts between its bounds, each entry of a list.
fn starts(mistakes: &mut Mistakes<'_>, at: &str, parameter: &Parameter) {
    let (name, [lower, upper]) = (&parameter.name, parameter.bounds);
    let case = mistakes.case().clone();
    let numbers = parameter.keys.first().and_then(|key| ParameterKey::find(&case, key).ok());
    for number in numbers.unwrap_or_default() {
        let Some(start) = parameter.start.or_else(|| number.read(&case)) else { continue };
        if !(lower <= start && start <= upper) {
            let message = format!(
                "\"{name}\" starts at {start}, which is not between its bounds {lower} and {upper}"
            );
            let (key, help) = match parameter.start {
                Some(_) => ("start", "move the start, or widen `bounds`"),
                None => ("bounds", "widen them, or add a `start` between them"),
            };
            return mistakes.add(&format!("{at}.{key}"), message, help);
        }
    }
}

/// Whether bounds can be those of a search.
fn bounds(mistakes: &mut Mistakes<'_>, at: &str, parameter: &Parameter) {
    let [lower, upper] = parameter.bounds;
    let key = format!("{at}.bounds");
    let name = &parameter.name;
    if lower > upper {
        let message = format!("the bounds of \"{name}\" are {lower} and {upper}");
        return mistakes.add(&key, message, "write the smaller number first");
    }
    match parameter.scale {
        Some(scale) => mistakes.positive(&format!("{at}.scale"), scale),
        None if lower <= 0.0 => {
            let message = format!("the lower bound of \"{name}\" is {lower}, and has no logarithm");
            mistakes.add(&key, message, "add `scale`, the size of a change that matters");
        }
        None => {}
    }
}

/// Whether pulses are some at both bounds of a number of them.
fn bounds_are(case: &SoftCase, parameter: &Parameter, key: ParameterKey) -> Option<bool> {
    let ParameterKey::Trapezoid(set, _) = key else { return None };
    let is_one = |bound: f64| {
        let mut case = case.clone();
        key.write(&mut case, bound);
        match &case.solid.first()?.fibre.get(set)?.stretch {
            Stretch::Trapezoid(pulse) => Some(pulse.is_one()),
            _ => None,
        }
    };
    let [lower, upper] = parameter.bounds;
    Some(is_one(lower)? && is_one(upper)?)
}

/// What a number may be at all.
fn limits(mistakes: &mut Mistakes<'_>, at: &str, parameter: &Parameter, key: ParameterKey) {
    let [lower, upper] = parameter.bounds;
    let wrong = match key {
        ParameterKey::Young(_)
        | ParameterKey::FibreStiffness(_)
        | ParameterKey::Constant(_)
        | ParameterKey::Frame(..)
        | ParameterKey::Wave(_, 2)
            if lower <= 0.0 =>
        {
            Some("write a lower bound above 0: this number cannot be 0 or below")
        }
        ParameterKey::Trapezoid(..)
            if bounds_are(mistakes.case(), parameter, key) == Some(false) =>
        {
            Some(
                "pulses have 0 <= amplitude < 1 and 0 < rise <= on <= 1 - rise, at the bounds, too",
            )
        }
        ParameterKey::Poisson(_) if lower <= -1.0 || upper >= 0.5 => {
            Some("Poisson's ratio is sought above -1 and below 0.5: write bounds between them")
        }
        ParameterKey::Poisson(_) if key.read(mistakes.case()) == Some(0.5) => Some(
            "where the case has 0.5 the volume is kept: write a smaller ratio, or seek another number",
        ),
        _ => None,
    };
    if let Some(help) = wrong {
        let message = format!("the bounds of \"{}\" are {lower} and {upper}", parameter.name);
        mistakes.add(&format!("{at}.bounds"), message, help);
    }
}

/// A ratio of the robot may be 0.5 where that of the model is, and nowhere else: the one has pressures.
fn keeps_kind(mistakes: &mut Mistakes<'_>, name: &str, key: ParameterKey, value: f64) {
    let own = key.read(mistakes.case());
    if matches!(key, ParameterKey::Poisson(_)) && (own == Some(0.5)) != (value == 0.5) {
        let message =
            format!("the robot has a Poisson's ratio of {value}, where the model has another kind");
        let help = "write 0.5, which keeps the volume, for both or for none";
        mistakes.add(&format!("robot.set.{name}"), message, help);
    }
}

fn references(mistakes: &mut Mistakes<'_>) {
    let case = mistakes.case().clone();
    for (index, reference) in case.reference.iter().enumerate() {
        let at = format!("reference.{index}");
        if reference.relative.is_some() == reference.absolute.is_some() {
            let message =
                format!("the reference for `{}` has no single tolerance", reference.quantity);
            mistakes.add(&at, message, "write one of `relative` and `absolute`");
        }
        let absent = match reference.of {
            ReferenceOf::Calibration if case.calibration.is_none() => Some("calibration"),
            ReferenceOf::Optimisation if case.optimisation.is_none() => Some("optimisation"),
            _ => None,
        };
        if let Some(absent) = absent {
            let message = format!("a reference is of a {absent}, and the case has none");
            mistakes.add(&format!("{at}.of"), message, &format!("add [{absent}]"));
        }
    }
}
