//! `sweep expand`: the points of a sweep, as a table or as JSON.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Map, Value, json};

use super::points::check_points;
use super::swept::{Swept, directory_of};
use crate::case::{Sweep, printable};
use crate::cli::exit::{Exit, Failure};
use crate::cli::style::{self, Ink, complain, on_stdout, say};

/// What `sweep expand` is asked for.
#[derive(Debug, Args)]
pub struct Options {
    #[command(flatten)]
    swept: Swept,
    /// Directory of the sweep; `sweeps/<case>` if absent
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Prints the points of a sweep, after all of them have been checked.
pub fn expand(options: &Options) -> Result<Exit, Failure> {
    let sweep = options.swept.read()?;
    let warnings = check_points(&sweep, 0..sweep.n_points())?;
    if !warnings.is_empty() {
        complain(&style::diagnostics(&warnings));
    }
    if options.json {
        say(&format!("{:#}", to_json(&sweep, options.out.as_ref())));
    } else {
        let lines = table(&sweep);
        let mut lines = lines.iter();
        if let Some(header) = lines.next() {
            say(&on_stdout(Ink::Bold, header));
        }
        lines.for_each(|line| say(line));
    }
    Ok(Exit::Done)
}

fn to_json(sweep: &Sweep, out: Option<&PathBuf>) -> Value {
    let points = (0..sweep.n_points()).map(|index| {
        let keys = sweep.keys().into_iter().map(str::to_owned);
        let settings: Map<String, Value> = keys.zip(sweep.point(index).values()).collect();
        json!({ "point": index + 1, "settings": settings })
    });
    json!({
        "case": sweep.name(),
        "file": sweep.file(),
        "directory": directory_of(out, sweep),
        "points": points.collect::<Vec<_>>(),
    })
}

/// A line of headings, then one of each point.
fn table(sweep: &Sweep) -> Vec<String> {
    let headings = ["point"].into_iter().chain(sweep.keys()).map(printable).collect();
    let mut rows: Vec<Vec<String>> = vec![headings];
    for index in 0..sweep.n_points() {
        let text = |value: Value| value.as_str().map_or_else(|| value.to_string(), printable);
        let values = sweep.point(index).values().into_iter().map(text);
        rows.push([(index + 1).to_string()].into_iter().chain(values).collect());
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..rows[0].len()).filter_map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}"));
        cells.collect::<Vec<_>>().join("  ")
    };
    rows.iter().map(line).collect()
}
