//! The table of a sweep: one row a point, with what it sets, what came out, and what it cost.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use serde_json::Value;

use super::directory::SweepDirectory;
use super::point_state::{PointState, Stand, stand};
use crate::case::{Case, CaseError, SweepQuantity, suggestion};
use crate::observer::{COMPARISON_FILE, Status, read_outcome};
use crate::run::RunSummary;
use crate::validation::{Verdict, measured_in_whole, measured_value};

/// One row of the table, by the names of its columns.
#[derive(Debug, Default)]
struct Row {
    /// Quantities that were asked for, or the last values of all.
    quantities: Cells,
    /// Computed values and verdicts of references.
    references: Cells,
}

/// Cells of a row by their columns, in the order in which they came.
#[derive(Debug, Default)]
struct Cells(Vec<Cell>);

#[derive(Debug)]
struct Cell {
    column: String,
    text: String,
}

impl Cells {
    /// Adds a cell; a second one of the same name gets a number.
    fn add(&mut self, column: &str, text: String) {
        let n = self.0.iter().filter(|cell| cell.column == column).count();
        let column = if n == 0 { column.to_owned() } else { format!("{column} [{}]", n + 1) };
        self.0.push(Cell { column, text });
    }

    fn get(&self, column: &str) -> &str {
        self.0.iter().find(|cell| cell.column == column).map_or("", |cell| &cell.text)
    }
}

/// A number with as many digits as it takes to read the same number back.
fn number(value: f64) -> String {
    format!("{value:?}")
}

/// The table of a sweep as CSV, of the quantities asked for besides those of references; the last
/// values of all quantities where there is neither.
///
/// # Errors
/// When files of finished points cannot be read.
pub fn collect(directory: &SweepDirectory, quantities: &[SweepQuantity]) -> io::Result<Vec<u8>> {
    let n = directory.n_points();
    let stands: Vec<Stand> = (0..n).map(|index| stand(directory, index)).collect();
    let mut rows: Vec<Row> = Vec::with_capacity(n);
    for (index, stand) in stands.iter().enumerate() {
        rows.push(match stand.state {
            PointState::Finished => row(&directory.point(index), quantities)?,
            _ => Row::default(),
        });
    }
    let columns = |cells: fn(&Row) -> &Cells| {
        let mut columns: Vec<&str> = Vec::new();
        let mut known = BTreeMap::new();
        for Cell { column, .. } in rows.iter().flat_map(|row| &cells(row).0) {
            if known.insert(column, ()).is_none() {
                columns.push(column);
            }
        }
        columns
    };
    let (quantities, references) = (columns(|row| &row.quantities), columns(|row| &row.references));

    let mut writer = csv::Writer::from_writer(Vec::new());
    let plan = directory.plan();
    let front = ["point"].into_iter().chain(plan.swept.iter().map(String::as_str)).chain(["state"]);
    let back = ["unknowns", "cpu_seconds", "warnings", "reason"];
    let header = front.chain(quantities.iter().copied()).chain(references.iter().copied());
    writer.write_record(header.chain(back))?;
    for (index, (row, stand)) in rows.iter().zip(&stands).enumerate() {
        let mut cells = vec![(index + 1).to_string()];
        cells.extend(plan.points[index].iter().map(plain));
        cells.push(stand.state.name().to_owned());
        cells.extend(quantities.iter().map(|column| row.quantities.get(column).to_owned()));
        cells.extend(references.iter().map(|column| row.references.get(column).to_owned()));
        cells.extend(ends_of(stand));
        writer.write_record(&cells)?;
    }
    writer.into_inner().map_err(|error| io::Error::other(error.to_string()))
}

/// What no finished point has of the quantities asked for, with the names there are: a misspelt one.
///
/// # Errors
/// When files of finished points cannot be read.
pub fn unknown_quantity(
    directory: &SweepDirectory,
    quantities: &[SweepQuantity],
) -> io::Result<Option<String>> {
    let mut unknown: Vec<&str> =
        quantities.iter().map(|wanted| wanted.statistic.quantity.as_str()).collect();
    let mut known = Vec::new();
    for index in 0..directory.n_points() {
        if unknown.is_empty() {
            return Ok(None);
        }
        if stand(directory, index).state == PointState::Finished {
            known = read_outcome(&directory.point(index))?.series.names;
            unknown.retain(|name| !known.iter().any(|one| one == name));
        }
    }
    // Before a point is finished all may come
    let first = unknown.first().filter(|_| !known.is_empty());
    Ok(first.map(|name| format!("no point has a quantity `{name}`; {}", suggestion(name, &known))))
}

/// A value of a swept key: texts without quotes.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Size, cost, number of warnings, and why it failed.
fn ends_of(stand: &Stand) -> [String; 4] {
    let status = stand.status.as_ref();
    let reason = stand.failure.as_ref().map(|failure| failure.line().to_owned());
    [
        status.map_or_else(String::new, |status| status.dofs.to_string()),
        status
            .and_then(|status| status.cpu_seconds.get("total").copied())
            .map_or_else(String::new, number),
        status.map_or_else(String::new, |status| status.warnings.len().to_string()),
        reason.unwrap_or_default(),
    ]
}

/// What came out at a finished point.
fn row(run: &Path, quantities: &[SweepQuantity]) -> io::Result<Row> {
    let in_run =
        |error: &dyn std::fmt::Display| io::Error::other(format!("{}: {error}", run.display()));
    let references = compared(run).map_err(|error| in_run(&error))?;
    let mut cells = Cells::default();
    if !quantities.is_empty() {
        let outcome = read_outcome(run).map_err(|error| in_run(&error))?;
        let has_flow = Status::read(run)?.fidelity.is_none();
        let case = has_flow.then(|| case_of(run)).transpose().map_err(|error| in_run(&error))?;
        for wanted in quantities {
            cells.add(&wanted.statistic.label(), measured(&outcome, case.as_ref(), wanted));
        }
    } else if references.0.is_empty() {
        let RunSummary { series, .. } = read_outcome(run).map_err(|error| in_run(&error))?;
        for (name, value) in series.names.iter().zip(series.rows.last().into_iter().flatten()) {
            cells.add(name, number(*value));
        }
    }
    Ok(Row { quantities: cells, references })
}

/// The case as it was run.
fn case_of(run: &Path) -> Result<Case, CaseError> {
    Ok(Case::read(&run.join("case.toml").display().to_string(), &[])?.model.case)
}

/// A quantity of a run by its statistic; nothing where it cannot be taken.
fn measured(outcome: &RunSummary, case: Option<&Case>, wanted: &SweepQuantity) -> String {
    let value = match case {
        Some(case) => measured_value(&outcome.series, case, &wanted.statistic),
        None => measured_in_whole(&outcome.series, &wanted.statistic),
    };
    value.map_or_else(|_| String::new(), number)
}

/// Computed values and verdicts as the run found them.
fn compared(run: &Path) -> io::Result<Cells> {
    let mut cells = Cells::default();
    let text = match std::fs::read(run.join(COMPARISON_FILE)) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(cells),
        text => text?,
    };
    let all: Value = serde_json::from_slice(&text)?;
    // Of a soft case, the values at the end
    for row in all.as_array().into_iter().flatten() {
        let label = row["quantity"].as_str().unwrap_or_default();
        let is_within = row["within"].as_bool().unwrap_or_default();
        let verdict = if is_within { Verdict::Within } else { Verdict::Outside };
        cells.add(label, row["computed"].as_f64().map_or_else(String::new, number));
        cells.add(&format!("{label} verdict"), verdict.name().to_owned());
    }
    for row in all["comparisons"].as_array().into_iter().flatten() {
        let text = |key: &str| row[key].as_str().unwrap_or_default();
        let minus = row["minus"].as_str().map_or_else(String::new, |minus| format!(" - {minus}"));
        let statistic = match text("statistic") {
            "final" => String::new(),
            "at" => format!(" (at {})", row["at"]),
            "crossing" => format!(" (crossing {})", row["level"]),
            "when" => format!(" (when {} = {})", text("of"), row["level"]),
            other => format!(" ({other})"),
        };
        let label = format!("{}{minus}{statistic}", text("quantity"));
        cells.add(&label, row["computed"].as_f64().map_or_else(String::new, number));
        cells.add(&format!("{label} verdict"), text("verdict").to_owned());
    }
    Ok(cells)
}
