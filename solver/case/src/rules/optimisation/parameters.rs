//! Problems of the numbers that a search changes: their keys, expressions, bounds and starts.

use super::constant::check_constant;
use crate::read::CaseFile;
use crate::read::WrittenNumber;
use crate::read::sought::{MOVED_TABLES, SOLVED_TABLES, SoughtNumber, TRACKED_TABLES};
use crate::rules::Findings;
use crate::spec::formula::mistake_in_name;
use crate::text::diagnostic::CaseError;
use crate::text::nearest::nearest;
use crate::{Case, FlowParameter};

/// Part of a number by which it is changed to see whether it can be.
const CHANGE: f64 = 1e-4;

/// Which numbers a search may change.
struct Changeable {
    /// The search.
    table: &'static str,
    /// Tables with such numbers.
    tables: &'static [&'static str],
    /// What is refused of others.
    refused: &'static str,
    /// Which they are.
    help: &'static str,
}

impl Changeable {
    /// By `optimise`.
    fn by_gradient(case: &Case) -> Self {
        let refused = "is no number of what is solved, and has no derivative";
        if case.is_searched_reduced() {
            let help = "searches by the reduced model change numbers of gaits in [[swimmer]], of [[joint]] and [reduced], \
                        and of [time]";
            return Self { table: "optimisation", tables: &MOVED_TABLES, refused, help };
        }
        let help = "searches change numbers of [fluid], [boundary], [[body]], [[swimmer]], [[joint]], [field] and \
                    [scales]; sides of the domain stay where they are";
        Self { table: "optimisation", tables: &SOLVED_TABLES, refused, help }
    }

    /// By `calibrate`.
    fn by_tracks() -> Self {
        Self {
            table: "calibration",
            tables: &TRACKED_TABLES,
            refused: "is no number that a fit changes",
            help: "take numbers of [fluid], [[body]], [[swimmer]], [[joint]] and [reduced]; coefficients of the law are \
                   named in calibration.fit",
        }
    }

    /// Whether a key is that of such a number.
    fn has(&self, key: &str) -> bool {
        let is_coefficient = self.table == "calibration"
            && (key.starts_with("reduced.coefficients.") || key.starts_with("reduced.body."));
        let table = key.split('.').next().unwrap_or_default();
        self.tables.contains(&table) && !key.ends_with(".size") && !is_coefficient
    }
}

/// Those of `[optimisation]`.
pub fn check(findings: &mut Findings<'_>, file: &CaseFile, parameters: &[FlowParameter]) {
    if parameters.is_empty() {
        let help = "add [[optimisation.parameter]] with name, keys and bounds";
        findings.error("optimisation.parameter", "the search changes nothing".to_owned(), help);
    }
    let changeable = Changeable::by_gradient(findings.case());
    check_all(findings, file, parameters, &changeable);
    check_bounds(findings, &file.sought(), true);
}

/// Those of `[calibration]`.
pub fn check_fitted(findings: &mut Findings<'_>, file: &CaseFile, parameters: &[FlowParameter]) {
    check_all(findings, file, parameters, &Changeable::by_tracks());
    check_bounds(findings, &file.fitted_numbers(), false);
}

fn check_all(
    findings: &mut Findings<'_>,
    file: &CaseFile,
    parameters: &[FlowParameter],
    changeable: &Changeable,
) {
    let mut taken: Vec<String> = Vec::new();
    for (index, parameter) in parameters.iter().enumerate() {
        let at = format!("{}.parameter.{index}", changeable.table);
        if parameters[..index].iter().any(|other| other.name == parameter.name) {
            let message = format!("two parameters are called \"{}\"", parameter.name);
            findings.error(&format!("{at}.name"), message, "give each its own name");
        }
        let mut keys = Keys { file, at: &at, changeable, taken: &mut taken };
        keys.check(findings, parameter);
        check_values(findings, &at, parameter, parameters);
    }
}

/// The keys of a parameter.
struct Keys<'a> {
    file: &'a CaseFile,
    at: &'a str,
    changeable: &'a Changeable,
    /// Numbers that are sought by others.
    taken: &'a mut Vec<String>,
}

impl Keys<'_> {
    /// Whether keys lead to numbers that can change, each sought once.
    fn check(&mut self, findings: &mut Findings<'_>, parameter: &FlowParameter) {
        let Self { file, at, changeable, taken } = self;
        let mut n_numbers = None;
        for (nth, key) in parameter.keys.iter().enumerate() {
            let here = format!("{at}.keys.{nth}");
            let found = file.numbers_at(key);
            if found.is_empty() {
                report_unknown(findings, file, &here, key, changeable);
                continue;
            }
            if !changeable.has(key) {
                let message = format!("`{key}` {}", changeable.refused);
                findings.error(&here, message, changeable.help);
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
}

/// Reports a key that leads to no number, with what would be right.
fn report_unknown(
    findings: &mut Findings<'_>,
    file: &CaseFile,
    here: &str,
    key: &str,
    changeable: &Changeable,
) {
    let known = file.number_keys();
    let known: Vec<&str> =
        known.iter().map(String::as_str).filter(|key| changeable.has(key)).collect();
    let meant = nearest(key, &known).map(|key| format!("did you mean `{key}`? "));
    let message = format!("`{key}` is no number that is written in the case");
    let help = format!(
        "{}write the number into the case, or take one that is there: {}",
        meant.unwrap_or_default(),
        known.join(", ")
    );
    findings.error(here, message, &help);
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
    all: &[FlowParameter],
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
    known.extend(all.iter().map(|other| (other.name.clone(), 1.0)));
    for (nth, text) in values.iter().enumerate() {
        check_constant(findings, &format!("{at}.values.{nth}"), text, &known);
    }
}

/// Bounds of numbers; one parameter a list has the same for all entries.
fn check_bounds(findings: &mut Findings<'_>, sought: &[SoughtNumber], has_logarithm: bool) {
    for (index, number) in sought.iter().enumerate() {
        let SoughtNumber { name, at, bounds: [lower, upper], scale, .. } = number;
        if sought[..index].iter().any(|other| other.at == *at) {
            continue;
        }
        let key = format!("{at}.bounds");
        if !(lower.is_finite() && upper.is_finite() && lower <= upper) {
            let message = format!("the bounds of \"{name}\" are {lower} and {upper}");
            findings.error(&key, message, "write the smaller number first");
        } else if has_logarithm && scale.is_none() && *lower <= 0.0 {
            let message = format!("the lower bound of \"{name}\" is {lower}, and has no logarithm");
            findings.error(&key, message, "add `scale`, the size of a change that matters");
        }
    }
}

/// Numbers that are not between their bounds, from where a search cannot start; a run can be made with them.
pub fn check_starts(findings: &mut Findings<'_>, sought: &[SoughtNumber]) {
    for SoughtNumber { name, at, start, bounds: [lower, upper], .. } in sought {
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
