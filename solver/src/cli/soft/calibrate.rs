//! `calibrate`: numbers of a soft case, or coefficients of a reduced model.

use std::path::{Path, PathBuf};

use alewife_reduced::tier::Which;

use super::{SearchOptions, hold, not_written, search_failure, seek};
use crate::case::check_starts;
use crate::case::soft::SoftFile;
use crate::cli::exit::{Exit, Failure};
use crate::cli::read::{print_warnings, read_and_check};
use crate::cli::style::{complain, say};
use crate::observer::{remove_if_there, write_atomic};
use crate::reduced::{CalibrateError, JOURNAL, RUN, ReducedError, calibrate_in as find};

/// The file that a calibration of a reduced model writes.
const FILE: &str = "calibrated.toml";

/// The tracks of its runs and records over those of the model.
const TRACKS: &str = "tracks.csv";

/// Calibrates a case by what it is.
pub fn calibrate(options: &SearchOptions) -> Result<Exit, Failure> {
    if SoftFile::read_if_soft(options.case(), options.set())?.is_some() {
        return seek(options, Which::Calibration);
    }
    let checked = read_and_check(options.case(), options.set())?;
    let (file, warnings) = (checked.file, checked.warnings);
    print_warnings(&warnings);
    let mut outside = check_starts(&file);
    outside.retain(|one| one.key.starts_with("calibration."));
    if !outside.is_empty() {
        return Err(Failure::wrong(&outside));
    }
    let default = || Path::new("runs").join(file.directory_name() + "-calibration");
    let out: PathBuf = options.out().map_or_else(default, Path::to_path_buf);
    check_is_open(&out, options)?;
    let _held = hold(&out)?;
    // Another process may have come to its end since
    check_is_open(&out, options)?;
    if options.overwrites() {
        remove_if_there(&out.join(JOURNAL)).map_err(|error| not_written(&out, &error))?;
    }
    let mut told = |line: &str| {
        if !options.quiet {
            complain(line);
        }
    };
    let found = find(&file, Some(&out), &mut told).map_err(|error| {
        if let Some(diagnostic) = error.diagnostic(&file) {
            return Failure::wrong(&[diagnostic]);
        }
        let exit = match &error {
            CalibrateError::Search(error) => return search_failure(error),
            CalibrateError::Tree(_) | CalibrateError::Model(ReducedError::Tree(_)) => {
                Exit::Diverged
            }
            _ => Exit::BadCase,
        };
        Failure::new(exit, error.to_string())
    })?;
    say(found.text().trim_end());
    let run = match found.run() {
        Some(case) => write_atomic(&out.join(RUN), case.as_bytes()),
        None => remove_if_there(&out.join(RUN)),
    };
    run.and_then(|()| write_atomic(&out.join(TRACKS), found.to_csv().as_bytes()))
        .and_then(|()| write_atomic(&out.join(FILE), found.to_toml().as_bytes()))
        .map_err(|error| not_written(&out, &error))?;
    say(&format!("written to {}", out.display()));
    Ok(Exit::Done)
}

/// Refuses to write over a calibration, unless it is to be replaced.
fn check_is_open(out: &Path, options: &SearchOptions) -> Result<(), Failure> {
    if !out.join(FILE).exists() || options.overwrites() {
        return Ok(());
    }
    let message = format!(
        "{} is finished: write elsewhere by --out, or replace it by --overwrite",
        out.display()
    );
    Err(Failure::new(Exit::Usage, message))
}
