//! Problems of the numbers that a search changes: their keys, expressions, bounds and starts.

use super::constant::check_constant;
use crate::read::CaseFile;
use crate::read::WrittenNumber;
use crate::read::sought::{MOVED_TABLES, SOLVED_TABLES, SoughtNumber};
use crate::rules::Findings;
use crate::spec::formula::mistake_in_name;
use crate::text::diagnostic::CaseError;
use crate::text::nearest::nearest;
use crate::{Case, FlowOptimisation, FlowParameter};

/// Part of a number by which it is changed to see whether it can be.
const CHANGE: f64 = 1e-4;

pub fn check(findings: &mut Findings<'_>, file: &CaseFile, spec: &FlowOptimisation) {
    if spec.parameter.is_empty() {
        let help = "add [[optimisation.parameter]] with name, keys and bounds";
        findings.error("optimisation.parameter", "the search changes nothing".to_owned(), help);
    }
    let mut taken: Vec<String> = Vec::new();
    for (index, parameter) in spec.parameter.iter().enumerate() {
        let at = format!("optimisation.parameter.{index}");
        if spec.parameter[..index].iter().any(|other| other.name == parameter.name) {
            let message = format!("two parameters are called \"{}\"", parameter.name);
            findings.error(&format!("{at}.name"), message, "give each its own name");
        }
        check_keys(findings, file, &at, parameter, &mut taken);
        check_values(findings, &at, parameter, spec);
    }
    let sought = file.sought();
    for (index, number) in sought.iter().enumerate() {
        // One parameter a list has the same bounds for all entries
        let is_first = sought[..index].iter().all(|other| other.at != number.at);
        check_bounds(findings, number, is_first);
    }
}

/// Whether keys lead to numbers that can change, each sought once.
fn check_keys(
    findings: &mut Findings<'_>,
    file: &CaseFile,
    at: &str,
    parameter: &FlowParameter,
    taken: &mut Vec<String>,
) {
    let mut n_numbers = None;
    for (nth, key) in parameter.keys.iter().enumerate() {
        let here = format!("{at}.keys.{nth}");
        let found = file.numbers_at(key);
        if found.is_empty() {
            report_unknown(findings, file, &here, key);
            continue;
        }
        let tables = tables(findings.case());
        if !is_solved(key, tables) {
            let help = if findings.case().is_searched_reduced() {
                "searches by the reduced model change numbers of gaits in [[swimmer]], of [[joint]] and [reduced], and \
                 of [time]"
            } else {
                "searches change numbers of [fluid], [boundary], [[body]], [[swimmer]], [[joint]], [field] and \
                 [scales]; sides of the domain stay where they are"
            };
            let message = format!("`{key}` is no number of what is solved, and has no derivative");
            findings.error(&here, message, help);
            continue;
        }
        if *n_numbers.get_or_insert(found.len()) != found.len() {
            let message = format!("the keys of \"{}\" have different lengths", parameter.name);
            findings.error(&here, message, "name numbers, or lists of one length");
        }
        if let Some(twice) = found.iter().find(|one| taken.contains(one)) {
            let message = format!("`{twice}` is sought twice");
            findings.error(&here, message, "take it out of one of the parameters");
        }
        for one in &found {
            check_changes(findings, file, &here, one);
        }
        taken.extend(found);
    }
}

/// Reports a key that leads to no number, with what would be right.
fn report_unknown(findings: &mut Findings<'_>, file: &CaseFile, here: &str, key: &str) {
    let (known, tables) = (file.number_keys(), tables(findings.case()));
    let known: Vec<&str> =
        known.iter().map(String::as_str).filter(|key| is_solved(key, tables)).collect();
    let meant = nearest(key, &known).map(|key| format!("did you mean `{key}`? "));
    let message = format!("`{key}` is no number that is written in the case");
    let help = format!(
        "{}write the number into the case, or take one that is there: {}",
        meant.unwrap_or_default(),
        known.join(", ")
    );
    findings.error(here, message, &help);
}

/// Whether a key is that of a number of what is solved.
fn is_solved(key: &str, tables: &[&str]) -> bool {
    tables.contains(&key.split('.').next().unwrap_or_default()) && !key.ends_with(".size")
}

/// Tables with numbers that a search of a case may change.
fn tables(case: &Case) -> &'static [&'static str] {
    if case.is_searched_reduced() { &MOVED_TABLES } else { &SOLVED_TABLES }
}

/// Whether a number can be another one: of what is counted there are no derivatives.
fn check_changes(findings: &mut Findings<'_>, file: &CaseFile, here: &str, key: &str) {
    let own = file.number(key).unwrap_or(0.0);
    let value = own + CHANGE * if own == 0.0 { 1.0 } else { own.abs() };
    let changed = file.with_numbers(&[WrittenNumber { path: key.to_owned(), value }]);
    let Err(error) = changed else { return };
    let why = match &error {
        CaseError::Wrong(all) => all.first().map(|one| one.message.clone()),
        _ => None,
    };
    findings.error(
        here,
        format!("`{key}` has no derivative: {}", why.unwrap_or_else(|| error.to_string())),
        "take a number that can be a little larger or smaller",
    );
}

/// Whether what keys are is understood.
fn check_values(
    findings: &mut Findings<'_>,
    at: &str,
    parameter: &FlowParameter,
    spec: &FlowOptimisation,
) {
    let FlowParameter { name, keys, values, start, .. } = parameter;
    if values.is_empty() {
        return;
    }
    if values.len() != keys.len() {
        findings.error(
            &format!("{at}.values"),
            format!("\"{name}\" has {} keys and {} values", keys.len(), values.len()),
            "write an expression for each key, in the order of the keys",
        );
    }
    if start.is_none() {
        let message = format!("nothing says where \"{name}\" starts: its keys follow from it");
        findings.error(at, message, "add start = ...");
    }
    let mut known = findings.case().define.clone();
    let taken = known.contains_key(name).then(|| "a number of [define] has this name".to_owned());
    if let Some(mistake) = mistake_in_name(name).or(taken) {
        let message = format!("a parameter cannot be called \"{name}\" in an expression");
        findings.error(&format!("{at}.name"), message, &mistake);
    }
    known.extend(spec.parameter.iter().map(|other| (other.name.clone(), 1.0)));
    for (nth, text) in values.iter().enumerate() {
        check_constant(findings, &format!("{at}.values.{nth}"), text, &known);
    }
}

/// Bounds and start of a number.
fn check_bounds(findings: &mut Findings<'_>, number: &SoughtNumber, is_first: bool) {
    let SoughtNumber { name, at, bounds: [lower, upper], scale, .. } = number;
    let key = format!("{at}.bounds");
    if is_first && lower > upper {
        let message = format!("the bounds of \"{name}\" are {lower} and {upper}");
        findings.error(&key, message, "write the smaller number first");
        return;
    }
    if is_first && scale.is_none() && *lower <= 0.0 {
        let message = format!("the lower bound of \"{name}\" is {lower}, and has no logarithm");
        findings.error(&key, message, "add `scale`, the size of a change that matters");
    }
}

/// Numbers that are not between their bounds, from where a search cannot start; a run can be made with them.
pub fn check_starts(findings: &mut Findings<'_>, file: &CaseFile) {
    for SoughtNumber { name, at, start, bounds: [lower, upper], .. } in file.sought() {
        if lower <= upper && (start < lower || start > upper) {
            findings.error(
                &format!("{at}.bounds"),
                format!(
                    "\"{name}\" starts at {start}, which is not between its bounds {lower} and {upper}"
                ),
                "widen them, or add a `start` between them",
            );
        }
    }
}
