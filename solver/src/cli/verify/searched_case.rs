//! The case that a search has written: whether its numbers are those that were found.

use alewife_reduced::tier::Sought;

use super::found::Found;
use super::run::first_line;
use crate::case::soft::SoftFile;
use crate::case::soft::search::Parameter;
use crate::case::{Case, CaseFile, numbers_at};
use crate::cli::searched::SearchDirectory;

/// The file.
const FILE: &str = "case.toml";

/// Relative difference of a number that was written as decimals and read again.
const ROUNDING: f64 = 1e-14;

/// Looks at the case that a search has written; also it, where it is one of a flow.
pub fn check(search: &SearchDirectory, found: &mut Found) -> Option<CaseFile> {
    let path = search.path.join(FILE).display().to_string();
    let soft = SoftFile::read_if_soft(&path, &[]);
    let soft = found.read(FILE, soft.map_err(|error| first_line(&error.to_string())))?;
    if let Some(file) = soft {
        check_soft(&file, search, found);
        return None;
    }
    let file = Case::read(&path, &[]).map_err(|error| first_line(&error.to_string()));
    let file = found.read(FILE, file)?;
    check_flow(&file, search, found);
    Some(file)
}

/// Whether a number is another one, as decimals are written and read.
pub fn is_same(told: f64, value: f64) -> bool {
    (told - value).abs() <= ROUNDING * value.abs()
}

/// What the latest search of a kind has found.
fn best<'a>(search: &'a SearchDirectory, kind: &str) -> Option<&'a [f64]> {
    let begins = format!("alewife {kind}");
    let of_kind = |one: &&crate::cli::searched::Named| one.journal.search.starts_with(&begins);
    let last = search.journals.iter().rev().find(of_kind)?;
    Some(last.journal.best()?.values.as_slice())
}

/// The keys that follow from what was sought have the numbers that follow.
fn check_flow(file: &CaseFile, search: &SearchDirectory, found: &mut Found) {
    let Some(best) = best(search, "optimisation") else { return };
    let sought = file.sought();
    if sought.len() != best.len() {
        let (n, known) = (sought.len(), best.len());
        found.wrong(FILE, format!("it seeks {n} numbers, and the journals have {known}"));
        return;
    }
    let numbers = numbers_at(&sought, &file.case().define, best);
    let numbers = numbers.map_err(|error| first_line(&error.to_string()));
    for wanted in found.read(FILE, numbers).into_iter().flatten() {
        if let Some(told) = file.number(&wanted.path).filter(|told| !is_same(*told, wanted.value)) {
            differs(found, &wanted.path, told, wanted.value);
        }
    }
}

/// The same of a soft case; of a loop what was calibrated last counts.
fn check_soft(file: &SoftFile, search: &SearchDirectory, found: &mut Found) {
    let case = &file.case;
    let of = |parameters: &[Parameter]| Sought::new(case, parameters);
    let calibrated = case.calibration.as_ref().map(|own| of(&own.parameter));
    let optimised = case.optimisation.as_ref().map(|own| of(&own.parameter));
    let mut known = Vec::new();
    for (kind, sought) in [("calibration", calibrated), ("optimisation", optimised)] {
        let (Some(best), Some(sought)) = (best(search, kind), sought) else { continue };
        for ((one, keys), value) in sought.bounded.iter().zip(&sought.keys).zip(best) {
            for key in keys.iter().filter(|key| !known.contains(*key)) {
                if let Some(told) = key.read(case).filter(|told| !is_same(*told, *value)) {
                    differs(found, &one.name, told, *value);
                }
            }
        }
        known.extend(sought.keys.into_iter().flatten());
    }
}

fn differs(found: &mut Found, what: &str, told: f64, value: f64) {
    found.wrong(FILE, format!("`{what}` is {told}, and that of the best evaluation is {value}"));
}
