//! `gradient`: how quantities of a steady flow, or of the end of a motion without inertia, change with numbers of its case.

use clap::Args;
use serde_json::{Value, json};

use super::complete;
use super::exit::{Exit, Failure};
use super::read::{Settings, read_case};
use super::style::{Ink, on_stdout, say};
use crate::case::{
    Case, CaseFile, differentiable_columns, known_quantities, no_gradient_in_time, printable,
};
use crate::gradient::{Derivatives, GradientError, GradientTask, gradients};
use crate::runner::with_key;

/// What `gradient` is asked for.
#[derive(Debug, Args)]
pub struct Options {
    /// Which case
    #[arg(add = complete::case())]
    case: String,
    /// Quantities, by their columns in series.csv: of a steady flow loads, powers and velocities of bodies and swimmers,
    /// such as ball.force.x; of a run without inertia by steps of rk3 what it ends with, places and averages over the last
    /// cycle, such as swimmer.cycle.x
    #[arg(long, required = true, value_delimiter = ',', value_name = "QUANTITY[,QUANTITY...]")]
    of: Vec<String>,
    /// Keys of numbers of the case, such as fluid.viscosity,body.0.shape.disc.radius
    #[arg(long, required = true, value_delimiter = ',', value_name = "KEY[,KEY...]")]
    by: Vec<String>,
    #[command(flatten)]
    settings: Settings,
    /// Compare each derivative with a central difference of two complete solutions, or of two runs, on the mesh that moves
    /// with the number; exit code 20 where they differ by more than 1e-4
    #[arg(long)]
    check: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Part of a derivative by which it may differ from a difference.
const TOLERANCE: f64 = 1e-4;
/// Part of the largest change by a number relative to which smaller ones are compared.
const SMALL: f64 = 1e-3;
/// Part of the loads or velocities a quantity is made of, relative to which changes are that are zero but for rounding.
const ZERO: f64 = 1e-5;

/// A derivative of a quantity by a number of a case.
struct Row<'a> {
    key: &'a str,
    derivative: f64,
    /// The same by a central difference, if asked for.
    difference: Option<f64>,
    /// What both differ by, over the derivative.
    error: Option<f64>,
}

/// Prints the derivatives of quantities of a case by some of its numbers.
pub fn gradient(options: &Options) -> Result<Exit, Failure> {
    let file = read_case(&options.case, &options.settings.set)?;
    let read = |more: &[String]| {
        let settings = [&options.settings.set[..], more].concat();
        Case::read(&options.case, &settings)
    };
    let Options { of, by, check, .. } = options;
    of.iter().try_for_each(|quantity| has_gradient(&file, quantity))?;
    let task = GradientTask { read: &read, of, by, checks: *check };
    let found = gradients(&task).map_err(|error| failure(&file, error))?;
    let numbers: Vec<f64> = by.iter().map(|key| file.number(key).unwrap_or(1.0)).collect();
    let tables: Vec<Vec<Row<'_>>> =
        found.iter().map(|quantity| rows(quantity, by, &numbers)).collect();
    if options.json {
        let quantities = found.iter().zip(&tables).map(|(of, rows)| to_json(of, rows));
        let all: Vec<Value> = quantities.collect();
        say(&format!("{:#}", json!({ "case": file.full_name(), "quantities": all })));
    } else {
        found.iter().zip(&tables).for_each(|(of, rows)| print(of, rows));
    }
    let errors = tables.iter().flatten().filter_map(|row| row.error);
    let is_within = errors.fold(0.0, f64::max) <= TOLERANCE;
    Ok(if is_within { Exit::Done } else { Exit::OutsideTolerance })
}

/// Refuses a quantity that the case has and whose gradient is not known; one that it has not is told of with what is near it.
fn has_gradient(file: &CaseFile, quantity: &str) -> Result<(), Failure> {
    let known = differentiable_columns(&file.model);
    let is_known = known.iter().any(|column| column.name == quantity);
    let is_there = known_quantities(&file.model).iter().any(|name| name == quantity);
    if is_known || !is_there || no_gradient_in_time(file.case()).is_some() {
        return Ok(());
    }
    let names: Vec<&str> = known.iter().map(|column| column.name.as_str()).collect();
    let message = format!(
        "`{}` is a quantity of the case, and its gradient is not known\n = gradients are those of {}",
        printable(quantity),
        names.join(", ")
    );
    Err(Failure::new(Exit::BadCase, message))
}

fn rows<'a>(of: &Derivatives, keys: &'a [String], numbers: &[f64]) -> Vec<Row<'a>> {
    // Derivatives by numbers of other units are compared by what a change by all of the number would do
    let size = |number: f64| if number == 0.0 { 1.0 } else { number.abs() };
    let effects = of.by.iter().zip(numbers).map(|(by, number)| (by * size(*number)).abs());
    let largest = effects.fold(0.0, f64::max);
    let row = |(index, key): (usize, &'a String)| {
        let (derivative, difference) = (of.by[index], of.differences.get(index).copied());
        let least = (SMALL * largest).max(ZERO * of.size) / size(numbers[index]);
        let scale = derivative.abs().max(least).max(f64::MIN_POSITIVE);
        let error = difference.map(|difference| (derivative - difference).abs() / scale);
        Row { key, derivative, difference, error }
    };
    keys.iter().enumerate().map(row).collect()
}

fn print(of: &Derivatives, rows: &[Row<'_>]) {
    say(&on_stdout(Ink::Bold, &format!("{} = {:.10e}", printable(&of.of), of.value)));
    let width = rows.iter().map(|row| row.key.chars().count()).max().unwrap_or(0);
    for Row { key, derivative, difference, error } in rows {
        let mut line = format!("  by {:<width$}  {derivative:>18.10e}", printable(key));
        if let (Some(difference), Some(error)) = (difference, error) {
            line += &format!("  difference {difference:>18.10e}, off by {error:.1e}");
        }
        say(&line);
    }
}

fn to_json(of: &Derivatives, rows: &[Row<'_>]) -> Value {
    let by = rows.iter().map(|row| {
        let mut entry = json!({ "key": row.key, "derivative": row.derivative });
        if let (Some(difference), Some(error)) = (row.difference, row.error) {
            entry["difference"] = json!(difference);
            entry["error"] = json!(error);
        }
        entry
    });
    json!({ "quantity": of.of, "value": of.value, "by": by.collect::<Vec<_>>() })
}

/// Why there is no gradient, with the place in the case that is to blame.
pub fn failure(file: &CaseFile, error: GradientError) -> Failure {
    match error {
        GradientError::Case(error) => error.into(),
        GradientError::Run(error) => with_key(file, error),
        GradientError::Adjoint(_) => Failure::new(Exit::Diverged, error.to_string()),
    }
}
