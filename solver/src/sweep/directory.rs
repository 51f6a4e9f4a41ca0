//! `SweepDirectory`: where the points of a sweep are, and what sweep it is.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use thiserror::Error;

use super::case_hash::hashes_of;
use super::plan::Plan;
use crate::case::{CaseError, Sweep};
use crate::observer::{LOCK_FILE, LockError, RunLock, UNFINISHED, write_atomic};

/// What the sweep is.
pub const PLAN_FILE: &str = "sweep.json";
/// One row a point.
pub const TABLE_FILE: &str = "sweep.csv";
/// Digits of the number of a point, more if there are more points.
const DIGITS: usize = 4;

/// Why a sweep may not use a directory.
#[derive(Debug, Error)]
pub enum SweepDirectoryError {
    /// It holds another sweep.
    #[error(
        "{path} holds another sweep; what differs:\n  {}\ngive another directory with --out",
        differences.join("\n  ")
    )]
    Other {
        /// The directory.
        path: PathBuf,
        /// What differs, line by line.
        differences: Vec<String>,
    },
    /// It holds files that are not those of a sweep.
    #[error("{path} is not empty and holds no sweep; give another directory with --out")]
    NotASweep {
        /// The directory.
        path: PathBuf,
    },
    /// There is no sweep in it.
    #[error("{path} holds no sweep (there is no {PLAN_FILE}); give the directory of one")]
    None {
        /// The directory.
        path: PathBuf,
    },
    /// Its plan cannot be understood.
    #[error("{path}: {reason}")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        reason: String,
    },
    /// The case of a point is wrong.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// Another process writes its plan, and does not come to an end, or what is there is no lock.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// The file system refused.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Longest time for another process to write the plan of the sweep.
const PATIENCE: Duration = Duration::from_secs(300);

/// The directory of a sweep.
#[derive(Debug)]
pub struct SweepDirectory {
    path: PathBuf,
    plan: Plan,
}

impl SweepDirectory {
    /// The directory for the plan of a sweep, made if it is not there.
    ///
    /// # Errors
    /// [`SweepDirectoryError`]: it holds another sweep or other files, or cannot be written.
    pub fn create(path: &Path, plan: Plan, sweep: &Sweep) -> Result<Self, SweepDirectoryError> {
        fs::create_dir_all(path).map_err(|error| at(path, &error))?;
        check_is_for_sweeps(path)?;
        // One process at a time: the others find its plan
        let _lock = hold(path)?;
        check_is_for_sweeps(path)?;
        let earlier = match read_plan(path) {
            Ok(earlier) => Some(earlier),
            Err(SweepDirectoryError::None { .. }) => None,
            Err(error) => return Err(error),
        };
        let mut plan = plan;
        if let Some(earlier) = &earlier {
            let differences = plan.differences(earlier);
            if !differences.is_empty() {
                return Err(SweepDirectoryError::Other { path: path.to_owned(), differences });
            }
            plan.cases.clone_from(&earlier.cases);
        }
        if plan.cases.len() != plan.points.len() {
            plan.cases = hashes_of(sweep)?;
        }
        let is_written = earlier.is_some_and(|earlier| {
            (&earlier.quantities, &earlier.cases) == (&plan.quantities, &plan.cases)
        });
        if !is_written {
            let mut text = serde_json::to_vec(&plan).map_err(io::Error::from)?;
            text.push(b'\n');
            write_atomic(&path.join(PLAN_FILE), &text)?;
        }
        Ok(Self { path: path.to_owned(), plan })
    }

    /// The sweep in a directory.
    ///
    /// # Errors
    /// [`SweepDirectoryError`]: there is none, or its plan cannot be read.
    pub fn open(path: &Path) -> Result<Self, SweepDirectoryError> {
        Ok(Self { path: path.to_owned(), plan: read_plan(path)? })
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it is.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Number of points.
    #[must_use]
    pub fn n_points(&self) -> usize {
        self.plan.points.len()
    }

    /// The run directory of a point, by its index from 0.
    #[must_use]
    pub fn point(&self, index: usize) -> PathBuf {
        self.path.join("points").join(self.number(index))
    }

    /// Where it stands why a point failed.
    pub(super) fn failure(&self, index: usize) -> PathBuf {
        self.path.join("failed").join(self.number(index) + ".json")
    }

    /// The number of a point from 1 on, with zeros in front.
    fn number(&self, index: usize) -> String {
        let digits = self.n_points().to_string().len().max(DIGITS);
        format!("{:0digits$}", index + 1)
    }
}

fn at(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// Holds the directory of a sweep while its plan is written.
fn hold(path: &Path) -> Result<RunLock, SweepDirectoryError> {
    let started = Instant::now();
    loop {
        match RunLock::wait(path, || started.elapsed() > PATIENCE) {
            Ok(Some(lock)) => return Ok(lock),
            Ok(None) => {
                return Err(LockError::InUse { path: path.to_owned(), holder: None }.into());
            }
            // It went with the lock of a process that found something wrong
            Err(LockError::Io(error)) if error.kind() == io::ErrorKind::NotFound => {
                fs::create_dir_all(path).map_err(|error| at(path, &error))?;
            }
            Err(LockError::NotALock { .. }) if !path.join(PLAN_FILE).is_file() => {
                return Err(SweepDirectoryError::NotASweep { path: path.to_owned() });
            }
            Err(error) => return Err(error.into()),
        }
    }
}

/// Refuses a directory without a plan that holds files of others. A lock and files that are not whole are left by a
/// process that is killed before the plan is there.
fn check_is_for_sweeps(path: &Path) -> Result<(), SweepDirectoryError> {
    let has_plan = || path.join(PLAN_FILE).is_file();
    for entry in fs::read_dir(path).map_err(|error| at(path, &error))? {
        let name = entry?.file_name();
        let is_ours = name == PLAN_FILE
            || name == LOCK_FILE
            || name.to_string_lossy().starts_with(UNFINISHED);
        // Another process may have written it meanwhile
        if !is_ours && !has_plan() {
            return Err(SweepDirectoryError::NotASweep { path: path.to_owned() });
        }
    }
    Ok(())
}

fn read_plan(path: &Path) -> Result<Plan, SweepDirectoryError> {
    let file = path.join(PLAN_FILE);
    let text = match fs::read(&file) {
        Ok(text) => text,
        Err(error)
            if [io::ErrorKind::NotFound, io::ErrorKind::NotADirectory].contains(&error.kind()) =>
        {
            return Err(SweepDirectoryError::None { path: path.to_owned() });
        }
        Err(error) => return Err(at(&file, &error).into()),
    };
    serde_json::from_slice(&text).map_err(|error| SweepDirectoryError::Damaged {
        path: file,
        reason: format!("this is no plan of a sweep: {error}"),
    })
}
