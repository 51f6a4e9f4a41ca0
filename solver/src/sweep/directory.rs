//! `SweepDirectory`: where the points of a sweep are, and what sweep it is.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::plan::Plan;
use crate::observer::{UNFINISHED, write_atomic};

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
    /// The file system refused.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// The directory of a sweep.
#[derive(Debug)]
pub struct SweepDirectory {
    path: PathBuf,
    plan: Plan,
}

impl SweepDirectory {
    /// The directory for a plan, made if it is not there.
    ///
    /// # Errors
    /// [`SweepDirectoryError`]: it holds another sweep or other files, or cannot be written.
    pub fn create(path: &Path, plan: Plan) -> Result<Self, SweepDirectoryError> {
        fs::create_dir_all(path).map_err(|error| at(path, &error))?;
        let earlier = match read_plan(path) {
            Ok(earlier) => Some(earlier),
            Err(SweepDirectoryError::None { .. }) => None,
            Err(error) => return Err(error),
        };
        if let Some(earlier) = &earlier {
            let differences = plan.differences(earlier);
            if !differences.is_empty() {
                return Err(SweepDirectoryError::Other { path: path.to_owned(), differences });
            }
        } else if holds_files(path)? {
            return Err(SweepDirectoryError::NotASweep { path: path.to_owned() });
        }
        let is_written = earlier.is_some_and(|earlier| earlier.quantities == plan.quantities);
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

/// Whether there is something in a directory that was not there a moment ago: another process may
/// just write the plan of the same sweep.
fn holds_files(path: &Path) -> Result<bool, SweepDirectoryError> {
    for entry in fs::read_dir(path).map_err(|error| at(path, &error))? {
        let name = entry?.file_name();
        if name != PLAN_FILE && !name.to_string_lossy().starts_with(UNFINISHED) {
            return Ok(!path.join(PLAN_FILE).is_file());
        }
    }
    Ok(false)
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
