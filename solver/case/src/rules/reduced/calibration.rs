//! Problems of `[calibration]`, and of a calibrated file in a case it was not found for.

use super::is_a_body;
use crate::read::CaseFile;
use crate::rules::optimisation::check_fitted;
use crate::rules::{Findings, OneOf};
use crate::text::nearest::nearest;
use crate::{
    CalibratedSpec, CalibrationSpec, FitBy, FitName, Geometry, Proposer, RecordSpec, TimeSettings,
};

/// What a record may have of a body.
const TRACKS: [&str; 4] = ["x", "y", "z", "angle"];

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    if let Some(spec) = &findings.case().calibration {
        coefficients(findings, spec);
        numbers(findings, file, spec);
        for (index, name) in spec.tracks.iter().enumerate() {
            track(findings, &format!("calibration.tracks.{index}"), name);
        }
        records(findings, spec);
        differences(findings, spec);
        search(findings, spec);
    }
    let reduced = findings.case().reduced.as_ref();
    if let Some(calibrated) = reduced.and_then(|reduced| reduced.calibrated.as_ref()) {
        origin(findings, calibrated);
    }
}

/// What is found has a name, a start and bounds about it.
fn coefficients(findings: &mut Findings<'_>, spec: &CalibrationSpec) {
    let reduced = findings.case().reduced_model();
    let known: Vec<&str> = reduced.loads.coefficients().iter().map(|one| one.name).collect();
    let law = reduced.loads.name();
    if spec.fit.is_empty() && spec.parameter.is_empty() {
        let help = format!("coefficients of \"{law}\": {}", known.join(", "));
        findings.error("calibration.fit", "nothing is to be found".to_owned(), &help);
    }
    for (index, name) in spec.fit.iter().enumerate() {
        let key = format!("calibration.fit.{index}");
        let FitName { body, coefficient } = FitName::new(name);
        if let Some(body) = body {
            is_a_body(findings, &key, body);
        }
        if !known.contains(&coefficient) {
            let close = nearest(coefficient, &known)
                .map_or(String::new(), |near| format!("; did you mean {near}?"));
            let help = format!("coefficients: {}{close}", known.join(", "));
            let message = format!("the law \"{law}\" has no coefficient \"{coefficient}\"");
            findings.error(&key, message, &help);
            continue;
        }
        if spec.fit[..index].contains(name) {
            findings.error(&key, format!("\"{name}\" is found twice"), "leave one out");
        }
        let [lower, upper] = spec.bounds_of(name);
        if !(lower.is_finite() && upper.is_finite() && 0.0 <= lower && lower < upper) {
            let key = format!("calibration.bounds.{name}");
            let message = format!("the bounds of \"{name}\" are {lower} and {upper}");
            findings.error(&key, message, "write [smallest, largest], 0 or above");
        }
    }
    for name in spec.bounds.keys().filter(|name| !spec.fit.contains(*name)) {
        let message = format!("\"{name}\" has bounds, and is not found");
        let help = "add it to calibration.fit, or leave them out";
        findings.error(&format!("calibration.bounds.{name}"), message, help);
    }
    if !matches!(findings.case().time, TimeSettings::Unsteady(_)) {
        let message = "a steady flow has no motion to be fitted to".to_owned();
        findings.error("time.steady", message, "write [time.unsteady]");
    }
}

/// Numbers of the case are found by tracks of CSV files, and without exact derivatives.
fn numbers(findings: &mut Findings<'_>, file: &CaseFile, spec: &CalibrationSpec) {
    if spec.parameter.is_empty() {
        return;
    }
    check_fitted(findings, file, &spec.parameter);
    let key = "calibration.parameter";
    if spec.fits() != FitBy::Tracks {
        let message = "numbers of the case are fitted to tracks".to_owned();
        findings.error(key, message, "write by = \"tracks\" and CSV files, or leave them out");
    } else if spec.search.is_none() && spec.differences.is_none() {
        let message = "exact derivatives are those by coefficients alone".to_owned();
        let help = "write differences = 0.02, or [calibration.search]";
        findings.error(key, message, help);
    }
    for (index, parameter) in spec.parameter.iter().enumerate() {
        if spec.fit.contains(&parameter.name) {
            let message = format!("\"{}\" is a coefficient in calibration.fit", parameter.name);
            findings.error(&format!("{key}.{index}.name"), message, "give it another name");
        }
    }
    for (index, _) in spec.from.iter().enumerate().filter(|(_, from)| from.run.is_some()) {
        let message = "the case of a run has its own numbers".to_owned();
        let help = "name its series.csv as `csv`, with time = \"time\" and `columns`";
        findings.error(&format!("calibration.from.{index}.run"), message, help);
    }
}

/// Coefficients that are not between their bounds, from where a calibration cannot start; a run can be made with them.
pub fn check_starts(findings: &mut Findings<'_>) {
    let Some(spec) = &findings.case().calibration else { return };
    let reduced = findings.case().reduced_model();
    let known = reduced.loads.coefficients();
    for name in &spec.fit {
        let FitName { body, coefficient } = FitName::new(name);
        let own = reduced.coefficients_of(body.unwrap_or_default());
        let nth = known.iter().position(|one| one.name == coefficient);
        let start = nth.and_then(|nth| own.get(nth)).copied().unwrap_or_default();
        let [lower, upper] = spec.bounds_of(name);
        if !(lower..=upper).contains(&start) {
            findings.error(
                &format!("calibration.bounds.{name}"),
                format!("\"{name}\" starts at {start}, which is not between {lower} and {upper}"),
                &match body {
                    Some(body) => {
                        format!("widen them, or write another reduced.body.{body}.{coefficient}")
                    }
                    None => format!("widen them, or write another reduced.coefficients.{name}"),
                },
            );
        }
    }
}

/// Differences are of tracks, and small.
fn differences(findings: &mut Findings<'_>, spec: &CalibrationSpec) {
    let Some(part) = spec.differences else { return };
    let key = "calibration.differences";
    if spec.fits() != FitBy::Tracks {
        let message = "loads are fitted with their exact derivatives".to_owned();
        findings.error(key, message, "leave it out, or write by = \"tracks\"");
    } else if !(part > 0.0 && part < 1.0) {
        let message = format!("differences over a part of {part} of a coefficient");
        findings.error(key, message, "a number between 0 and 1, such as 0.02");
    }
}

/// Most motions of a search.
const MOST_EVALUATIONS: usize = 10_000_000;

/// Most halvings of the way to a proposal: a millionth of it is left.
const MOST_HALVINGS: u8 = 20;

/// A search has bounds of all that it finds, and what its proposer takes.
fn search(findings: &mut Findings<'_>, spec: &CalibrationSpec) {
    let Some(search) = &spec.search else { return };
    let key = |name: &str| format!("calibration.search.{name}");
    let proposer = search.proposer.name();
    if !(1..=MOST_EVALUATIONS).contains(&search.evaluations) {
        let message = format!("{} motions are asked for", search.evaluations);
        let help = format!("a number from 1 to {MOST_EVALUATIONS}");
        findings.error(&key("evaluations"), message, &help);
    }
    if search.halvings.is_some_and(|halvings| halvings > MOST_HALVINGS) {
        let message = format!("{} halvings are asked for", search.halvings.unwrap_or_default());
        let help = format!("a number from 0 to {MOST_HALVINGS}");
        findings.error(&key("halvings"), message, &help);
    }
    for name in spec.fit.iter().filter(|name| !spec.bounds.contains_key(*name)) {
        let message = format!("a search proposes points between bounds, and \"{name}\" has none");
        let help = format!("write calibration.bounds.{name} = [smallest, largest]");
        findings.error(&key("proposer"), message, &help);
    }
    let is_drawn = matches!(search.proposer, Proposer::Random | Proposer::CmaEs);
    if search.seed.is_some() && !is_drawn {
        let message = format!("the proposer \"{proposer}\" draws no numbers");
        findings.error(&key("seed"), message, "leave it out, or take \"random\" or \"cma-es\"");
    }
    match (search.proposer, search.command.first()) {
        (Proposer::External, None) => findings.error(
            &key("proposer"),
            "the proposer \"external\" is a program, and none is named".to_owned(),
            "write command = [\"PROGRAM\", \"ARGUMENT\", ...]",
        ),
        (Proposer::External, Some(program)) if program.trim().is_empty() => {
            let message = "the name of the program is empty".to_owned();
            findings.error(&key("command"), message, "write command = [\"PROGRAM\", ...]");
        }
        (Proposer::External, Some(_)) | (_, None) => {}
        (_, Some(_)) => {
            let message = format!("the proposer \"{proposer}\" is no program");
            let help = "leave it out, or write proposer = \"external\"";
            findings.error(&key("command"), message, help);
        }
    }
}

/// A track is of a body.
fn track(findings: &mut Findings<'_>, key: &str, name: &str) {
    let Some((body, what)) = name.rsplit_once('.').filter(|(_, what)| TRACKS.contains(what)) else {
        let message = format!("\"{name}\" is no track");
        return findings.error(key, message, "NAME.x, NAME.y, NAME.z or NAME.angle of a body");
    };
    let known: &[&str] = match findings.case().geometry {
        Geometry::Planar => &["x", "y", "angle"],
        Geometry::Axisymmetric => &["x"],
        Geometry::Spatial => &["x", "y", "z"],
    };
    if !known.contains(&what) {
        let message = format!("a body has no track \"{what}\" in this geometry");
        let help = "x, y and angle in the plane, x on the axis, x, y and z in space";
        return findings.error(key, message, help);
    }
    is_a_body(findings, key, body);
}

fn records(findings: &mut Findings<'_>, spec: &CalibrationSpec) {
    if !spec.from.iter().any(|one| !one.holdout) {
        let message = "there is nothing to be fitted to".to_owned();
        findings.error("calibration.from", message, "add [[calibration.from]] without `holdout`");
    }
    for (index, record) in spec.from.iter().enumerate() {
        let key = format!("calibration.from.{index}");
        match (&record.run, &record.csv) {
            (Some(_), None) => of_run(findings, &key, record),
            (None, Some(_)) => {
                if spec.fits() != FitBy::Tracks && !record.holdout {
                    let message = "a CSV file has no loads to be fitted to".to_owned();
                    findings.error(&format!("{key}.csv"), message, "write by = \"tracks\"");
                }
                of_file(findings, &key, record);
            }
            _ => findings.error(
                &key,
                "it is from a run or from a CSV file".to_owned(),
                "write one of `run` and `csv`",
            ),
        }
    }
}

/// What a run says itself is not said again.
fn of_run(findings: &mut Findings<'_>, key: &str, record: &RecordSpec) {
    let has_pieces = findings.case().reduced.as_ref().is_some_and(|own| !own.ellipsoid.is_empty());
    if has_pieces {
        let message = "a run has the loads on whole bodies, and the case has those on ellipsoids";
        let help = "leave out reduced.ellipsoid, or take CSV files";
        findings.error(&format!("{key}.run"), message.to_owned(), help);
    }
    let said = [
        ("time", record.time.is_some()),
        ("rate", record.rate.is_some()),
        ("start", record.start.is_some()),
        ("columns", !record.columns.is_empty()),
        ("units", !record.units.is_empty()),
        ("frame", record.frame.is_some()),
        ("set", !record.set.is_empty()),
    ];
    for (name, _) in said.into_iter().filter(|(_, is_said)| *is_said) {
        let message = format!("`{name}` is of CSV files: a run says itself how it was made");
        findings.error(&format!("{key}.{name}"), message, "leave it out");
    }
}

fn of_file(findings: &mut Findings<'_>, key: &str, record: &RecordSpec) {
    let of = OneOf {
        what: "a record",
        names: ["time", "rate"],
        given: [record.time.is_some(), record.rate.is_some()],
        help: "time = \"COLUMN\" has its times, rate = ... is how many rows there are in a second",
    };
    findings.one_of(key, &of);
    if record.start.is_some_and(|start| !(start.is_finite() && start > 0.0)) {
        let message = "the start is not above 0".to_owned();
        findings.error(&format!("{key}.start"), message, "write a time of the model (s)");
    }
    if record.columns.is_empty() {
        let message = "no column says where a body is".to_owned();
        let help = "write columns = { \"NAME.x\" = \"COLUMN\", ... }";
        findings.error(&format!("{key}.columns"), message, help);
    }
    for name in record.columns.keys() {
        track(findings, &format!("{key}.columns.{name}"), name);
    }
    for (name, unit) in &record.units {
        let at = format!("{key}.units.{name}");
        if !record.columns.contains_key(name) {
            let message = format!("\"{name}\" has a unit and no column");
            findings.error(&at, message, "add it to `columns`, or leave it out");
        } else if !(unit.is_finite() && *unit != 0.0) {
            findings.error(&at, format!("the unit is {unit}"), "a number that is not 0");
        }
    }
    if record.frame.is_some() && findings.case().geometry == Geometry::Spatial {
        let message = "a frame is of planar records".to_owned();
        findings.error(&format!("{key}.frame"), message, "leave it out");
    }
}

/// A calibrated file is of this swimmer; a gait outside its range is warned about.
fn origin(findings: &mut Findings<'_>, calibrated: &CalibratedSpec) {
    let model = findings.model();
    let bodies: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    if calibrated.bodies != bodies {
        findings.error(
            "reduced.calibrated.file",
            format!(
                "{} was found for the bodies {}, and the case has {}",
                calibrated.file,
                calibrated.bodies.join(", "),
                bodies.join(", ")
            ),
            "calibrate this case, or write the coefficients themselves into [reduced]",
        );
        return;
    }
    let strokes = model.joints.iter().filter_map(|joint| joint.kind.stroke());
    let (mut periods, mut amplitudes) = (Vec::new(), Vec::new());
    for stroke in strokes {
        periods.extend(stroke.period());
        let [least, most] = stroke.range();
        amplitudes.push(0.5 * (most - least));
    }
    let viscosity = findings.case().reference_viscosity() / findings.case().fluid.density;
    let compared = [
        ("period", calibrated.periods, periods),
        ("amplitude", calibrated.amplitudes, amplitudes),
        ("kinematic viscosity", calibrated.viscosities, vec![viscosity]),
    ];
    for (what, range, values) in compared {
        let Some([least, most]) = range else { continue };
        let (lower, upper) = (least * (1.0 - 1e-9), most * (1.0 + 1e-9));
        if let Some(value) = values.iter().find(|one| !(lower..=upper).contains(*one)) {
            findings.warning(
                "reduced.calibrated.file",
                format!(
                    "{} was fitted at a {what} of {least} to {most}, and the case has {value}",
                    calibrated.file
                ),
                "compare with a run of the full solver, or calibrate with runs about it",
            );
        }
    }
}
