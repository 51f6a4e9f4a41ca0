//! One member of a validation: its run and that of its companion, made or taken from where they are kept.

use std::path::{Path, PathBuf};

use super::super::engine::{self, RunInto};
use super::super::exit::{Exit, Failure};
use super::super::signal::SignalWatch;
use super::kept::{self, Found};
use super::members::Member;
use crate::case::{Case, CaseFile, Model, Severity, check};
use crate::observer::{
    COMPARISON_FILE, Earlier, Origin, Provenance, RunDirectory, Shown, Start, write_atomic,
};
use crate::run::{RunError, RunSummary};
use crate::step::FlowError;
use crate::validation::{
    Companion, Comparison, MemberReport, Refinement, RunSize, coarser_settings, compare,
    comparisons_to_json, not_computed, set_uncertainties,
};

/// What the directories of companions end with.
const COARSER: &str = "+coarser";

/// Where runs are kept.
#[derive(Debug)]
pub enum Place {
    /// Nowhere.
    Memory,
    /// In directories in this one; those that are there and that this program made of the same case, or
    /// any program if so, are not made again.
    Kept { out: PathBuf, by_any_program: bool },
    /// In this one, and none is made.
    Read(PathBuf),
}

/// What all members are validated with.
pub struct Work {
    /// Where runs are kept.
    pub place: Place,
    /// Whether sizes of meshes are wanted.
    pub with_sizes: bool,
    /// Whether companions are wanted.
    pub with_companions: bool,
    /// Threads.
    pub n_threads: usize,
    /// What may ask for the end.
    pub watch: SignalWatch,
}

/// Of a member that is validated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Which {
    Itself,
    Companion,
}

/// A run with its size.
struct SizedRun {
    summary: RunSummary,
    size: RunSize,
}

/// A run, or why there is no result.
struct Outcome {
    summary: Result<RunSummary, String>,
    directory: Option<PathBuf>,
}

impl Work {
    /// Whether a failure is that of a run that would have to be made, where none is.
    pub fn only_reads(&self, failure: &Failure) -> bool {
        matches!(self.place, Place::Read(_))
            && matches!(failure.exit, Exit::NoInput | Exit::BadCase)
    }

    /// Runs one case, or reads its run; a run that fails is a row of the table, not the end of the
    /// validation.
    pub fn validate(&self, member: &Member) -> Result<MemberReport, Failure> {
        let file = &member.file;
        let name = file.full_name();
        let Outcome { summary, directory } = self.outcome(file, Which::Itself)?;
        let size = match &summary {
            Ok(summary) if self.with_sizes => {
                Some(size_of(&file.model, summary, directory.as_deref())?)
            }
            _ => None,
        };
        let mut comparisons = match &summary {
            Ok(summary) => compare(&name, file.case(), summary),
            Err(reason) => not_computed(&name, file.case(), reason),
        };
        let companion = match size {
            Some(size) if self.with_companions => {
                Some(self.companion(member, size, &mut comparisons)?)
            }
            _ => None,
        };
        if let (Place::Kept { .. }, Some(directory)) = (&self.place, &directory) {
            write_comparisons(directory, &comparisons)?;
        }
        let made_by = made_by(directory.as_deref(), self.n_threads);
        Ok(MemberReport { name, size, companion, comparisons, made_by })
    }

    /// Gives values their uncertainties by a companion.
    fn companion(
        &self,
        member: &Member,
        fine: RunSize,
        values: &mut [Comparison],
    ) -> Result<Result<Companion, String>, Failure> {
        let case = member.file.case();
        let run = match readable(&member.name, &coarser_settings(case)) {
            Ok(file) => self.companion_run(&file)?,
            Err(reason) => Err(reason),
        };
        let refinement = match &run {
            Ok(run) => Refinement::between(case, fine, run.size),
            Err(reason) => Err(reason.clone()),
        };
        let compared = match &run {
            Ok(run) => compare(&member.name, case, &run.summary),
            Err(_) => Vec::new(),
        };
        set_uncertainties(values, &compared, &refinement);
        Ok(run.map(|run| Companion { size: run.size, refinement }))
    }

    /// The run of a companion, or why there is none.
    fn companion_run(&self, file: &CaseFile) -> Result<Result<SizedRun, String>, Failure> {
        let Outcome { summary, directory } = self.outcome(file, Which::Companion)?;
        Ok(match summary {
            Ok(summary) => {
                let size = size_of(&file.model, &summary, directory.as_deref())?;
                Ok(SizedRun { summary, size })
            }
            Err(reason) => Err(reason),
        })
    }

    fn outcome(&self, file: &CaseFile, which: Which) -> Result<Outcome, Failure> {
        let mut name = file.full_name().replace('/', "-");
        if which == Which::Companion {
            name += COARSER;
        }
        let case = file.case();
        let (directory, summary) = match &self.place {
            Place::Memory => {
                let summary = engine::simulate(&file.model, self.watch.clone());
                (None, unless_stopped(summary)?)
            }
            Place::Read(from) => {
                let directory = from.join(name);
                let summary = match kept::find(&directory, case, true) {
                    Found::Failed(reason) => Err(reason),
                    _ => match kept::read(&directory, case) {
                        // Without a companion a value has no uncertainty, without its run no value
                        Err(_) if which == Which::Companion && !directory.is_dir() => {
                            Err("not run".to_owned())
                        }
                        Err(refusal) if which == Which::Companion => Err(refusal.reason),
                        read => Ok(read?),
                    },
                };
                (Some(directory), summary)
            }
            Place::Kept { out, by_any_program } => {
                let directory = out.join(name);
                let summary = match kept::find(&directory, case, *by_any_program) {
                    Found::Finished => Ok(kept::outcome(&directory)?),
                    Found::Failed(reason) => Err(reason),
                    Found::Replaceable => {
                        let is_of_validation = kept::is_of_validation(&directory);
                        let summary = self.run(file, &directory, Earlier::Replace)?;
                        if is_of_validation && summary.is_ok() {
                            kept::mesh_size(&file.model, Some(&directory))?;
                        }
                        summary
                    }
                    Found::Other => self.run(file, &directory, Earlier::Keep)?,
                };
                (Some(directory), summary)
            }
        };
        Ok(Outcome { summary, directory })
    }

    fn run(
        &self,
        file: &CaseFile,
        place: &Path,
        earlier: Earlier,
    ) -> Result<Result<RunSummary, String>, Failure> {
        let start = Start::with_threads(self.n_threads);
        let model = kept::with_every_step(&file.model);
        let directory = RunDirectory::create(place, &model.case, start, earlier)?;
        let shown = Shown { quiet: true, live: None };
        let watch = self.watch.clone();
        let run = RunInto { directory: &directory, shown, watch, limit: None };
        unless_stopped(engine::simulate_afresh(&model, run))
    }
}

/// Writes what `run` does of its comparison.
fn write_comparisons(directory: &Path, all: &[Comparison]) -> std::io::Result<()> {
    let mut json = comparisons_to_json(all);
    json["provenance"] = serde_json::to_value(Provenance::read(directory)?.origin)?;
    write_atomic(&directory.join(COMPARISON_FILE), format!("{json:#}\n").as_bytes())
}

/// A case with settings, or the first of what is wrong with it.
fn readable(name: &str, settings: &[String]) -> Result<CaseFile, String> {
    let file = Case::read(name, settings).map_err(|error| error.to_string())?;
    let mut findings = check(&file).into_iter();
    match findings.find(|finding| finding.severity == Severity::Error) {
        Some(error) => Err(error.message),
        None => Ok(file),
    }
}

/// Which program made a run and when: of a run that is not kept, this one today.
fn made_by(directory: Option<&Path>, n_threads: usize) -> String {
    let kept = directory.and_then(|directory| Provenance::read(directory).ok());
    let origin = kept.map_or_else(|| Origin::of_this_process("", n_threads), |kept| kept.origin);
    let day = origin.started_at.get(..10).unwrap_or_default();
    format!("{}, {day}", origin.program())
}

/// What a run came to; to be asked to stop is no result.
fn unless_stopped(
    summary: Result<RunSummary, RunError>,
) -> Result<Result<RunSummary, String>, Failure> {
    match summary {
        Err(error @ RunError::Flow(FlowError::Stopped { .. })) => Err(error.into()),
        summary => Ok(summary.map_err(|error| error.to_string())),
    }
}

fn size_of(
    model: &Model,
    summary: &RunSummary,
    directory: Option<&Path>,
) -> Result<RunSize, Failure> {
    Ok(RunSize {
        mesh: kept::mesh_size(model, directory)?,
        dofs: summary.n_dofs,
        steps: summary.steps,
        cpu_seconds: summary.timing.cpu.iter().sum(),
    })
}
