//! `Swept`: the case a sweep is of, as the command line names it, and where the sweep goes.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::case::{Sweep, directory_name};
use crate::cli::complete;
use crate::cli::exit::Failure;

/// A case, and which of its keys take which values.
#[derive(Debug, Clone, Args)]
pub struct Swept {
    /// Which case
    #[arg(add = complete::case())]
    pub case: String,
    /// Sweep a key: KEY=FROM:TO:N, KEY=FROM:TO:N:log or KEY=A,B,C; or set it once for all points:
    /// KEY=VALUE. May be repeated
    #[arg(long = "set", value_name = "KEY=VALUES", add = complete::key())]
    pub set: Vec<String>,
}

impl Swept {
    /// Reads them.
    pub fn read(&self) -> Result<Sweep, Failure> {
        Ok(Sweep::read(&self.case, &self.set)?)
    }
}

/// Where a sweep goes that is given no directory.
pub fn directory_of(out: Option<&PathBuf>, sweep: &Sweep) -> PathBuf {
    out.cloned().unwrap_or_else(|| Path::new("sweeps").join(directory_name(&sweep.name())))
}
