//! The directory that a command on a soft case writes into.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::cli::exit::{Exit, Failure};
use crate::observer::{LockError, RunLock, Status};

/// What a file could not be written for.
pub fn not_written(directory: &Path, error: &io::Error) -> Failure {
    Failure::new(Exit::InputOutput, format!("{}: {error}", directory.display()))
}

/// Makes a directory ready, which this process holds as long as the value lives: another one is told who has it. One
/// that has the file that ends such a command is refused, unless it is replaced.
pub fn prepare(directory: &Path, endings: [&str; 2], overwrite: bool) -> Result<RunLock, Failure> {
    check(directory, endings, overwrite)?;
    let held = hold(directory)?;
    make_ready(directory, endings, overwrite)?;
    Ok(held)
}

/// The same of a directory that this process holds already.
pub fn make_ready(directory: &Path, endings: [&str; 2], overwrite: bool) -> Result<(), Failure> {
    // Another process may have come to its end since
    check(directory, endings, overwrite)?;
    if overwrite {
        clear(directory, endings).map_err(|error| not_written(directory, &error))?;
    }
    Ok(())
}

/// Holds a directory, which is made if it is not there.
pub fn hold(directory: &Path) -> Result<RunLock, Failure> {
    loop {
        fs::create_dir_all(directory).map_err(|error| not_written(directory, &error))?;
        match RunLock::take(directory) {
            // It went with the lock of another process
            Err(LockError::Io(error)) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => {
                let is_usage = matches!(error, LockError::NotALock { .. });
                let exit = if is_usage { Exit::Usage } else { Exit::InputOutput };
                return Err(Failure::new(exit, error.to_string()));
            }
            Ok(lock) => return Ok(lock),
        }
    }
}

/// Refuses what is finished, unless it is replaced, and what is of somebody else.
fn check(directory: &Path, [last, journals]: [&str; 2], overwrite: bool) -> Result<(), Failure> {
    if directory.join(last).exists() && !overwrite {
        let message = format!(
            "{} is finished: write elsewhere by --out, or replace it by --overwrite",
            directory.display()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    // What was stopped on its way has left a journal or fields
    let is_ours = directory.join(last).exists()
        || directory.join("fields.pvd").exists()
        || Status::read(directory).is_ok_and(|status| status.fidelity.is_some())
        || has_ending(directory, journals);
    if directory.join("case.toml").exists() && !is_ours {
        let message = format!(
            "{} has a case.toml that is not of such a command: write elsewhere by --out",
            directory.display()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    Ok(())
}

/// Takes away what a command continues from, and what it writes last.
fn clear(directory: &Path, [last, journals]: [&str; 2]) -> io::Result<()> {
    for entry in fs::read_dir(directory)? {
        let path: PathBuf = entry?.path();
        let is_journal = path.extension().is_some_and(|ending| ending == journals);
        if is_journal || path.ends_with(last) {
            fs::remove_file(&path)?;
        }
    }
    Ok(())
}

/// Whether a directory has a file of this ending.
fn has_ending(directory: &Path, ending: &str) -> bool {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).any(|path| path.extension().is_some_and(|own| own == ending))
}
