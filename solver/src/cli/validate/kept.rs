//! Runs that a validation keeps: which of them stand for a run that is asked for.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::super::exit::{Exit, Failure};
use crate::case::{Cadence, Case, CaseError, Model, Numbers, Output, Statistics};
use crate::observer::{
    MESH_SIZE_FILE, Provenance, RunState, Status, executable, read_outcome, write_atomic,
};
use crate::run::{Dimension, RunSummary, Solve, build_mesh};
use crate::validation::MeshSize;

/// How often a row of a series is written for a run to be compared.
const EVERY_STEP: Cadence = Cadence::Steps(1);

/// What is in the directory of a run that is wanted.
pub enum Found {
    /// Nothing that is worth to be kept, or what an earlier validation left of another case or program.
    Replaceable,
    /// A run of somebody else.
    Other,
    /// The run, as it came to its end.
    Finished,
    /// The run, and why it failed.
    Failed(String),
}

/// Looks for a run of a case, by this program unless any will do.
pub fn find(directory: &Path, case: &Case, by_any_program: bool) -> Found {
    let Ok(status) = Status::read(directory) else { return Found::Replaceable };
    let is_it =
        (by_any_program || is_by_this_program(directory)) && check_case(directory, case).is_ok();
    match (status.state, is_it) {
        (RunState::Finished, true) => Found::Finished,
        (RunState::Failed, true) if !status.is_interrupted => {
            Found::Failed(status.reason.unwrap_or_else(|| "it failed".to_owned()))
        }
        (RunState::Finished, false) if !is_of_validation(directory) => Found::Other,
        _ => Found::Replaceable,
    }
}

/// Whether a run is known to be that of a validation: nothing else measures the meshes of runs.
pub fn is_of_validation(directory: &Path) -> bool {
    directory.join(MESH_SIZE_FILE).is_file()
}

fn is_by_this_program(directory: &Path) -> bool {
    let Ok(provenance) = Provenance::read(directory) else { return false };
    let this = executable();
    this.is_some() && provenance.legs.iter().all(|leg| leg.origin.executable.as_deref() == this)
}

/// Why a run that was kept cannot stand for another one.
#[derive(Debug)]
pub struct Refusal {
    exit: Exit,
    directory: PathBuf,
    /// In words, without the directory.
    pub reason: String,
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Self {
        let Refusal { exit, directory, reason } = refusal;
        Self::new(exit, format!("{}: {reason}", directory.display()))
    }
}

/// A run that was kept, of the same case, its references aside.
pub fn read(directory: &Path, case: &Case) -> Result<RunSummary, Refusal> {
    check_case(directory, case)?;
    outcome(directory)
}

/// A run that was found to be finished.
pub fn outcome(directory: &Path) -> Result<RunSummary, Refusal> {
    read_outcome(directory).map_err(|error| Refusal {
        exit: Exit::NoInput,
        directory: directory.to_owned(),
        reason: error.to_string(),
    })
}

/// Whether a run is of this case, and all that was computed is there.
fn check_case(directory: &Path, case: &Case) -> Result<(), Refusal> {
    let refuse = |exit, reason: &str| {
        let (directory, reason) = (directory.to_owned(), reason.to_owned());
        Err(Refusal { exit, directory, reason })
    };
    if let Err(error) = std::fs::metadata(directory.join("case.toml")) {
        return refuse(Exit::NoInput, &format!("its case.toml: {error}"));
    }
    let was = match run_case(directory) {
        Ok(was) => was,
        Err(error) => return refuse(Exit::BadCase, &format!("its case.toml: {error}")),
    };
    if computed(&was) != computed(case) {
        let reason = "the case has changed since, not only its references; run it again";
        return refuse(Exit::BadCase, reason);
    }
    if was.output.series != EVERY_STEP {
        let reason = "its series.csv does not have every step (output.series)";
        return refuse(Exit::BadCase, reason);
    }
    Ok(())
}

/// The same case with all that is computed in its series, however little of that it asks for: values are of all
/// steps.
pub fn with_every_step(model: &Model) -> Model {
    let mut model = model.clone();
    model.case.output.series = EVERY_STEP;
    model
}

/// The case in the directory of a run.
fn run_case(directory: &Path) -> Result<Case, CaseError> {
    Ok(Case::read(&directory.join("case.toml").display().to_string(), &[])?.model.case)
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
        output: Output { series: EVERY_STEP, ..case.output },
        ..case.clone()
    }
}

/// The size of the mesh a case begins with, kept in the directory of its run if there is one.
pub fn mesh_size(model: &Model, directory: Option<&Path>) -> Result<MeshSize, Failure> {
    let Some(path) = directory.map(|directory| directory.join(MESH_SIZE_FILE)) else {
        return measured(model);
    };
    let unusable =
        |reason: String| Failure::new(Exit::InputOutput, format!("{}: {reason}", path.display()));
    match std::fs::read(&path) {
        Ok(text) => serde_json::from_slice(&text).map_err(|error| unusable(error.to_string())),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let size = measured(model)?;
            let mut text =
                serde_json::to_vec(&size).map_err(|error| unusable(error.to_string()))?;
            text.push(b'\n');
            write_atomic(&path, &text)?;
            Ok(size)
        }
        Err(error) => Err(unusable(error.to_string())),
    }
}

fn measured(model: &Model) -> Result<MeshSize, Failure> {
    match model.case.geometry.dimensions() {
        2 => measured_in::<2>(model),
        _ => measured_in::<3>(model),
    }
}

fn measured_in<const D: usize>(model: &Model) -> Result<MeshSize, Failure>
where
    Dimension<D>: Solve<D>,
{
    let quality = Dimension::<D>::quality(&build_mesh::<D>(model)?);
    Ok(MeshSize { cells: quality.n_cells, shortest_edge: quality.shortest_edge })
}
