//! `sweep collect`: one table of all points of a sweep.

use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use crate::case::SweepQuantity;
use crate::cli::exit::{Exit, Failure};
use crate::cli::style::say;
use crate::observer::write_atomic;
use crate::sweep::{self, SweepDirectory, TABLE_FILE};

/// What `sweep collect` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife sweep collect sweeps/my
  alewife sweep collect sweeps/my --quantity squirmer.velocity.x --quantity 'mean squirmer.power'

One row a point: what it sets, how it ended, quantities, then for each reference what was computed and
the verdict, then unknowns, CPU seconds and the number of warnings. Statistics are final (the default), mean, max, min, rms and
range.")]
pub struct Options {
    /// Directory of the sweep
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    directory: PathBuf,
    /// File of the table; `sweep.csv` in the directory of the sweep if absent
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// A quantity besides those of references, with a statistic in front if wanted; instead of
    /// sweep.quantities of the case. May be repeated
    #[arg(long = "quantity", value_name = "NAME")]
    quantities: Vec<String>,
}

/// Writes the table of a sweep.
pub fn collect(options: &Options) -> Result<Exit, Failure> {
    let directory = SweepDirectory::open(&options.directory)?;
    let file = write(&directory, options.out.as_deref(), &options.quantities)?;
    say(&format!("written to {}", file.display()));
    Ok(Exit::Done)
}

/// Writes the table of a sweep, with quantities other than its own if there are any; where it is.
pub fn write(
    directory: &SweepDirectory,
    out: Option<&Path>,
    quantities: &[String],
) -> Result<PathBuf, Failure> {
    // Those of the sweep have been checked with its cases
    let is_own = quantities.is_empty();
    let quantities = if is_own { &directory.plan().quantities } else { quantities };
    let parsed = quantities.iter().map(|text| SweepQuantity::parse(text));
    let wanted: Vec<SweepQuantity> = parsed
        .collect::<Result<_, _>>()
        .map_err(|reason| Failure::new(Exit::Usage, format!("--quantity: {reason}")))?;
    let unknown = if is_own { None } else { sweep::unknown_quantity(directory, &wanted)? };
    if let Some(reason) = unknown {
        return Err(Failure::new(Exit::Usage, format!("--quantity: {reason}")));
    }
    let table = sweep::collect(directory, &wanted)?;
    let file = out.map_or_else(|| directory.path().join(TABLE_FILE), Path::to_owned);
    write_atomic(&file, &table)?;
    Ok(file)
}
