//! `verify`: whether what a run, a sweep or a search has left is whole and agrees with itself; nothing is run.

mod fields;
mod found;
mod known;
mod motion;
mod one;
mod records;
mod report;
mod run;
mod search;
mod searched_case;
mod states;
mod sweep;
mod table;

use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::exit::{Exit, Failure};
use super::searched::SearchDirectory;
use super::style::say;
use crate::observer::RunDirectory;
use crate::sweep::PLAN_FILE;
use found::Found;

/// What `verify` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife verify runs/squirmer-alone
  alewife verify sweeps/my --json

Of a run: its case, with the checksum in provenance.json; status.json and the legs; that times in series.csv
rise, and its rows are those of the states; that states can be read, and continue this case; that all fields
of fields.pvd are there, whole and of this run; messages, comparison and log. Of a run of a soft case or a reduced
model: the same of what it has, and that there is a row of each frame or step. Of a sweep: that each point is
the one of its place, all of that for each point, and the table. Points that are missing are counted. Of a
search, of optimise, calibrate or loop: that its journals can be read, and the report, the table and the case have
what they have.

Exit codes: 0 all is sound; 65 something is not; 66 there is no run, sweep or search.")]
pub struct Options {
    /// Directories of runs, sweeps or searches
    #[arg(required = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    directories: Vec<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Reports what is wrong in directories of runs, sweeps and searches.
pub fn verify(options: &Options) -> Result<Exit, Failure> {
    let mut all = Vec::new();
    let mut is_sound = true;
    for directory in &options.directories {
        let found = look_at(directory)?;
        is_sound &= found.is_sound();
        if options.json {
            all.push(found.to_json());
        } else {
            found.print();
        }
    }
    if options.json {
        say(&format!("{:#}", serde_json::Value::from(all)));
    }
    Ok(if is_sound { Exit::Done } else { Exit::BadCase })
}

fn look_at(directory: &Path) -> Result<Found, Failure> {
    if directory.join(PLAN_FILE).exists() {
        return Ok(sweep::verify(directory));
    }
    if RunDirectory::is_one(directory) {
        return Ok(one::verify(directory));
    }
    if let Ok(Some(found)) = SearchDirectory::read(directory) {
        return Ok(search::verify(&found));
    }
    let reason = format!("{} is the directory of no run, sweep or search", directory.display());
    Err(Failure::new(Exit::NoInput, reason))
}
