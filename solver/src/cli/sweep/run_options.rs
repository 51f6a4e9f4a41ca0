//! What `sweep run` is asked for.

use std::path::PathBuf;

use clap::Args;

use super::index::Index;
use super::swept::Swept;
use crate::case::{Sweep, SweepQuantity, WallTime};
use crate::cli::exit::{Exit, Failure};

/// What `sweep run` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife sweep run my.toml --set fluid.viscosity=1:100:9:log
  alewife sweep run my.toml --jobs 4 --threads 2     4 points at once, each with 2 threads
  alewife sweep run my.toml --index 7                point 7 alone, in this process
  alewife sweep run my.toml --quantity 'mean fish.power' --quantity fish.velocity.x
  alewife sweep run my.toml --index 21-30            10 points, as a task of a job array

Points are counted from 1 and lie in DIR/points/0001, ...: directories as `alewife run` makes them. A
signal, or a file STOP made in DIR, stops all points with their checkpoints and exit code 75. Exit
code 0: all points are finished; else that of the first point that failed.")]
pub struct Options {
    #[command(flatten)]
    pub swept: Swept,
    /// Directory of the sweep; `sweeps/<case>` if absent
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Only this point, counted from 1, or these: 7 or 5-8
    #[arg(long, short, value_name = "I")]
    pub index: Option<Index>,
    /// Points that run at once; by default as many as the granted cores have space for
    #[arg(long, short, value_name = "N")]
    pub jobs: Option<usize>,
    /// Threads of each point; 1 by default, for a single --index those granted
    #[arg(long, short, value_name = "N")]
    pub threads: Option<usize>,
    /// Stop in time for checkpoints within this time on the clock, such as "2 h"; by default the end
    /// of the batch job
    #[arg(long, value_name = "TIME")]
    pub max_walltime: Option<WallTime>,
    /// A quantity that the table has besides those of references, with a statistic in front if wanted;
    /// instead of sweep.quantities of the case. May be repeated
    #[arg(long = "quantity", value_name = "NAME")]
    pub quantities: Vec<String>,
    /// Run points again that failed and would, with the same program, fail in the same way
    #[arg(long)]
    pub retry: bool,
    /// No progress on the terminal
    #[arg(long, short)]
    pub quiet: bool,
    /// The process that runs the sweep: without it, this one stops
    #[arg(long, hide = true)]
    pub parent: Option<u32>,
}

impl Options {
    /// Reads the sweep, with the quantities that its table is to have.
    pub fn sweep(&self) -> Result<Sweep, Failure> {
        let mut sweep = self.swept.read()?;
        let parsed = self.quantities.iter().map(|text| SweepQuantity::parse(text));
        let wanted: Vec<SweepQuantity> = parsed
            .collect::<Result<_, _>>()
            .map_err(|reason| Failure::new(Exit::Usage, format!("--quantity: {reason}")))?;
        if !wanted.is_empty() {
            sweep.quantities = wanted;
        }
        Ok(sweep)
    }
}
