//! `RunDirectory`: the directory of one run, held by one process; files that are whole or absent.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::beginning::check_is_for_runs;
use super::bodies;
use super::checkpoint_list::{self, REQUEST, checkpoints};
use super::marker::{is_a_run, mark};
use super::provenance::{Origin, Point, Provenance};
use super::run_directory_error::RunDirectoryError;
use super::run_lock::{LockError, RunLock};
use super::status::{RunState, Status};
use crate::case::{Case, MeshFile};
use crate::observer::system::{
    AtPath, UNFINISHED, names_in, remove_if_empty, remove_if_there, write_whole,
};

/// Files of a run. Only these, and those of its folders, are ever removed.
const FILES: [&str; 15] = [
    "case.toml",
    MESH_FILE,
    bodies::FILE,
    "provenance.json",
    "status.json",
    "log.jsonl",
    "series.csv",
    "commands.csv",
    "run.mcap",
    "fields.pvd",
    "tracers.pvd",
    COMPARISON_FILE,
    MESH_SIZE_FILE,
    REQUEST,
    STOP,
];

/// Folders of a run that hold files of its.
const FOLDERS: [&str; 4] = ["fields", "tracers", FAILURE_FOLDER, checkpoint_list::FOLDER];

/// The comparison of a run with the references of its case.
pub const COMPARISON_FILE: &str = "comparison.json";

/// Cells and shortest edge of the mesh a run began with; only runs of a validation have it.
pub const MESH_SIZE_FILE: &str = "mesh.json";

/// A file of this name in the directory of a run stops it after its step; it is removed then.
pub const STOP: &str = "STOP";

/// The mesh of the domain, where one is given.
const MESH_FILE: &str = "domain.msh";

/// The folder of a run that failed: its last state, and the flow then.
pub const FAILURE_FOLDER: &str = "failure";

/// The last state of a run that failed, in [`FAILURE_FOLDER`].
pub const FAILURE_STATE: &str = "last.state";

/// The flow of a run that failed, in [`FAILURE_FOLDER`].
pub(in crate::observer) const FAILURE_FLOW: &str = "flow.vtu";

/// What a new run does with one that is in its directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Earlier {
    /// Replaces it unless it came to its end, or left a state to resume from.
    Keep,
    /// Replaces it.
    Replace,
    /// Continues where it ended.
    Continue,
}

/// How a process begins in a directory.
#[derive(Debug, Default)]
pub struct Start {
    /// Threads it may use.
    pub threads: usize,
    /// Where in the run it begins.
    pub from: Point,
    /// The directory, if it holds that already.
    pub lock: Option<RunLock>,
}

impl Start {
    /// At the first step.
    #[must_use]
    pub fn with_threads(threads: usize) -> Self {
        Self { threads, ..Self::default() }
    }
}

/// The directory of one run, locked for this process as long as the value lives.
#[derive(Debug)]
pub struct RunDirectory {
    path: PathBuf,
    case_text: String,
    provenance: Provenance,
    _lock: RunLock,
}

impl RunDirectory {
    /// Makes the directory, with `case.toml` and `provenance.json` in it.
    ///
    /// # Errors
    /// [`RunDirectoryError`]: another run has it, it holds a run that is to be kept or other files, or
    /// it cannot be written.
    pub fn create(
        path: &Path,
        case: &Case,
        start: Start,
        earlier: Earlier,
    ) -> Result<Self, RunDirectoryError> {
        let lock = match start.lock {
            Some(lock) => lock,
            None => Self::hold(path)?,
        };
        if !is_a_run(path) {
            mark(path)?;
        }
        if earlier == Earlier::Keep {
            check_replaceable(path)?;
        }
        if earlier == Earlier::Continue {
            remove_unfinished(path).at(path)?;
        } else {
            clear(path).at(path)?;
        }

        // A given mesh is part of the run
        if let Some(mesh) = case.given_mesh().and_then(MeshFile::bytes) {
            write_whole(&path.join(MESH_FILE), mesh)?;
        }
        let case_text = case.naming_mesh(MESH_FILE).to_toml()?;
        let origin = Origin::of_this_process(&case_text, start.threads);
        let provenance = match earlier {
            Earlier::Continue => Provenance::continuing(path, origin, start.from),
            Earlier::Keep | Earlier::Replace => Provenance::beginning(origin, start.from),
        };
        provenance.write(path)?;
        write_whole(&path.join("case.toml"), case_text.as_bytes())?;
        Ok(Self { path: path.to_owned(), case_text, provenance, _lock: lock })
    }

    /// Whether a directory is that of a run.
    #[must_use]
    pub fn is_one(path: &Path) -> bool {
        is_a_run(path)
    }

    /// Holds the directory of a run, made if it is not there, before anything is read from it. Where nothing is
    /// made in it, it goes with the lock.
    ///
    /// # Errors
    /// When another process has it, it holds files of others, or the file system refuses.
    pub fn hold(path: &Path) -> Result<RunLock, RunDirectoryError> {
        if path.exists() && !path.is_dir() {
            return Err(RunDirectoryError::NotADirectory { path: path.to_owned() });
        }
        loop {
            fs::create_dir_all(path)
                .map_err(|source| RunDirectoryError::NotMade { path: path.to_owned(), source })?;
            // Before a lock is put among files of others, and once nobody else changes them
            check_is_for_runs(path)?;
            match RunLock::take(path) {
                // It went with the lock of another process
                Err(LockError::Io(error)) if error.kind() == io::ErrorKind::NotFound => {}
                Err(LockError::NotALock { .. }) if !is_a_run(path) => {
                    return Err(RunDirectoryError::NotARun { path: path.to_owned() });
                }
                taken => {
                    let lock = taken?;
                    check_is_for_runs(path)?;
                    return Ok(lock);
                }
            }
        }
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The content of `case.toml`.
    #[must_use]
    pub fn case_text(&self) -> &str {
        &self.case_text
    }

    /// The content of `provenance.json`.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }
}

/// Whether the run in a directory, if there is one, may go without being asked for.
fn check_replaceable(path: &Path) -> Result<(), RunDirectoryError> {
    let status = Status::read(path).ok();
    if status.as_ref().is_some_and(|status| status.state == RunState::Finished) {
        return Err(RunDirectoryError::Finished { path: path.to_owned() });
    }
    let failure = path.join(FAILURE_FOLDER).join(FAILURE_STATE);
    let states = checkpoints(path)?.into_iter().next().into_iter().chain([failure]);
    // A run that made no step loses nothing
    let has_steps = status.is_none_or(|status| status.step > 0);
    match states.into_iter().find(|state| has_steps && state.is_file()) {
        Some(state) => Err(RunDirectoryError::Resumable { path: path.to_owned(), state }),
        None => Ok(()),
    }
}

/// The run directory that a state is in.
///
/// `None` if it is elsewhere.
pub fn run_of_state(state: &Path) -> Option<&Path> {
    let folder = state.parent()?;
    let is_within = folder.ends_with(FAILURE_FOLDER) || folder.ends_with(checkpoint_list::FOLDER);
    let folder = if is_within { folder.parent()? } else { folder };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    is_a_run(folder).then_some(folder)
}

/// Removes what an earlier run left, and nothing else.
fn clear(path: &Path) -> io::Result<()> {
    for name in FILES {
        remove_if_there(&path.join(name))?;
    }
    remove_unfinished(path)?;
    for folder in FOLDERS.map(|folder| path.join(folder)) {
        for name in names_in(&folder)? {
            if is_of_a_run(&folder, &name) {
                remove_if_there(&folder.join(name))?;
            }
        }
        remove_if_empty(&folder)?;
    }
    Ok(())
}

/// Removes the state and the flow of a run that failed, once its end or a newer state is safe on the disk.
pub(in crate::observer) fn remove_failure(path: &Path) -> io::Result<()> {
    let folder = path.join(FAILURE_FOLDER);
    for name in [FAILURE_STATE, FAILURE_FLOW] {
        remove_if_there(&folder.join(name))?;
    }
    remove_if_empty(&folder)
}

/// Removes the temporary files of a process that was killed.
fn remove_unfinished(path: &Path) -> io::Result<()> {
    for folder in FOLDERS.map(|folder| path.join(folder)).into_iter().chain([path.to_owned()]) {
        for name in names_in(&folder)? {
            if name.starts_with(UNFINISHED) {
                remove_if_there(&folder.join(name))?;
            }
        }
    }
    Ok(())
}

/// Whether a file in a folder of a run is one that runs write there.
fn is_of_a_run(folder: &Path, name: &str) -> bool {
    if folder.ends_with(FAILURE_FOLDER) {
        return name == FAILURE_STATE || name == FAILURE_FLOW;
    }
    let is_number = |stem: &str| stem.len() >= 6 && stem.bytes().all(|byte| byte.is_ascii_digit());
    if folder.ends_with(checkpoint_list::FOLDER) {
        return name.strip_suffix(checkpoint_list::ENDING).is_some_and(is_number);
    }
    name.strip_suffix(".vtu").is_some_and(|stem| stem == "stopped" || is_number(stem))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case() -> Case {
        Case::read("three-disc-2d", &[]).unwrap().model.case
    }

    fn create(path: &Path, earlier: Earlier) -> Result<RunDirectory, RunDirectoryError> {
        RunDirectory::create(path, &case(), Start::with_threads(1), earlier)
    }

    #[test]
    fn a_directory_that_cannot_be_made_says_why_and_what_helps() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("a");
        fs::write(&file, "").unwrap();
        let reported = |path: &Path| create(path, Earlier::Keep).unwrap_err().to_string();
        assert!(
            reported(&file).contains("is a file, and a run takes a directory"),
            "{}",
            reported(&file)
        );
        let below = file.join("b");
        let below = reported(&below);
        assert!(below.contains("cannot be made") && below.contains("--out"), "{below}");
    }

    fn put(path: &Path, files: &[&str]) {
        for file in files {
            let file = path.join(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, "of somebody").unwrap();
        }
    }

    /// Files that are still as [`put`] left them.
    fn n_left(path: &Path, files: &[&str]) -> usize {
        let is_left = |file: &&&str| fs::read(path.join(file)).is_ok_and(|t| t == b"of somebody");
        files.iter().filter(is_left).count()
    }

    #[test]
    fn a_directory_that_is_no_run_is_refused_whatever_it_holds() {
        let theirs = ["case.toml", "lock", "status.json", "fields/thesis.tex", "failure/notes.txt"];
        for earlier in [Earlier::Keep, Earlier::Replace, Earlier::Continue] {
            for file in theirs {
                let place = tempfile::tempdir().unwrap();
                put(place.path(), &[file]);
                let refused = create(place.path(), earlier);
                assert!(matches!(refused, Err(RunDirectoryError::NotARun { .. })), "{file}");
                assert_eq!(n_left(place.path(), &[file]), 1, "{file}");
            }
        }
    }

    #[test]
    fn files_of_others_in_a_run_stay_and_those_of_the_run_go() {
        let place = tempfile::tempdir().unwrap();
        drop(create(place.path(), Earlier::Keep).unwrap());
        let ours = [
            "series.csv",
            "run.mcap",
            "checkpoints/000010.state",
            "fields/000010.vtu",
            "fields/1234567.vtu",
            "fields/stopped.vtu",
            "fields/.unfinished-Ab12",
            "failure/last.state",
            "failure/flow.vtu",
            ".unfinished-Cd34",
        ];
        let theirs = [
            "thesis.tex",
            "checkpoints/a.state",
            "fields/thesis.tex",
            "fields/10.vtu",
            "fields/deep/000010.vtu",
            "failure/notes.txt",
        ];
        put(place.path(), &ours);
        put(place.path(), &theirs);
        drop(create(place.path(), Earlier::Replace).unwrap());
        assert_eq!(n_left(place.path(), &ours), 0);
        assert_eq!(n_left(place.path(), &theirs), theirs.len());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        let (place, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        drop(create(place.path(), Earlier::Keep).unwrap());
        put(other.path(), &["000001.vtu", "series"]);
        std::os::unix::fs::symlink(other.path(), place.path().join("fields")).unwrap();
        let series = place.path().join("series.csv");
        std::os::unix::fs::symlink(other.path().join("series"), series).unwrap();
        drop(create(place.path(), Earlier::Replace).unwrap());
        assert_eq!(n_left(other.path(), &["000001.vtu", "series"]), 2);
        assert!(!place.path().join("series.csv").is_symlink());
    }

    #[test]
    fn a_state_belongs_to_the_run_it_lies_in() {
        let place = tempfile::tempdir().unwrap();
        drop(create(place.path(), Earlier::Keep).unwrap());
        for state in ["checkpoints/000010.state", "failure/last.state"] {
            assert_eq!(run_of_state(&place.path().join(state)), Some(place.path()));
        }
        assert_eq!(run_of_state(&place.path().join("other/last.state")), None);
    }
}
