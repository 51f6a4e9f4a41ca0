//! `validate`: shipped cases against their references, as a table, as JSON or as a page, with an exit code.

mod kept;
mod members;
mod report;
mod searches;
mod work;

use std::path::PathBuf;

use alewife_interrupt::hearing;
use clap::Args;

use super::complete;
use super::exit::{Exit, Failure};
use super::run::print_comparisons;
use super::style::{Ink, complain, on_stdout, say};
use crate::case::library;
use crate::observer::start_log;
use crate::runner::{SignalWatch, threads};
use crate::validation::{
    CaseReport, Comparison, Links, ReportPage, comparisons_to_json, count_table,
    raise_coincidences, summary,
};
use members::{LeftOut, Member, all_members};
use report::{ReportFile, case_report};
use searches::{Searched, Split, split};
use work::{Place, Work};

/// What `validate` is asked for.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  alewife validate --quick
  alewife validate squirmer-alone dfg-2d-1
  alewife validate --json > validation.json
  alewife validate three-sphere --out kept      keep the runs; what is there is not run again
  alewife validate three-sphere --from kept     compare them again with other references
  alewife validate --out kept --uncertainty --report

A run that is kept is not made again by the same program for the same case, so that a long validation can be
stopped and called again; with --report its page has a section a case, written as soon as the case is done.

The band of a value is its tolerance: one that leaves it has changed. Its evidence is \"confirmed\" where it differs
from a reference by no more than is uncertain in both, which --uncertainty estimates, and \"consistent to\" the
difference otherwise.

Of soft cases their motion, calibration and optimisation are compared, of steady flows with [optimisation] the
optimum, of cases with a reduced model alone its motion, where these have references; not on pages.

The exit code is 20 if a value is outside its band or could not be computed, 65 if there is
nothing to compare with, and 75 if a signal stopped it: the cases done so far are printed then. A value
that is known to be outside, for a reason that its reference gives, fails once it is within.")]
pub struct Options {
    /// Which cases, with all their variants; all shipped ones if absent
    #[arg(add = complete::case())]
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
    /// Write a page with a section a case, those of other cases as they were; docs/validation.md of the
    /// project here or above if no file is named
    #[arg(
        long,
        value_name = "FILE",
        num_args = 0..=1,
        require_equals = true,
        conflicts_with = "quick"
    )]
    report: Option<Option<PathBuf>>,
    /// Estimate the discretisation error of each value by a second run with longer cells and steps, which
    /// takes about half as long
    #[arg(long)]
    uncertainty: bool,
    /// Keep the runs, each in a directory of its own in this one, and take those that are there
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Take runs that are kept in --out from other versions of the program, too
    #[arg(long, requires = "out")]
    any_program: bool,
    /// Compare runs that were kept there by --out, as long as nothing but references has changed
    #[arg(long, value_name = "DIR", conflicts_with = "out")]
    from: Option<PathBuf>,
    /// Threads; by default those the batch system or the machine grants
    #[arg(long, short, value_name = "N")]
    threads: Option<usize>,
}

/// Runs cases and compares them with their references.
pub fn validate(options: &Options) -> Result<Exit, Failure> {
    let watch = SignalWatch::start()?;
    // Reading does not look; a case is read in a moment, and all of them are in some seconds
    let is_to_end = || match watch.has_come() {
        true => Err(Failure::new(Exit::Stopped, "stopped by a signal before the first case")),
        false => Ok(()),
    };
    let names = if options.cases.is_empty() {
        library::list().iter().chain(library::soft()).map(|case| case.name.to_owned()).collect()
    } else {
        options.cases.clone()
    };
    let left_out = LeftOut::default();
    let Split { flows, mut searched } = split(&names, options.quick, &left_out, &is_to_end)?;
    // A page has sections of runs, and kept runs are none of searches
    if options.report.is_some() || options.markdown || options.from.is_some() {
        searched.clear();
    }
    let members = all_members(&flows, options.quick, &left_out, &is_to_end)?;
    let n_threads = threads::start(options.threads)?;
    // What runs warn of is in the status of those that are kept
    start_log(None, -1)?;

    if members.is_empty() && searched.is_empty() {
        let names = names.join(", ");
        let quick = if options.quick { "quick " } else { "" };
        if left_out.any() {
            let nothing = format!("{names}: nothing is left to compare without the data");
            return Err(Failure::new(Exit::NoInput, nothing));
        }
        let nothing = format!("{names}: there is no {quick}reference to compare with");
        return Err(Failure::new(Exit::BadCase, nothing));
    }
    let file = options.report.as_ref().map(|path| ReportFile::open(path.as_deref())).transpose()?;
    let work = options.work(n_threads, watch.clone());
    let Made { mut reports, mut end } = Validation { work, file }.make(&members);
    for one in &searched {
        if end.is_some() {
            break;
        }
        let heard = hearing(watch.request(), || options.search(one, n_threads));
        match heard.result {
            Err(_) if heard.was_ended => {
                let reason = format!("stopped by a signal in {}", one.name());
                end = Some(Failure::new(Exit::Stopped, reason));
            }
            report => reports.push(report?),
        }
    }
    match end {
        Some(failure) if failure.exit != Exit::Stopped => return Err(failure),
        _ => print(&reports, options),
    }
    let is_failure = |row: &Comparison| row.verdict.is_failure();
    match end {
        Some(failure) => Err(failure),
        None if values(&reports).iter().any(is_failure) => Ok(Exit::OutsideTolerance),
        None => Ok(Exit::Done),
    }
}

impl Options {
    /// The report of what is searched.
    fn search(&self, one: &Searched, n_threads: usize) -> Result<CaseReport, Failure> {
        complain(&format!("{}: its motion and searches", one.name()));
        let member = one.validate(self.out.as_deref(), n_threads)?;
        Ok(CaseReport {
            name: one.name(),
            title: String::new(),
            gist: String::new(),
            links: Links::default(),
            members: vec![member],
        })
    }

    fn work(&self, n_threads: usize, watch: SignalWatch) -> Work {
        let place = match (&self.out, &self.from) {
            (Some(out), _) => Place::Kept { out: out.clone(), by_any_program: self.any_program },
            (None, Some(from)) => Place::Read(from.clone()),
            (None, None) => Place::Memory,
        };
        Work {
            place,
            with_sizes: self.uncertainty || self.report.is_some(),
            with_companions: self.uncertainty,
            n_threads,
            watch,
        }
    }
}

/// A validation under way.
struct Validation {
    work: Work,
    file: Option<ReportFile>,
}

/// What a validation came to.
#[derive(Default)]
struct Made {
    /// What is known of the cases that are done, the last of them in part if it ended early.
    reports: Vec<CaseReport>,
    /// Why it ended early.
    end: Option<Failure>,
}

impl Validation {
    fn make(&self, members: &[Member]) -> Made {
        let mut made = Made::default();
        let mut n_before = 0;
        for of_case in members.chunk_by(|one, other| one.file.name == other.file.name) {
            let mut case = case_report(&of_case[0].file);
            let end = self.make_case(of_case, [n_before, members.len()], &mut case);
            n_before += of_case.len();
            match end {
                // A page is made of what there is
                Err(failure) if self.file.is_some() && self.work.only_reads(&failure) => {
                    complain(&failure.message);
                    complain(&format!("{}: its section stays as it is", case.name));
                }
                Err(failure) => {
                    made.reports.push(case);
                    made.end = Some(failure);
                    return made;
                }
                Ok(()) => made.reports.push(case),
            }
        }
        made
    }

    /// The members of one case, of which so many of all were made before.
    fn make_case(
        &self,
        members: &[Member],
        [n_before, n]: [usize; 2],
        case: &mut CaseReport,
    ) -> Result<(), Failure> {
        for (index, member) in members.iter().enumerate() {
            let n_done = n_before + index;
            complain(&format!("[{}/{n}] {}", n_done + 1, member.name));
            let report = self.work.validate(member).map_err(|failure| match failure.exit {
                Exit::Stopped => {
                    let name = &member.name;
                    let reason = format!("stopped by a signal in {name}; {n_done} of {n} are done");
                    Failure::new(Exit::Stopped, reason)
                }
                _ => failure,
            })?;
            case.members.push(report);
        }
        raise_coincidences(case.members.iter_mut().flat_map(|report| &mut report.comparisons));
        for (member, report) in members.iter().zip(&case.members) {
            self.work.keep(member, &report.comparisons)?;
        }
        self.file.as_ref().map_or(Ok(()), |file| file.write(case))
    }
}

/// All values of cases.
fn values(reports: &[CaseReport]) -> Vec<Comparison> {
    let members = reports.iter().flat_map(|case| &case.members);
    members.flat_map(|member| member.comparisons.clone()).collect()
}

/// Prints values in the form that was asked for.
fn print(reports: &[CaseReport], options: &Options) {
    let comparisons = values(reports);
    let is_good = !comparisons.iter().any(|row| row.verdict.is_failure());
    if options.json {
        say(&format!("{:#}", comparisons_to_json(&comparisons)));
    } else if options.markdown {
        let mut page = ReportPage::default();
        reports.iter().for_each(|case| page.set(case));
        say(page.text(&[]).trim_end());
    } else {
        say(&format!("{}\n", count_table(&comparisons).join("\n")));
        print_comparisons(&comparisons);
        say(&on_stdout(if is_good { Ink::Green } else { Ink::Red }, &summary(&comparisons)));
    }
}
