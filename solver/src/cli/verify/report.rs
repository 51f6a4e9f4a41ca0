//! The report and the table of a finished search, beside its journals.

use std::fs;

use alewife_reduced::tier::checksum_of_case;
use serde_json::Value;

use super::found::Found;
use super::searched_case;
use super::searched_case::is_same;
use super::table::found_rows;
use crate::case::CaseFile;
use crate::cli::searched::{Kind, Named, SearchDirectory};
use crate::optimise::Objective;

const FILE: &str = "report.json";
const TABLE: &str = "evaluations.csv";

/// A report has all evaluations, the best of the last journal, and the objectives that follow from its quantities.
pub fn check(search: &SearchDirectory, found: &mut Found) {
    let case = searched_case::check(search, found);
    let read = fs::read(search.path.join(FILE)).map_err(|error| error.to_string());
    let read = read
        .and_then(|text| serde_json::from_slice::<Value>(&text).map_err(|error| error.to_string()));
    if let Some(report) = found.read(FILE, read) {
        let n = search.n_evaluations();
        if report["evaluations"].as_u64() != Some(n as u64) {
            let told = &report["evaluations"];
            found.wrong(FILE, format!("it has {told} evaluations, and the journals have {n}"));
        }
        check_parameters(search, &report, found);
        if list(&report, "constraints").is_empty() {
            check_objectives(search, &report, found);
        }
        if let Some(case) = &case {
            check_quantities(case, &report, found);
        }
        check_compared(&report, found);
        check_searched(search, &report, found);
        let told = report["case"].as_str();
        if told.is_some_and(|told| checksum_of_case(&search.path).is_ok_and(|own| own != told)) {
            found.wrong("case.toml", "it is not as the search has written it");
        }
    }
    check_table(search, found);
}

fn list<'a>(report: &'a Value, key: &str) -> &'a [Value] {
    report[key].as_array().map(Vec::as_slice).unwrap_or_default()
}

/// Whether a report has another number than is known.
fn differs(told: &Value, value: f64) -> bool {
    !told.as_f64().is_some_and(|told| is_same(told, value))
}

fn check_parameters(search: &SearchDirectory, report: &Value, found: &mut Found) {
    let best = search.journals.last().and_then(|last| last.journal.best());
    let parameters = list(report, "parameters");
    for (nth, value) in best.into_iter().flat_map(|best| &best.values).enumerate() {
        if parameters.get(nth).is_none_or(|told| differs(&told["value"], *value)) {
            let name = parameters.get(nth).and_then(|one| one["name"].as_str()).unwrap_or("?");
            found.wrong(FILE, format!("`{name}` is not that of the best evaluation, {value}"));
        }
    }
}

/// Where nothing is held, journals have the objective itself.
fn check_objectives(search: &SearchDirectory, report: &Value, found: &mut Found) {
    let sign = search.sign();
    let first = search.journals.first().and_then(|one| one.journal.known.first());
    let best = search.journals.last().and_then(|one| one.journal.best());
    for (key, of, one) in [("objective", "best", best), ("start", "first", first)] {
        let Some(value) = one.map(|one| sign * one.objective) else { continue };
        if differs(&report[key], value) {
            let told = &report[key];
            found.wrong(FILE, format!("`{key}` is {told}, and the {of} evaluation has {value}"));
        }
    }
}

/// The objective of a flow is that of its quantities, at the best and at the start.
fn check_quantities(case: &CaseFile, report: &Value, found: &mut Found) {
    let Some(own) = &case.case().optimisation else { return };
    let objective = Objective::new(&own.objective, &case.case().define, &[]);
    let quantities = list(report, "quantities");
    for (key, of) in [("objective", "value"), ("start", "start")] {
        let value =
            |name: &String| quantities.iter().find(|one| one["name"] == **name)?[of].as_f64();
        let values: Option<Vec<f64>> = objective.quantities.iter().map(value).collect();
        let value = values.and_then(|values| objective.at(&values, &values).ok());
        if let Some(value) =
            value.map(|found| found.value).filter(|one| differs(&report[key], *one))
        {
            let told = &report[key];
            found.wrong(FILE, format!("`{key}` is {told}, and its quantities give {value}"));
        }
    }
}

/// What references are compared with is what was found, where the report has it.
fn check_compared(report: &Value, found: &mut Found) {
    let named = ["constraints", "parameters", "quantities"].map(|key| list(report, key));
    for one in list(report, "comparison") {
        let name = one["quantity"].as_str().unwrap_or_default();
        let other = named.iter().find_map(|all| all.iter().find(|other| other["name"] == *name));
        let known =
            if name == "objective" { Some(&report[name]) } else { other.map(|one| &one["value"]) };
        let known = known.and_then(Value::as_f64);
        if known.is_some_and(|known| differs(&one["computed"], known)) {
            found.wrong(FILE, format!("what is compared of `{name}` is not what was found"));
        }
    }
}

/// Journals are of the case that was searched, where the report tells it.
fn check_searched(search: &SearchDirectory, report: &Value, found: &mut Found) {
    let Some(told) = report["searched"].as_str() else { return };
    for one in &search.journals {
        if let Some(own) = one.checksum().filter(|own| *own != told) {
            let what = format!("line 1: it is of a case of {own}, and {FILE} of {told}");
            found.wrong(&one.file, what);
        }
    }
}

/// The table has a row of each evaluation, with its numbers.
fn check_table(search: &SearchDirectory, found: &mut Found) {
    let is_round = |one: &Named| one.file.starts_with("round-");
    let is_wanted = search.kind == Kind::Optimisation && search.journals.iter().any(is_round);
    let Some(rows) = found_rows(search, TABLE, is_wanted, found) else { return };
    let known: Vec<_> = search.journals.iter().flat_map(|one| &one.journal.known).collect();
    if rows.len() != known.len() {
        let (n, known) = (rows.len(), known.len());
        found.wrong(TABLE, format!("it has {n} rows, and the journals {known} evaluations"));
        return;
    }
    let sign = search.sign();
    for (nth, (row, one)) in rows.iter().zip(known).enumerate() {
        let numbers = [(nth + 1) as f64, sign * one.objective].into_iter();
        let numbers = numbers.chain(one.values.iter().copied());
        let wanted: Vec<f64> = numbers.chain(one.slopes.iter().map(|slope| sign * slope)).collect();
        let told: Option<Vec<f64>> = row.iter().map(|cell| cell.parse().ok()).collect();
        if told.as_ref() != Some(&wanted) {
            let line = nth + 2;
            let what = format!(
                "line {line} has other numbers than evaluation {} of the journals",
                nth + 1
            );
            found.wrong(TABLE, what);
        }
    }
}
