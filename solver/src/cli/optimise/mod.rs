//! `optimise`: numbers of a case that make its objective large, of an elastic body without a flow, of a steady flow, of
//! the end of a run without inertia, or of the motion of a reduced model.

use std::path::{Path, PathBuf};

use alewife_reduced::search::Ended;
use alewife_reduced::tier::Which;

use super::exit::{Exit, Failure};
use super::gradient;
use super::read::{CheckedCase, print_warnings, read_and_check};
use super::soft::{self, SearchOptions, not_written, prepare, progress_line};
use super::style::{complain, say};
use crate::case::soft::SoftFile;
use crate::case::{CaseFile, check_flow, printable};
use crate::optimise::{Compared, FlowSearch, Held, OptimiseError, RoundProgress};

/// The file that is written last.
const LAST: &str = "report.json";

/// Seeks the optimum of a case.
pub fn optimise(options: &SearchOptions) -> Result<Exit, Failure> {
    if SoftFile::read_if_soft(&options.case, &options.settings.set)?.is_some() {
        return soft::seek(options, Which::Optimisation);
    }
    let file = read(options)?;
    let failure = |error| search_failure(&file, error);
    let search = FlowSearch::new(&file).map_err(failure)?;
    let out = options.out.clone().unwrap_or_else(|| default_directory(&file));
    let _held = prepare(&out, [LAST, "journal"], options.overwrite)?;
    let mut told = |one: &RoundProgress| {
        if !options.quiet {
            let line = progress_line(&one.progress, Which::Optimisation);
            complain(&format!("round {} {line}", one.round));
        }
    };
    let optimum = search.seek(&out, &mut told).map_err(failure)?;
    say(optimum.text().trim_end());
    optimum.write(&out).map_err(|error| not_written(&out, &error))?;
    let compared = optimum.compared();
    for one in &compared {
        if one.is_within() { say(&one.line()) } else { complain(&one.line()) }
    }
    say(&format!("written to {}", out.display()));
    match &optimum.found.ended {
        Ended::Failed(why) => {
            let message = format!("the search ended early: {why}; its best point is written");
            Err(Failure::new(Exit::Diverged, message))
        }
        _ if !optimum.found.has_effect() => {
            let message =
                "nothing depends on the numbers that are sought: other ones, or another objective";
            Err(Failure::new(Exit::BadCase, message))
        }
        _ if !optimum.held.iter().all(Held::is_met) => {
            let message = "a constraint is not met: the best point is written; more `evaluations`, other bounds, or a \
                           value that can be met";
            Err(Failure::new(Exit::Diverged, message))
        }
        _ if compared.iter().all(Compared::is_within) => Ok(Exit::Done),
        _ => Ok(Exit::OutsideTolerance),
    }
}

/// Reads the case; the full solver needs tables that a reduced model does not.
fn read(options: &SearchOptions) -> Result<CaseFile, Failure> {
    let CheckedCase { file, warnings } = read_and_check(&options.case, &options.settings.set)?;
    let missing = if file.case().is_searched_reduced() { Vec::new() } else { check_flow(&file) };
    if !missing.is_empty() {
        return Err(Failure::wrong(&missing));
    }
    print_warnings(&warnings);
    Ok(file)
}

/// What the search of a case is about, in a line.
pub fn search_line(file: &CaseFile) -> Option<String> {
    let spec = file.case().optimisation.as_ref()?;
    let quantities = spec.objective.quantities();
    let quantities: Vec<&str> = quantities.iter().map(|part| part.quantity).collect();
    let numbers: Vec<String> = file.sought().into_iter().map(|number| number.name).collect();
    let line = format!("`alewife optimise`: {} by {}", quantities.join(", "), numbers.join(", "));
    Some(printable(&line))
}

/// Where a search is written if nothing else is asked for.
fn default_directory(file: &CaseFile) -> PathBuf {
    Path::new("runs").join(format!("{}-optimisation", file.directory_name()))
}

/// Why a search did not begin, with the place in the case that is to blame.
pub fn search_failure(file: &CaseFile, error: OptimiseError) -> Failure {
    match error {
        OptimiseError::Case(error) => error.into(),
        OptimiseError::Gradient(error) => gradient::failure(file, error),
        OptimiseError::Search(error) => soft::search_failure(&error),
        OptimiseError::Model(error) => Failure::new(Exit::Diverged, error.to_string()),
    }
}
