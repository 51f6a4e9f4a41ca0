//! `calibrate` and `optimise`: searches of a soft case.

use std::path::{Path, PathBuf};

use alewife_reduced::search::{Ended, Progress, SearchError};
use alewife_reduced::tier::{Bodies, Job, SolidOf, Which};
use clap::{Args, ValueHint};

use super::directory::{not_written, prepare};
use super::run::print;
use crate::case::soft::SoftFile;
use crate::cli::complete;
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::Settings;
use crate::cli::style::{complain, say};

/// The file that is written last.
const LAST: &str = "report.json";

/// What a search is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
A search that was stopped or killed goes on when it is called again, from the evaluations in its
search.journal, and ends with the same bits.

Its directory gets case.toml, the case with what was found, which runs as it stands there, and
report.json: each number with its bounds and how well it is determined. A calibration of a reduced model
writes calibrated.toml instead: coefficients, how well each is determined, and errors by run and quantity.")]
pub struct SearchOptions {
    /// Which case
    #[arg(add = complete::case())]
    pub case: String,
    #[command(flatten)]
    pub settings: Settings,
    /// Directory of the search; `runs/<case>-calibration` or `-optimisation` if absent
    #[arg(long, short, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Replace a finished search
    #[arg(long)]
    pub overwrite: bool,
    /// No progress on the terminal
    #[arg(long, short)]
    pub quiet: bool,
}

impl SearchOptions {
    /// Which case.
    pub fn case(&self) -> &str {
        &self.case
    }

    /// Keys that are set.
    pub fn set(&self) -> &[String] {
        &self.settings.set
    }

    /// Where it is written, if that is said.
    pub fn out(&self) -> Option<&Path> {
        self.out.as_deref()
    }

    /// Whether what is finished is replaced.
    pub fn overwrites(&self) -> bool {
        self.overwrite
    }
}

/// Seeks what a case asks for.
pub fn seek(options: &SearchOptions, which: Which) -> Result<Exit, Failure> {
    let file = SoftFile::read(&options.case, &options.settings.set)?;
    match file.case.geometry.dimensions() {
        2 => sought::<2>(&file, options, which),
        _ => sought::<3>(&file, options, which),
    }
}

fn sought<const D: usize>(
    file: &SoftFile,
    options: &SearchOptions,
    which: Which,
) -> Result<Exit, Failure>
where
    Bodies: SolidOf<D>,
{
    let default = || Path::new("runs").join(format!("{}-{}", file.directory_name(), which.name()));
    let out = options.out.clone().unwrap_or_else(default);
    let job = Job::<D>::new(file, which)?;
    let _held = prepare(&out, [LAST, "journal"], options.overwrite)?;
    let mut told = |progress: &Progress| {
        if !options.quiet {
            complain(&progress_line(progress, which));
        }
    };
    let result = job.seek(&out, &mut told).map_err(|error| search_failure(&error))?;
    say(result.text(which).trim_end());
    result.write(&out, file, which).map_err(|error| not_written(&out, &error))?;
    print(&result.compared);
    say(&format!("written to {}", out.display()));
    match &result.found.ended {
        Ended::Failed(why) => {
            let message = format!("the search ended early: {why}; its best point is written");
            Err(Failure::new(Exit::Diverged, message))
        }
        _ if !result.found.has_effect() => {
            let message =
                "nothing depends on the numbers that are sought: other ones, or another record";
            Err(Failure::new(Exit::BadCase, message))
        }
        _ if result.compared.iter().any(|one| !one.is_within()) => Ok(Exit::OutsideTolerance),
        _ => Ok(Exit::Done),
    }
}

/// An evaluation in a line.
pub fn progress_line(progress: &Progress, which: Which) -> String {
    let Progress { n_evaluations, most, last, best, each } = progress;
    let (what, sign) = match which {
        Which::Calibration => ("loss", 1.0),
        Which::Optimisation => ("objective", -1.0),
    };
    format!(
        "[{n_evaluations}/{most}] {what} {:.6e}, best {:.6e}, {:.2} s each, {:.0} s left at most",
        sign * last.objective,
        sign * best,
        each.as_secs_f64(),
        progress.remaining().as_secs_f64()
    )
}

/// Why a search did not begin.
pub fn search_failure(error: &SearchError) -> Failure {
    let exit = match error {
        SearchError::Bounds { .. } => Exit::BadCase,
        SearchError::Start(_) => Exit::Diverged,
        SearchError::Stopped(_) => Exit::Stopped,
        SearchError::OtherSearch(_) => Exit::Usage,
        SearchError::File { .. } => Exit::InputOutput,
    };
    Failure::new(exit, error.to_string())
}
