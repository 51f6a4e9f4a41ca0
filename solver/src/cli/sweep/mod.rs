//! `sweep`: a case at many points: `expand`, `run`, `status`, `collect`, `script`.

mod collect;
mod expand;
mod index;
mod many;
mod point;
mod points;
mod run;
mod run_options;
mod script;
mod status;
mod swept;

use clap::{Args, Subcommand};

use super::exit::{Exit, Failure};

pub use points::check_points;

/// What `sweep` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife sweep expand squirmer-alone           the points of its [sweep]
  alewife sweep run squirmer-alone              run them, into sweeps/squirmer-alone
  alewife sweep run my.toml --set fluid.viscosity=1:100:9:log --jobs 4
  alewife sweep run my.toml --index 7           only point 7, as a task of a job array
  alewife sweep status sweeps/my
  alewife sweep collect sweeps/my               one table of all points: sweeps/my/sweep.csv
  alewife sweep script my.toml > my.sh          for Slurm: sbatch my.sh

The same call again makes what is missing: points that were stopped or killed continue, and points that
are finished stay as they are.")]
pub struct Options {
    #[command(subcommand)]
    command: SweepCommand,
}

#[derive(Debug, Subcommand)]
enum SweepCommand {
    /// Print the points of a sweep
    Expand(expand::Options),
    /// Run the points of a sweep, several at once, or those that are missing
    Run(run_options::Options),
    /// Show how many points are done, and list the others
    Status(status::Options),
    /// Write one table of all points
    Collect(collect::Options),
    /// Print a job script that runs the sweep as an array of Slurm
    Script(script::Options),
}

impl Options {
    /// Whether points are run, which sees to signals itself.
    pub fn runs(&self) -> bool {
        matches!(self.command, SweepCommand::Run(_))
    }
}

/// Does what the command line says.
pub fn sweep(options: &Options) -> Result<Exit, Failure> {
    match &options.command {
        SweepCommand::Expand(options) => expand::expand(options),
        SweepCommand::Run(options) => run::run(options),
        SweepCommand::Status(options) => status::status(options),
        SweepCommand::Collect(options) => collect::collect(options),
        SweepCommand::Script(options) => script::script(options),
    }
}
