//! `validate`: shipped cases against their references, as a table or as JSON, with an exit code.

use std::path::{Path, PathBuf};

use clap::Args;

use super::engine::RunInto;
use super::exit::{Exit, Failure};
use super::read::{CheckedCase, read_and_check};
use super::signal::SignalWatch;
use super::style::{Ink, complain, on_stdout, say};
use super::{engine, results, threads};
use crate::case::{Cadence, Case, CaseFile, Numbers, Statistics, library};
use crate::observer::{Earlier, RunDirectory, RunState, Shown, Start, Status, read_outcome};
use crate::simulation::{RunError, RunSummary};
use crate::validation::{
    Comparison, compare, comparison_page, comparisons_to_json, count_table, not_computed, summary,
};

/// What `validate` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife validate --quick
  alewife validate squirmer-alone dfg-2d-1
  alewife validate --json > validation.json
  alewife validate three-sphere --out runs      keep the runs; later, with other references,
  alewife validate three-sphere --from runs     compare them again

The exit code is 20 if a value is outside its tolerance or could not be computed, 65 if there is
nothing to compare with, and 75 if a signal stopped it: the cases done so far are printed then. A value
that is known to be outside, for a reason that its reference gives, fails once it is within.")]
pub struct Options {
    /// Which cases, with all their variants; all shipped ones if absent
    cases: Vec<String>,
    /// Only those marked `quick = true`
    #[arg(long)]
    quick: bool,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Print a page of Markdown instead of a table
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Keep the runs, each in a directory of its own in this one
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Compare runs that were kept there by --out, as long as nothing but references has changed
    #[arg(long, value_name = "DIR", conflicts_with = "out")]
    from: Option<PathBuf>,
    /// Threads; by default those the batch system or the machine grants
    #[arg(long, short, value_name = "N")]
    threads: Option<usize>,
}

/// Runs cases and compares them with their references.
pub fn validate(options: &Options) -> Result<Exit, Failure> {
    let names = if options.cases.is_empty() {
        library::list().iter().map(|case| case.name.to_owned()).collect()
    } else {
        options.cases.clone()
    };
    let members = all_members(&names, options.quick)?;
    let n_threads = threads::start(options.threads)?;

    if members.is_empty() {
        let names = names.join(", ");
        let quick = if options.quick { "quick " } else { "" };
        let nothing = format!("{names}: there is no {quick}reference to compare with");
        return Err(Failure::new(Exit::BadCase, nothing));
    }
    let work = Work { options, n_threads, watch: SignalWatch::start()? };
    let mut comparisons: Vec<Comparison> = Vec::new();
    let mut stopped = None;
    for (index, Member { name: member, file }) in members.iter().enumerate() {
        complain(&format!("[{}/{}] {member}", index + 1, members.len()));
        match work.validate(file) {
            Ok(rows) => comparisons.extend(rows),
            Err(failure) if failure.exit == Exit::Stopped => {
                let n = members.len();
                stopped = Some(format!("stopped by a signal in {member}; {index} of {n} are done"));
                break;
            }
            Err(failure) => return Err(failure),
        }
    }
    print(&comparisons, options);
    match stopped {
        Some(reason) => Err(Failure::new(Exit::Stopped, reason)),
        None if comparisons.iter().any(|row| row.verdict.is_failure()) => {
            Ok(Exit::OutsideTolerance)
        }
        None => Ok(Exit::Done),
    }
}

/// Prints comparisons in the form that was asked for.
fn print(comparisons: &[Comparison], options: &Options) {
    let is_good = !comparisons.iter().any(|row| row.verdict.is_failure());
    if options.json {
        say(&format!("{:#}", comparisons_to_json(comparisons)));
    } else if options.markdown {
        say(comparison_page(comparisons).trim_end());
    } else {
        say(&format!("{}\n", count_table(comparisons).join("\n")));
        results::print_comparisons(comparisons);
        say(&on_stdout(if is_good { Ink::Green } else { Ink::Red }, &summary(comparisons)));
    }
}

/// A case or a variant that is to be validated.
struct Member {
    name: String,
    file: CaseFile,
}

/// The members of all these cases, each of them read and checked.
///
/// # Errors
/// With all that is wrong in any of them.
fn all_members(names: &[String], only_quick: bool) -> Result<Vec<Member>, Failure> {
    let (mut members, mut failures) = (Vec::new(), Vec::new());
    for name in names {
        match members_of(name, only_quick) {
            Ok(found) => {
                for name in found {
                    match read_and_check(&name, &[]) {
                        Ok(CheckedCase { file, .. }) => members.push(Member { name, file }),
                        Err(failure) => failures.push(failure.of(&name)),
                    }
                }
            }
            Err(failure) => failures.push(failure.of(name)),
        }
    }
    Failure::all(failures).map_or(Ok(members), Err)
}

/// The case and its variants that have something to be compared with.
fn members_of(name: &str, only_quick: bool) -> Result<Vec<String>, Failure> {
    let file = Case::read(name, &[])?;
    let mut members = Vec::new();
    if !file.case().reference.is_empty() && (file.case().quick || !only_quick) {
        members.push(name.to_owned());
    }
    for variant in &file.case().variant {
        let has_reference = !(variant.reference.is_empty() && file.case().reference.is_empty());
        if has_reference && (variant.quick || !only_quick) {
            members.push(format!("{name}/{}", variant.name));
        }
    }
    Ok(members)
}

/// What all members are validated with.
struct Work<'a> {
    options: &'a Options,
    n_threads: usize,
    watch: SignalWatch,
}

impl Work<'_> {
    /// Runs one case, or reads its run; a run that fails is a row of the table, not the end of the
    /// validation.
    fn validate(&self, file: &CaseFile) -> Result<Vec<Comparison>, Failure> {
        let name = file.full_name();
        let of_run = name.replace('/', "-");
        let watch = self.watch.clone();
        let outcome = match (&self.options.out, &self.options.from) {
            (Some(out), _) => {
                let place = out.join(of_run);
                // A validation that was stopped runs the case it stopped in again
                let is_finished =
                    Status::read(&place).is_ok_and(|status| status.state == RunState::Finished);
                let earlier = if is_finished { Earlier::Keep } else { Earlier::Replace };
                let start = Start::with_threads(self.n_threads);
                let directory = RunDirectory::create(&place, file.case(), start, earlier)?;
                let shown = Shown { quiet: true, live: None };
                let run = RunInto { directory: &directory, shown, watch, limit: None };
                engine::simulate_afresh(&file.model, run)
            }
            (None, Some(from)) => Ok(kept(&from.join(of_run), file.case())?),
            (None, None) => engine::simulate(&file.model, watch),
        };
        Ok(match outcome {
            Ok(outcome) => compare(&name, file.case(), &outcome),
            // Asked to stop: that is no verdict
            Err(error @ RunError::Stopped { .. }) => return Err(error.into()),
            Err(error) => not_computed(&name, file.case(), &error.to_string()),
        })
    }
}

/// A run that was kept, of the same case, its references aside.
fn kept(directory: &Path, case: &Case) -> Result<RunSummary, Failure> {
    let refuse = |exit, reason: String| {
        Failure::new(exit, format!("--from: {}: {reason}", directory.display()))
    };
    let path = directory.join("case.toml");
    if let Err(error) = std::fs::metadata(&path) {
        return Err(refuse(Exit::NoInput, format!("its case.toml: {error}")));
    }
    let was = Case::read(&path.display().to_string(), &[])?.model.case;
    if computed(&was) != computed(case) {
        let reason = "the case has changed since, not only its references; run it again";
        return Err(refuse(Exit::BadCase, reason.to_owned()));
    }
    if !matches!(case.output.series, Cadence::Steps(1)) {
        let reason = "its series.csv does not have every step (output.series)";
        return Err(refuse(Exit::BadCase, reason.to_owned()));
    }
    read_outcome(directory).map_err(|error| refuse(Exit::NoInput, error.to_string()))
}

/// What decides the numbers of a run: a case without words and references.
fn computed(case: &Case) -> Case {
    Case {
        title: String::new(),
        description: String::new(),
        numbers: Numbers::default(),
        statistics: Statistics::default(),
        reference: Vec::new(),
        variant: Vec::new(),
        quick: false,
        ..case.clone()
    }
}
