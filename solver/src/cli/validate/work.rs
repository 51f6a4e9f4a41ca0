//! One member of a validation: its run and that of its companion, made or taken from where they are kept.

use std::path::{Path, PathBuf};

use super::super::exit::{Exit, Failure};
use super::kept::{self, Found};
use super::members::Member;
use crate::case::{Case, CaseFile, Model, Severity, check};
use crate::observer::{Earlier, Origin, Provenance, RunDirectory, Shown, Start, begin_warnings};
use crate::run::{RunError, RunSummary};
use crate::runner::{self, RunInto, SignalWatch};
use crate::step::FlowError;
use crate::validation::{
    Companion, Comparison, MemberReport, Refinement, RunSize, coarser_settings, compare,
    no_companion, not_computed, set_uncertainties,
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

/// Why a run has no result.
enum NoResult {
    /// It failed, or is not there to be read: a row of the table says so.
    Reported(String),
    /// The validation ends with it.
    Ends(Failure),
}

impl NoResult {
    /// What the row says, unless the validation ends.
    fn reported(self) -> Result<String, Failure> {
        match self {
            Self::Reported(reason) => Ok(reason),
            Self::Ends(failure) => Err(failure),
        }
    }
}

impl From<RunError> for NoResult {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Flow(FlowError::Stopped { .. }) => Self::Ends(error.into()),
            error => Self::Reported(error.to_string()),
        }
    }
}

impl From<Failure> for NoResult {
    fn from(failure: Failure) -> Self {
        Self::Ends(failure)
    }
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
        let directory = self.directory(file, Which::Itself);
        let summary = match self.summary(file, Which::Itself, directory.as_deref()) {
            Ok(summary) => Ok(summary),
            Err(none) => Err(none.reported()?),
        };
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
                let run = match self.companion_run(member) {
                    Ok(run) => Ok(run),
                    Err(none) => Err(none.reported()?),
                };
                Some(companion(member, size, run, &mut comparisons))
            }
            _ => None,
        };
        self.keep(member, &comparisons)?;
        let made_by = made_by(directory.as_deref(), self.n_threads);
        Ok(MemberReport { name, size, companion, comparisons, made_by })
    }

    /// Writes a comparison to the run it is of, where that is kept.
    pub fn keep(&self, member: &Member, comparisons: &[Comparison]) -> Result<(), Failure> {
        let directory = self.directory(&member.file, Which::Itself);
        if let (Place::Kept { .. }, Some(directory)) = (&self.place, &directory) {
            runner::write_comparisons(directory, comparisons)?;
        }
        Ok(())
    }

    /// The run of a companion.
    fn companion_run(&self, member: &Member) -> Result<SizedRun, NoResult> {
        if let Some(reason) = no_companion(member.file.case()) {
            return Err(NoResult::Reported(reason.to_owned()));
        }
        let settings = coarser_settings(member.file.case());
        let file = readable(&member.name, &settings).map_err(NoResult::Reported)?;
        let directory = self.directory(&file, Which::Companion);
        let summary = self.summary(&file, Which::Companion, directory.as_deref())?;
        let size = size_of(&file.model, &summary, directory.as_deref())?;
        Ok(SizedRun { summary, size })
    }

    /// Where a run is kept, if anywhere.
    fn directory(&self, file: &CaseFile, which: Which) -> Option<PathBuf> {
        let mut name = file.directory_name();
        if which == Which::Companion {
            name += COARSER;
        }
        match &self.place {
            Place::Memory => None,
            Place::Kept { out: place, .. } | Place::Read(place) => Some(place.join(name)),
        }
    }

    /// What a run came to, with the directory it is kept in.
    fn summary(
        &self,
        file: &CaseFile,
        which: Which,
        directory: Option<&Path>,
    ) -> Result<RunSummary, NoResult> {
        match (&self.place, directory) {
            (Place::Memory, _) | (_, None) => {
                Ok(runner::simulate(&file.model, self.watch.clone())?)
            }
            (Place::Read(_), Some(directory)) => read(file.case(), which, directory),
            (Place::Kept { by_any_program, .. }, Some(directory)) => {
                match kept::find(directory, file.case(), *by_any_program) {
                    Found::Finished => Ok(kept::outcome(directory).map_err(Failure::from)?),
                    Found::Failed(reason) => Err(NoResult::Reported(reason)),
                    Found::Replaceable => {
                        let is_of_validation = kept::is_of_validation(directory);
                        let summary = self.run(file, directory, Earlier::Replace)?;
                        if is_of_validation {
                            kept::mesh_size(&file.model, Some(directory))?;
                        }
                        Ok(summary)
                    }
                    Found::Other => self.run(file, directory, Earlier::Keep),
                }
            }
        }
    }

    fn run(&self, file: &CaseFile, place: &Path, earlier: Earlier) -> Result<RunSummary, NoResult> {
        let start = Start::with_threads(self.n_threads);
        let model = kept::with_every_step(&file.model);
        let directory =
            RunDirectory::create(place, &model.case, start, earlier).map_err(Failure::from)?;
        let shown = Shown { quiet: true, live: None };
        let watch = self.watch.clone();
        begin_warnings(Vec::new());
        let run = RunInto { directory: &directory, shown, watch, limit: None };
        Ok(runner::simulate_afresh(&model, run)?)
    }
}

/// Reads a run that is kept; none is made.
fn read(case: &Case, which: Which, directory: &Path) -> Result<RunSummary, NoResult> {
    if let Found::Failed(reason) = kept::find(directory, case, true) {
        return Err(NoResult::Reported(reason));
    }
    kept::read(directory, case).map_err(|refusal| match which {
        // Without a companion a value has no uncertainty, without its run no value
        Which::Companion if !directory.is_dir() => NoResult::Reported("not run".to_owned()),
        Which::Companion => NoResult::Reported(refusal.reason),
        Which::Itself => NoResult::Ends(refusal.into()),
    })
}

/// Gives values their uncertainties by the run of a companion, where there is one.
fn companion(
    member: &Member,
    fine: RunSize,
    run: Result<SizedRun, String>,
    values: &mut [Comparison],
) -> Result<Companion, String> {
    let case = member.file.case();
    let refinement = match &run {
        Ok(run) => Refinement::between(case, fine, run.size),
        Err(reason) => Err(reason.clone()),
    };
    let compared = match &run {
        Ok(run) => compare(&member.name, case, &run.summary),
        Err(_) => Vec::new(),
    };
    set_uncertainties(values, &compared, &refinement);
    run.map(|run| Companion { size: run.size, refinement })
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
