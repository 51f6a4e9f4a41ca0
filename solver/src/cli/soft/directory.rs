//! The directory that a command on a soft case writes into.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::cli::exit::{Exit, Failure};

/// What a file could not be written for.
pub fn not_written(directory: &Path, error: &io::Error) -> Failure {
    Failure::new(Exit::InputOutput, format!("{}: {error}", directory.display()))
}

/// Makes a directory ready; one that has the file that ends such a command is refused, unless it is replaced.
pub fn prepare(
    directory: &Path,
    [last, journals]: [&str; 2],
    overwrite: bool,
) -> Result<(), Failure> {
    let failed = |error: io::Error| not_written(directory, &error);
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
        || has_ending(directory, journals);
    if directory.join("case.toml").exists() && !is_ours {
        let message = format!(
            "{} has a case.toml that is not of such a command: write elsewhere by --out",
            directory.display()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    fs::create_dir_all(directory).map_err(failed)?;
    if overwrite {
        for entry in fs::read_dir(directory).map_err(failed)? {
            let path: PathBuf = entry.map_err(failed)?.path();
            let is_journal = path.extension().is_some_and(|ending| ending == journals);
            if is_journal || path.ends_with(last) {
                fs::remove_file(&path).map_err(failed)?;
            }
        }
    }
    Ok(())
}

/// Whether a directory has a file of this ending.
fn has_ending(directory: &Path, ending: &str) -> bool {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).any(|path| path.extension().is_some_and(|own| own == ending))
}
